// From what an experiment gave to what a report shows.
#pragma once

#include <string>

#include "base/job.h"
#include "experiment/run.h"
#include "report/report_data.h"

namespace marey::report {

/// Bootstrap resamples of its intervals, and of those that are to be the same.
inline constexpr int kReportResamples = 200;

/// Figures and tables of an experiment. `command` goes into the recipe.
/// Throws InputError, CancelledError.
ReportData reportOf(const ExperimentResult& result, const std::string& command, Progress& progress);

// Parts of it: the tables, and what they need.
Table footstepTable(const ExperimentResult& result);
/// One for each unit: only likelihoods of one unit can be compared. One without rows where there is
/// no system.
std::vector<Table> likelihoodTables(const ExperimentResult& result);
/// Of a document with cases: what every system made of them.
Table taskTable(const ExperimentResult& result);
Table obedienceTable(const ExperimentResult& result);
Table definitionTable();
std::vector<Table> statisticTables(const ExperimentResult& result, Progress& progress);
std::vector<DistributionPanel> distributionPanels(const ExperimentResult& result);

/// How much of what was given is not in the report: "2 files not read, 1 left out of every number";
/// empty: all is.
std::string missingText(const ExperimentResult& result);

}  // namespace marey::report
