#include "law_models.h"

#include <cstdio>
#include <map>
#include <sstream>

#include "../unit/base/support.h"
#include "families.h"
#include "toy_family.h"

#include "base/atomic_file.h"
#include "motion/walker.h"

namespace marey::test::law {
namespace {

constexpr double kFps = 20.0;

}  // namespace

std::vector<ModelFamily> allFamilies() {
  std::vector<ModelFamily> out(modelFamilies().begin(), modelFamilies().end());
  out.push_back(test::toyFamily());
  return out;
}

std::vector<Clip> walks(int count, double seconds, uint64_t seed) {
  std::vector<Clip> out;
  for (auto& walked : walkerDataSet(count, seconds, seed, kFps))
    out.push_back(std::move(walked.clip));
  return out;
}

const DataSet& data() {
  static const DataSet set = [] {
    Progress progress;
    DataSet out = prepareDataSet(walks(4, 4.0, 2), walks(1, 4.0, 9), {}, progress);
    out.hash = "laws";
    return out;
  }();
  return set;
}

namespace {

std::vector<double> lossesIn(const std::filesystem::path& log) {
  std::vector<double> out;
  std::istringstream in(readFile(log));
  std::string line;
  std::getline(in, line);
  while (std::getline(in, line)) {
    double step = 0, seconds = 0, rate = 0, loss = 0;
    if (std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf", &step, &seconds, &rate, &loss) == 4)
      out.push_back(loss);
  }
  return out;
}

}  // namespace

TrainRequest requestOf(const ModelFamily& family, const std::filesystem::path& run) {
  TrainRequest request;
  request.config = family.example;
  request.configOrigin = "example.json";
  request.run = run;
  if (family.makeTrainee) {
    request.config["training"]["checkpoint_every"] = 10;
    request.steps = 20;
  }
  return request;
}

const Made& madeBy(const ModelFamily& family) {
  static std::map<std::string, Made> made;
  if (const auto found = made.find(family.name); found != made.end()) return found->second;
  const test::TempFolder folder;
  Progress progress;
  const TrainRequest request = requestOf(family, folder / "run");
  Made out{.result = train(data(), request, allFamilies(), progress), .file = {}, .losses = {}};
  out.file = readTensorFile(out.result.last);
  if (family.makeTrainee) out.losses = lossesIn(request.run / "log.csv");
  return made.emplace(family.name, std::move(out)).first->second;
}

}  // namespace marey::test::law
