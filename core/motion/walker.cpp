#include "motion/walker.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "motion/walker_body.h"
#include "motion/walker_foot.h"
#include "motion/walker_plan.h"

namespace marey {
namespace {

using namespace walker;

/// Frames worked out beyond both ends, so that smoothing sees no edge.
constexpr double kPadS = 0.5;

std::shared_ptr<const Skeleton> buildSkeleton() {
  Skeleton s;
  s.names = {"Hips",          "LeftUpLeg",     "LeftLeg",   "LeftFoot",     "LeftToeBase",
             "RightUpLeg",    "RightLeg",      "RightFoot", "RightToeBase", "Spine",
             "Spine1",        "Neck",          "Head",      "LeftArm",      "LeftForeArm",
             "LeftHand",      "LeftHandIndex", "RightArm",  "RightForeArm", "RightHand",
             "RightHandIndex"};
  s.parents = {-1, 0, 1, 2, 3, 0, 5, 6, 7, 0, 9, 10, 11, 11, 13, 14, 15, 11, 17, 18, 19};
  const auto footDrop = static_cast<float>(kToeHeightM - kAnkleHeightM);
  const auto footLength = static_cast<float>(kFootLengthM);
  s.offsets = {{0, 0.975f, 0},
               {0.09f, -0.05f, 0},
               {0, -0.42f, 0},
               {0, -0.42f, 0},
               {0, footDrop, footLength},
               {-0.09f, -0.05f, 0},
               {0, -0.42f, 0},
               {0, -0.42f, 0},
               {0, footDrop, footLength},
               {0, 0.10f, -0.01f},
               {0, 0.14f, -0.01f},
               {0, 0.25f, 0},
               {0, 0.17f, 0.03f},
               {0.18f, -0.04f, 0},
               {0.28f, 0, 0},
               {0.25f, 0, 0},
               {0.09f, 0, 0},
               {-0.18f, -0.04f, 0},
               {-0.28f, 0, 0},
               {-0.25f, 0, 0},
               {-0.09f, 0, 0}};
  s.endSites = {{LeftToeBase, {0, 0, 0.06f}},
                {RightToeBase, {0, 0, 0.06f}},
                {Head, {0, 0.12f, 0}},
                {LeftHandIndex, {0.08f, 0, 0}},
                {RightHandIndex, {-0.08f, 0, 0}}};
  return std::make_shared<const Skeleton>(std::move(s));
}

const WalkerStyle& styleOf(const std::string& name) {
  std::string known;
  for (const WalkerStyle& style : walkerStyles()) {
    if (style.name == name) return style;
    known += (known.empty() ? "" : ", ") + style.name;
  }
  throw InputError({.path = "walker", .item = "style"}, "one of " + known, "'" + name + "'");
}

void checkPath(const std::vector<RootFrame>& path, double fps) {
  const Place place{.path = "walker", .item = "path"};
  if (path.empty()) throw InputError(place, "at least one root frame", "none");
  if (!(fps > 0.0) || !std::isfinite(fps)) throwInput(place, "a positive frame rate", "{}", fps);
  for (size_t i = 0; i < path.size(); ++i)
    if (!std::isfinite(path[i].x) || !std::isfinite(path[i].z) || !std::isfinite(path[i].heading))
      throw InputError({.path = "walker", .frame = static_cast<int64_t>(i) + 1, .item = "path"},
                       "finite numbers", "NaN or infinity");
}

/// How far the left foot is ahead of the right one, and which foot carries the body.
double strideOf(const FrameDrive& d) {
  const Eigen::Vector3d gap = d.feet[kLeft].ankle - d.feet[kRight].ankle;
  return gap.x() * std::sin(d.root.heading) + gap.z() * std::cos(d.root.heading);
}

double loadOf(const FrameDrive& d) {
  const double left = d.feet[kLeft].toe.y() - kToeHeightM;
  const double right = d.feet[kRight].toe.y() - kToeHeightM;
  return std::clamp((right - left) / 0.03, -1.0, 1.0);
}

std::vector<FrameDrive> driveFrames(const PathCurve& path, const std::array<FootTrack, 2>& tracks,
                                    double fps, int count, int pad) {
  std::vector<FrameDrive> drives;
  std::vector<double> stride;
  std::vector<double> weight;
  for (int i = -pad; i < count + pad; ++i) {
    FrameDrive d;
    d.timeS = i / fps;
    d.root = path.at(d.timeS);
    const BodyVelocity v = path.velocity(d.timeS - 0.15, d.timeS + 0.15);
    d.speed = v.speed();
    d.turn = v.turn;
    for (int foot : {kLeft, kRight}) d.feet[foot] = tracks[foot].at(d.timeS);
    const Eigen::Vector3d gap = d.feet[kLeft].ankle - d.feet[kRight].ankle;
    d.spread = std::hypot(gap.x(), gap.z());
    stride.push_back(strideOf(d));
    weight.push_back(loadOf(d));
    drives.push_back(d);
  }
  stride = smoothed(stride, 0.05 * fps);
  weight = smoothed(weight, 0.10 * fps);
  for (size_t i = 0; i < drives.size(); ++i) {
    drives[i].stride = stride[i];
    drives[i].weight = weight[i];
  }
  return drives;
}

WalkerTruth truthOf(const StepPlan& plan, const std::array<FootTrack, 2>& tracks, double endS) {
  WalkerTruth truth;
  for (int foot : {kLeft, kRight}) {
    const auto contacts = tracks[foot].contacts(foot == kLeft ? LeftFoot : RightFoot, endS);
    truth.contacts.insert(truth.contacts.end(), contacts.begin(), contacts.end());
  }
  std::stable_sort(truth.contacts.begin(), truth.contacts.end(),
                   [](const Contact& a, const Contact& b) { return a.beginS < b.beginS; });
  std::vector<Step> steps = plan.steps[kLeft];
  steps.insert(steps.end(), plan.steps[kRight].begin(), plan.steps[kRight].end());
  std::sort(steps.begin(), steps.end(),
            [](const Step& a, const Step& b) { return a.landS < b.landS; });
  for (size_t i = 1; i < steps.size(); ++i) {
    const bool inside = steps[i - 1].landS >= 0.0 && steps[i].landS <= endS;
    if (inside && steps[i].continued && steps[i].foot != steps[i - 1].foot)
      truth.stepTimesS.push_back(steps[i].landS - steps[i - 1].landS);
  }
  const auto skeleton = walkerSkeleton();
  for (const auto& [parent, child] : skeleton->bones())
    truth.boneLengthsM.push_back(skeleton->offsets[child].norm());
  return truth;
}

}  // namespace

const std::vector<WalkerStyle>& walkerStyles() {
  static const std::vector<WalkerStyle> styles = {
      {.name = "normal"},
      {.name = "long-stride",
       .strideScale = 1.18,
       .stanceShare = 0.60,
       .armSwing = 0.50,
       .lean = 0.08,
       .stepHeightM = 0.11,
       .bounceM = 0.03,
       .crouchM = 0.03},
      {.name = "short-quick",
       .strideScale = 0.76,
       .stanceShare = 0.62,
       .armSwing = 0.26,
       .lean = 0.07,
       .stepHeightM = 0.07,
       .stepWidthM = 0.14,
       .bounceM = 0.012},
      {.name = "wide",
       .strideScale = 0.92,
       .stanceShare = 0.64,
       .armSwing = 0.34,
       .lean = 0.02,
       .stepWidthM = 0.30,
       .bounceM = 0.022,
       .crouchM = 0.04},
      {.name = "crouched",
       .strideScale = 0.95,
       .stanceShare = 0.65,
       .armSwing = 0.20,
       .lean = 0.45,
       .stepHeightM = 0.12,
       .stepWidthM = 0.20,
       .bounceM = 0.015,
       .crouchM = 0.16},
      {.name = "proud",
       .strideScale = 1.05,
       .stanceShare = 0.60,
       .armSwing = 0.62,
       .lean = -0.08,
       .stepHeightM = 0.17,
       .stepWidthM = 0.15,
       .bounceM = 0.035,
       .crouchM = 0.012},
      {.name = "tired",
       .strideScale = 0.85,
       .stanceShare = 0.67,
       .armSwing = 0.14,
       .lean = 0.24,
       .stepHeightM = 0.05,
       .bounceM = 0.015,
       .crouchM = 0.05},
  };
  return styles;
}

std::shared_ptr<const Skeleton> walkerSkeleton() {
  static const std::shared_ptr<const Skeleton> skeleton = buildSkeleton();
  return skeleton;
}

WalkerClip walk(const std::vector<RootFrame>& path, const WalkerOptions& options) {
  checkPath(path, options.fps);
  const Gait gait = drawGait(styleOf(options.style), options.seed);
  const PathCurve curve(path, options.fps);
  const StepPlan plan = planSteps(curve, gait, options.seed);
  const std::array<FootTrack, 2> tracks = {FootTrack(plan.start[kLeft], plan.steps[kLeft]),
                                           FootTrack(plan.start[kRight], plan.steps[kRight])};
  const int count = static_cast<int>(path.size());
  const int pad = static_cast<int>(std::ceil(kPadS * options.fps));
  const auto drives = driveFrames(curve, tracks, options.fps, count, pad);
  const Body body(gait, options.seed, options.noise, -1.0, curve.endS() + 1.0);
  const auto heights = body.hipHeights(drives, options.fps);

  WalkerClip out;
  out.clip.name = "walker-" + options.style + "-" + std::to_string(options.seed);
  out.clip.skeleton = walkerSkeleton();
  out.clip.fps = options.fps;
  out.clip.source.format = "walker";
  out.clip.source.fps = options.fps;
  out.clip.annotations.labels = {{.label = options.style}};
  JointTransforms transforms;
  for (int i = pad; i < pad + count; ++i)
    body.pose(drives[i], heights[i], out.clip.positions, transforms);
  out.clip.transforms = std::move(transforms);
  out.truth = truthOf(plan, tracks, curve.endS());
  return out;
}

}  // namespace marey
