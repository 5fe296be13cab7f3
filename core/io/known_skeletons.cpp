#include "io/known_skeletons.h"

namespace marey::io {
namespace {

Skeleton unmeasured(std::vector<std::string> names, std::vector<int> parents) {
  Skeleton out;
  out.offsets.assign(names.size(), Eigen::Vector3f::Zero());
  out.names = std::move(names);
  out.parents = std::move(parents);
  return out;
}

constexpr int kSmplBody = 22;

Skeleton smplBody() {
  return unmeasured(
      {"pelvis",     "left_hip",    "right_hip",    "spine1",     "left_knee",     "right_knee",
       "spine2",     "left_ankle",  "right_ankle",  "spine3",     "left_foot",     "right_foot",
       "neck",       "left_collar", "right_collar", "head",       "left_shoulder", "right_shoulder",
       "left_elbow", "right_elbow", "left_wrist",   "right_wrist"},
      {-1, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 9, 9, 12, 13, 14, 16, 17, 18, 19});
}

void addJoint(Skeleton& skeleton, std::string name, int parent) {
  skeleton.names.push_back(std::move(name));
  skeleton.parents.push_back(parent);
  skeleton.offsets.push_back(Eigen::Vector3f::Zero());
}

/// Five fingers of three joints each.
void addFingers(Skeleton& skeleton, const std::string& side, int wrist) {
  for (const char* finger : {"index", "middle", "pinky", "ring", "thumb"})
    for (int i = 1; i <= 3; ++i)
      addJoint(skeleton, side + "_" + finger + std::to_string(i),
               i == 1 ? wrist : skeleton.jointCount() - 1);
}

}  // namespace

std::shared_ptr<const Skeleton> smplSkeleton(int joints) {
  if (joints != 22 && joints != 24 && joints != 52 && joints != 55) return nullptr;
  Skeleton out = smplBody();
  const int leftWrist = kSmplBody - 2, rightWrist = kSmplBody - 1, head = 15;
  if (joints == 24) {
    addJoint(out, "left_hand", leftWrist);
    addJoint(out, "right_hand", rightWrist);
  }
  if (joints == 55)
    for (const char* name : {"jaw", "left_eye", "right_eye"}) addJoint(out, name, head);
  if (joints > 24) {
    addFingers(out, "left", leftWrist);
    addFingers(out, "right", rightWrist);
  }
  return std::make_shared<const Skeleton>(std::move(out));
}

Skeleton locomotionSkeleton() {
  return unmeasured(
      {"Hips",         "LeftUpLeg", "LeftLeg",        "LeftFoot", "LeftToeBase",    "RightUpLeg",
       "RightLeg",     "RightFoot", "RightToeBase",   "Spine",    "Spine1",         "Neck1",
       "Head",         "LeftArm",   "LeftForeArm",    "LeftHand", "LeftHandIndex1", "RightArm",
       "RightForeArm", "RightHand", "RightHandIndex1"},
      {-1, 0, 1, 2, 3, 0, 5, 6, 7, 0, 9, 10, 11, 11, 13, 14, 15, 11, 17, 18, 19});
}

Skeleton dogSkeleton() {
  return unmeasured({"Hips",          "Spine",         "Spine1",    "Neck",          "Head",
                     "HeadSite",      "LeftShoulder",  "LeftArm",   "LeftForeArm",   "LeftHand",
                     "LeftHandSite",  "RightShoulder", "RightArm",  "RightForeArm",  "RightHand",
                     "RightHandSite", "LeftUpLeg",     "LeftLeg",   "LeftFoot",      "LeftFootSite",
                     "RightUpLeg",    "RightLeg",      "RightFoot", "RightFootSite", "Tail",
                     "Tail1",         "Tail1Site"},
                    {-1, 0,  1, 2,  3,  4,  2, 6,  7,  8,  9, 2,  11, 12,
                     13, 14, 0, 16, 17, 18, 0, 20, 21, 22, 0, 24, 25});
}

}  // namespace marey::io
