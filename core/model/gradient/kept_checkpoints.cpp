#include "model/gradient/kept_checkpoints.h"

#include <cstdio>

#include "base/atomic_file.h"
#include "base/error.h"

namespace marey {
namespace {
namespace fs = std::filesystem;

/// Removes the files of steps that are no multiple of `spacing`.
void thin(const fs::path& folder, int64_t spacing) {
  std::error_code none;
  std::vector<fs::path> crowded;
  for (const auto& entry : fs::directory_iterator(folder, none)) {
    long long step = 0;
    const fs::path& file = entry.path();
    if (file.extension() == ".marey" &&
        std::sscanf(file.stem().string().c_str(), "step_%lld", &step) == 1 && step % spacing != 0)
      crowded.push_back(file);
  }
  for (const fs::path& file : crowded) fs::remove(file, none);
}

}  // namespace

int64_t keptEvery(int64_t count, int keep) {
  int64_t every = 1;
  while (count / every > keep) every *= 2;
  return every;
}

void keepCheckpoint(const fs::path& run, const TrainingConfig& config, int64_t step,
                    std::string_view model) {
  if (config.keep == 0 || step <= 0) return;
  const int64_t spacing =
      config.checkpointEvery * keptEvery(step / config.checkpointEvery, config.keep);
  const fs::path folder = run / "checkpoints";
  // A run that ended between two checkpoints has its last one as last.marey.
  if (step % spacing == 0)
    writeFileAtomically(folder / fmt::format("step_{:07}.marey", step), model);
  thin(folder, spacing);
}

}  // namespace marey
