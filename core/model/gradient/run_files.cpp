#include "model/gradient/run_files.h"

#include <algorithm>
#include <fstream>
#include <sstream>

#include "base/atomic_file.h"
#include "base/error.h"

namespace marey {
namespace {

/// "bits per frame" as a part of a column's name.
std::string columnOf(std::string unit) {
  std::replace(unit.begin(), unit.end(), ' ', '_');
  return unit;
}

std::filesystem::path logOf(const std::filesystem::path& run) {
  return run / "log.csv";
}

}  // namespace

void startLog(const std::filesystem::path& run, const std::string& unit,
              const std::vector<std::string>& terms) {
  const std::string column = columnOf(unit);
  std::string header = fmt::format(
      "step,seconds,learning_rate,train_{0},valid_{0},test_{0},gradient_norm,skipped", column);
  for (const std::string& term : terms) header += fmt::format(",{}", columnOf(term));
  writeFileAtomically(logOf(run), header + "\n");
}

void appendLog(const std::filesystem::path& run, const LogRow& r) {
  std::ofstream log(logOf(run), std::ios::app);
  log << fmt::format("{},{:.1f},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{}", r.step, r.seconds,
                     r.learningRate, r.train, r.valid, r.test, r.gradientNorm, r.skipped);
  for (const auto& [name, value] : r.terms) log << fmt::format(",{:.6g}", value);
  log << "\n";
  if (!log.flush()) throw FileError(logOf(run).string() + ": cannot write");
}

void cutLog(const std::filesystem::path& run, int64_t step) {
  std::istringstream in(readFile(logOf(run)));
  std::string line, kept;
  std::getline(in, kept);
  kept += "\n";
  while (std::getline(in, line))
    if (std::strtoll(line.c_str(), nullptr, 10) <= step) kept += line + "\n";
  writeFileAtomically(logOf(run), kept);
}

}  // namespace marey
