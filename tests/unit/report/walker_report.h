// A report filled from the walker: natural motion in one style, two 'systems' in others.
#pragma once

#include "report/report_data.h"

namespace marey::report {

/// `clipsPerPath` clips of every system on each path; likelihoods are made up (a wave with noise).
ReportData walkerReport(const std::vector<std::string>& paths, int clipsPerPath, double seconds);

}  // namespace marey::report
