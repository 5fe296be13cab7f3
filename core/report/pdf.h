// HTML to PDF by the separate program WeasyPrint, where it is installed.
#pragma once

#include <filesystem>
#include <string>

namespace marey::report {

struct PdfResult {
  bool written = false;
  std::string note;  ///< why there is no PDF, in a sentence
};

/// Runs `program` (found on PATH) with the page and the wanted file. Kills it after `limitS`
/// seconds. Never throws: a report without PDF is still a report.
PdfResult writePdf(const std::filesystem::path& html, const std::filesystem::path& pdf,
                   double limitS = 60.0, const std::string& program = "weasyprint");

}  // namespace marey::report
