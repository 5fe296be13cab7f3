#include "model/run_files.h"

#include <fstream>
#include <sstream>

#include "base/atomic_file.h"
#include "base/error.h"

namespace marey {
namespace {

constexpr const char* kHeader =
    "step,seconds,learning_rate,train_bits_per_frame,valid_bits_per_frame,test_bits_per_frame,"
    "gradient_norm,skipped\n";

std::filesystem::path logOf(const std::filesystem::path& run) {
  return run / "log.csv";
}

}  // namespace

void startLog(const std::filesystem::path& run) {
  writeFileAtomically(logOf(run), kHeader);
}

void appendLog(const std::filesystem::path& run, const LogRow& r) {
  std::ofstream log(logOf(run), std::ios::app);
  log << fmt::format("{},{:.1f},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{}\n", r.step, r.seconds,
                     r.learningRate, r.trainBits, r.validBits, r.testBits, r.gradientNorm,
                     r.skipped);
  if (!log.flush()) throw FileError(logOf(run).string() + ": cannot write");
}

void cutLog(const std::filesystem::path& run, int64_t step) {
  std::istringstream in(readFile(logOf(run)));
  std::string line, kept = kHeader;
  std::getline(in, line);
  while (std::getline(in, line))
    if (std::strtoll(line.c_str(), nullptr, 10) <= step) kept += line + "\n";
  writeFileAtomically(logOf(run), kept);
}

}  // namespace marey
