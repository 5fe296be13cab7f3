#include "model/pose_units.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace marey {
namespace {

bool isLength(const Channel& channel) {
  return channel.kind == ChannelKind::Position;
}

const Representation& representationOf(const FeatureSpec& features) {
  return marey::representationOf(features, "model");
}

}  // namespace

std::vector<Channel> channelsOf(const FeatureSpec& features, const Skeleton* skeleton,
                                int poseDim) {
  if (skeleton != nullptr) return representationOf(features).channels(*skeleton);
  return std::vector<Channel>(static_cast<size_t>(poseDim));
}

std::vector<Channel> channelsOf(const ModelInfo& info) {
  return channelsOf(info.features, info.skeleton.get(), info.poseDim);
}

int jointsOf(const ModelInfo& info) {
  return info.skeleton ? info.skeleton->jointCount()
                       : representationOf(info.features).joints(info.poseDim);
}

std::string likelihoodUnit(const FeatureSpec& features) {
  return "nats per frame, " + representationOf(features).shownUnits;
}

std::string likelihoodUnit(const ModelInfo& info) {
  return likelihoodUnit(info.features);
}

std::string natsUnit(const std::string& unit) {
  const std::string perFrame = " per frame";
  const auto at = unit.find(perFrame);
  return at == std::string::npos ? unit : std::string(unit).erase(at, perFrame.size());
}

double toShownPerFrame(const Standardiser& standardiser, const std::vector<Channel>& channels) {
  if (standardiser.empty()) return 0.0;
  const auto lengths = std::count_if(channels.begin(), channels.end(), isLength);
  return standardiser.logDetPerFrame() - static_cast<double>(lengths) * std::log(100.0);
}

std::vector<double> floorScales(const std::vector<Channel>& channels) {
  std::vector<double> out;
  out.reserve(channels.size());
  for (const Channel& channel : channels) out.push_back(isLength(channel) ? 1.0 : 1.0 / kFloorArmM);
  return out;
}

bool allLengths(const ModelInfo& info) {
  const auto channels = channelsOf(info);
  return std::all_of(channels.begin(), channels.end(), isLength);
}

std::string floorSizeText(const ModelInfo& info) {
  std::string out = fmt::format("{:g} mm", info.observation.floorMm());
  if (!allLengths(info))
    out +=
        fmt::format(" and {:g} rad (by which a point {:g} m from the joint moves {:g} mm)",
                    info.observation.floorM / kFloorArmM, kFloorArmM, info.observation.floorMm());
  return out;
}

void requireFittingPoses(const ModelInfo& info, const std::string& origin) {
  const Representation& poses = marey::representationOf(info.features, origin);
  if (!info.skeleton) {
    if (poses.rotations)
      throw InputError({.path = origin, .item = "key 'skeleton'"},
                       "the skeleton that " + poses.name + " poses are of", "none");
    return;
  }
  if (const int width = poses.width(*info.skeleton); info.poseDim != width)
    throwInput(
        {.path = origin, .item = "key 'pose_dim'"},
        fmt::format("{}: {} poses of {} joints", width, poses.name, info.skeleton->jointCount()),
        "{}", info.poseDim);
}

}  // namespace marey
