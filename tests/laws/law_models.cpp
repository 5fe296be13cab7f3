#include "law_models.h"

#include <algorithm>
#include <cmath>
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

namespace {

/// MoGlow above a base that foresees the pose ('MG+'), which is fitted in closed form.
Json withBase(Json example, const std::string& base) {
  example["name"] = "moglow-plus-" + base;
  Json& model = example["model"];
  model["pose_base"] = base;
  model["dropout"] = 0.0;
  model["steps"] = 2;
  if (base == "kinematic")
    model.update(
        {{"regimes", 4}, {"foot_clusters", 8}, {"net_features", 20}, {"feet_pass_flow", true}});
  return example;
}

}  // namespace

std::vector<ModelFamily> allSystems() {
  std::vector<ModelFamily> out = allFamilies();
  ModelFamily based = familyNamed("moglow", out, "laws");
  const Json plain = based.example;
  for (const char* base : {"linear", "kinematic"}) {
    based.example = withBase(plain, base);
    out.push_back(based);
  }
  // A recurrent net that sees its own poses, and is trained on them.
  ModelFamily fed = familyNamed("rnn", out, "laws");
  fed.example["name"] = "rnn-feedback";
  fed.example["model"].update({{"past", 2}, {"feedback", true}});
  fed.example["training"].update(
      {{"scheduled_sampling", {{"to", 0.25}, {"end_step", 20}}}, {"input_noise", 0.05}});
  out.push_back(fed);
  ModelFamily noisy = familyNamed("vae", out, "laws");
  noisy.example["name"] = "vae-gaussian";
  noisy.example["model"]["decoder"] = "gaussian";
  out.push_back(noisy);
  return out;
}

std::string systemName(const ModelFamily& family) {
  auto out = family.example.at("name").get<std::string>();
  std::replace(out.begin(), out.end(), '-', '_');
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

std::vector<Clip> walksWithBeat(int count, double seconds, uint64_t seed) {
  auto out = walks(count, seconds, seed);
  for (size_t i = 0; i < out.size(); ++i) {
    Signal beat{.fps = 50.0, .columns = {"loud"}, .values = {}};
    for (int t = 0; t < 50.0 * seconds; ++t)
      beat.values.push_back(std::sin(0.1F * static_cast<float>(t) + static_cast<float>(i)));
    out[i].annotations.signals["beat"] = std::move(beat);
  }
  return out;
}

const DataSet& controlledData() {
  static const DataSet set = [] {
    Progress progress;
    PrepareOptions options{.reverse = false};
    options.features.control = {
        ControlChannel{},
        {.name = "path", .kind = ControlKind::FuturePath, .optional = true, .aheadS = {0.3, 0.6}},
        {.name = "type", .kind = ControlKind::Label},
        {.name = "body", .kind = ControlKind::Skeleton},
        {.name = "beat", .kind = ControlKind::Array, .optional = true, .futureS = 0.2}};
    DataSet out =
        prepareDataSet(walksWithBeat(6, 4.0, 2), walksWithBeat(1, 4.0, 9), options, progress);
    out.hash = "controlled laws";
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
  if (const auto found = made.find(systemName(family)); found != made.end()) return found->second;
  const test::TempFolder folder;
  Progress progress;
  const TrainRequest request = requestOf(family, folder / "run");
  Made out{.result = train(data(), request, allFamilies(), progress), .file = {}, .losses = {}};
  out.file = readTensorFile(out.result.last);
  if (family.makeTrainee) out.losses = lossesIn(request.run / "log.csv");
  return made.emplace(systemName(family), std::move(out)).first->second;
}

}  // namespace marey::test::law
