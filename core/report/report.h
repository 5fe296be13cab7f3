// Reports: one self-contained HTML page, a PDF, and every figure and table as files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/job.h"
#include "report/report_data.h"

namespace marey::report {

struct ReportFiles {
  std::filesystem::path html;                  ///< report.html
  std::filesystem::path pdf;                   ///< report.pdf; empty where none was written
  std::string pdfNote;                         ///< why not
  std::vector<std::filesystem::path> figures;  ///< figures/ID.svg and figures/ID.png
  std::vector<std::filesystem::path> tables;   ///< tables/ID.csv, .csv.json (sidecar) and .json
};

struct ReportOptions {
  bool pdf = true;
  int sceneWidth = 1400, sceneHeight = 800;  ///< pixels
};

/// Writes the report into `folder`; all files appear together or none does. Every figure and table
/// carries the recipe (SVG metadata, PNG text chunk "marey", JSON key "recipe").
/// Throws InputError (validate), FileError, CancelledError, and what drawing throws.
ReportFiles writeReport(const ReportData& data, const std::filesystem::path& folder,
                        Progress& progress, const ReportOptions& options = {});

}  // namespace marey::report
