#include "model/training_run.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <sstream>

#include "base/atomic_file.h"
#include "base/error.h"

namespace marey {
namespace {
namespace fs = std::filesystem;

/// "train_bits_per_frame", the fourth column's name -> "bits per frame".
std::string unitOf(const std::string& header) {
  size_t at = 0;
  for (int column = 0; column < 3; ++column) at = header.find(',', at) + 1;
  std::string out = header.substr(at, header.find(',', at) - at);
  out.erase(0, out.find('_') + 1);
  std::replace(out.begin(), out.end(), '_', ' ');
  return out;
}

TrainingRun readLog(const fs::path& file) {
  std::istringstream in(readFile(file));
  std::string line;
  std::getline(in, line);
  if (!line.starts_with("step,seconds,"))
    throw InputError({.path = file.string(), .line = 1}, "the log of a training run", line);
  TrainingRun out{.unit = unitOf(line), .rows = {}, .checkpoints = {}};
  for (int64_t number = 2; std::getline(in, line); ++number) {
    LossRow row;
    long long step = 0;
    double rate = 0.0;
    if (std::sscanf(line.c_str(), "%lld,%lf,%lf,%lf,%lf,%lf", &step, &row.seconds, &rate,
                    &row.train, &row.valid, &row.test) != 6)
      throw InputError({.path = file.string(), .line = number}, "six numbers or more", line);
    row.step = step;
    out.rows.push_back(row);
  }
  return out;
}

/// The step of "step_0000480.marey".
std::optional<int64_t> stepOf(const fs::path& file) {
  long long step = 0;
  if (file.extension() != ".marey" ||
      std::sscanf(file.stem().string().c_str(), "step_%lld", &step) != 1)
    return std::nullopt;
  return step;
}

/// The trainer judges by validation, without one by the training loss, and keeps the first of
/// equals.
double judged(const LossRow& row) {
  return std::isnan(row.valid) ? row.train : row.valid;
}

}  // namespace

TrainingRun readTrainingRun(const fs::path& folder) {
  TrainingRun out = readLog(folder / "log.csv");
  std::error_code none;
  for (const char* kept : {"checkpoints", "snapshots"})
    for (const auto& entry : fs::directory_iterator(folder / kept, none))
      if (const auto step = stepOf(entry.path()))
        out.checkpoints.push_back({"step " + std::to_string(*step), entry.path().string(), *step});
  std::stable_sort(out.checkpoints.begin(), out.checkpoints.end(),
                   [](const Checkpoint& a, const Checkpoint& b) { return a.step < b.step; });
  // A step may be kept in both folders.
  const auto last = std::unique(out.checkpoints.begin(), out.checkpoints.end(),
                                [](const auto& a, const auto& b) { return a.step == b.step; });
  out.checkpoints.erase(last, out.checkpoints.end());
  if (out.rows.empty()) return out;
  const auto best =
      std::min_element(out.rows.begin(), out.rows.end(),
                       [](const LossRow& a, const LossRow& b) { return judged(a) < judged(b); });
  const auto add = [&](const char* name, int64_t step) {
    const fs::path file = folder / (std::string(name) + ".marey");
    if (fs::exists(file, none))
      out.checkpoints.push_back({fmt::format("{} (step {})", name, step), file.string(), step});
  };
  add("best", best->step);
  add("last", out.rows.back().step);
  return out;
}

double stageOf(const TrainingRun& run, const Checkpoint& checkpoint) {
  int64_t first = checkpoint.step, last = checkpoint.step;
  for (const Checkpoint& other : run.checkpoints) {
    first = std::min(first, other.step);
    last = std::max(last, other.step);
  }
  const auto steps = static_cast<double>(std::max<int64_t>(1, last - first));
  return static_cast<double>(checkpoint.step - first) / steps;
}

}  // namespace marey
