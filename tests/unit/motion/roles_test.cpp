#include "motion/roles.h"

#include <gtest/gtest.h>

#include "base/error.h"

namespace marey {
namespace {

/// A skeleton of these names, every joint below the first.
Skeleton named(const std::vector<std::string>& names) {
  Skeleton s;
  s.names = names;
  s.parents.assign(names.size(), 0);
  s.parents[0] = -1;
  s.offsets.assign(names.size(), Eigen::Vector3f::Zero());
  return s;
}

struct Expected {
  std::string hips, leftHip, rightHip, leftShoulder, rightShoulder;
  std::vector<std::string> feet;
};

void expectRoles(const std::vector<std::string>& names, const Expected& expected) {
  const Skeleton s = named(names);
  const SkeletonRoles roles = rolesOf(s);
  EXPECT_EQ(s.names[static_cast<size_t>(roles.hips)], expected.hips);
  EXPECT_EQ(roles.leftHip, s.find(expected.leftHip));
  EXPECT_EQ(roles.rightHip, s.find(expected.rightHip));
  EXPECT_EQ(roles.leftShoulder, s.find(expected.leftShoulder));
  EXPECT_EQ(roles.rightShoulder, s.find(expected.rightShoulder));
  std::vector<std::string> feet;
  for (const int j : roles.feet) feet.push_back(s.names[static_cast<size_t>(j)]);
  EXPECT_EQ(feet, expected.feet);
}

const std::vector<std::string> kCmuBvh = {
    "Hips",      "LHipJoint",     "LeftUpLeg", "LeftLeg",      "LeftFoot",     "LeftToeBase",
    "RHipJoint", "RightUpLeg",    "RightLeg",  "RightFoot",    "RightToeBase", "LowerBack",
    "Spine",     "Neck",          "Head",      "LeftShoulder", "LeftArm",      "LeftForeArm",
    "LThumb",    "RightShoulder", "RightArm",  "RightForeArm", "RThumb"};
const std::vector<std::string> kDog = {
    "Hips",       "Spine",         "Neck",          "Head",          "LeftShoulder",
    "LeftArm",    "LeftHand",      "LeftHandSite",  "RightShoulder", "RightArm",
    "RightHand",  "RightHandSite", "LeftUpLeg",     "LeftFoot",      "LeftFootSite",
    "RightUpLeg", "RightFoot",     "RightFootSite", "Tail"};

TEST(Roles, CmuJointsAreKnownInBvhAndAsfNames) {
  expectRoles(
      kCmuBvh,
      {"Hips", "LeftUpLeg", "RightUpLeg", "LeftArm", "RightArm", {"LeftFoot", "RightFoot"}});
  expectRoles({"root", "lhipjoint", "lfemur", "ltibia", "lfoot", "ltoes", "rhipjoint", "rfemur",
               "rtibia", "rfoot", "rtoes", "lowerback", "lclavicle", "lhumerus", "lradius",
               "rclavicle", "rhumerus", "rradius"},
              {"root", "lfemur", "rfemur", "lhumerus", "rhumerus", {"lfoot", "rfoot"}});
}

TEST(Roles, InBiovisionNamesTheShoulderIsTheUpperArmAndTheAnkleTheFoot) {
  expectRoles({"Hips", "LHipJoint", "LeftHip", "LeftKnee", "LeftAnkle", "LeftToe", "RHipJoint",
               "RightHip", "RightKnee", "RightAnkle", "RightToe", "Chest", "LeftCollar",
               "LeftShoulder", "LeftElbow", "RightCollar", "RightShoulder", "RightElbow"},
              {"Hips",
               "LeftHip",
               "RightHip",
               "LeftShoulder",
               "RightShoulder",
               {"LeftAnkle", "RightAnkle"}});
}

TEST(Roles, AMixamoPrefixDoesNotMatter) {
  expectRoles({"mixamorig:Hips", "mixamorig:LeftUpLeg", "mixamorig:LeftFoot",
               "mixamorig:RightUpLeg", "mixamorig:RightFoot", "mixamorig:LeftShoulder",
               "mixamorig:LeftArm", "mixamorig:RightShoulder", "mixamorig:RightArm"},
              {"mixamorig:Hips",
               "mixamorig:LeftUpLeg",
               "mixamorig:RightUpLeg",
               "mixamorig:LeftArm",
               "mixamorig:RightArm",
               {"mixamorig:LeftFoot", "mixamorig:RightFoot"}});
}

TEST(Roles, SidesAsLastLettersAreKnown) {
  expectRoles(
      {"joint_Root", "Hips", "Spine", "Shoulder_L", "UpperArm_L", "Hand_L", "Shoulder_R",
       "UpperArm_R", "Hand_R", "UpperLeg_L", "LowerLeg_L", "Foot_L", "Toes_L", "UpperLeg_R",
       "LowerLeg_R", "Foot_R", "Toes_R"},
      {"Hips", "UpperLeg_L", "UpperLeg_R", "UpperArm_L", "UpperArm_R", {"Foot_L", "Foot_R"}});
}

TEST(Roles, TheFeetOfAQuadrupedAreItsFourToesLeftFirst) {
  expectRoles(kDog, {"Hips",
                     "LeftUpLeg",
                     "RightUpLeg",
                     "LeftArm",
                     "RightArm",
                     {"LeftHandSite", "RightHandSite", "LeftFootSite", "RightFootSite"}});
  EXPECT_TRUE(rolesOf(named(kDog)).quadruped);
  EXPECT_FALSE(rolesOf(named(kCmuBvh)).quadruped);
}

TEST(Roles, MirrorPairsJointsByNameAndKeepsTheMidline) {
  const std::vector<std::pair<std::string, std::string>> pairs = {
      {"LeftFoot", "RightFoot"}, {"LHipJoint", "RHipJoint"}, {"LThumb", "RThumb"},
      {"Hips", "Hips"},          {"LowerBack", "LowerBack"}, {"Neck", "Neck"}};
  const Skeleton s = named(kCmuBvh);
  const std::vector<int> mirror = rolesOf(s).mirror;
  for (const auto& [a, b] : pairs) {
    EXPECT_EQ(mirror[static_cast<size_t>(s.find(a))], s.find(b)) << a;
    EXPECT_EQ(mirror[static_cast<size_t>(s.find(b))], s.find(a)) << b;
  }
  for (size_t j = 0; j < mirror.size(); ++j)
    EXPECT_EQ(mirror[static_cast<size_t>(mirror[j])], static_cast<int>(j));
}

TEST(Roles, MirrorKnowsLowerCaseAndSuffixHabits) {
  const Skeleton s = named({"root", "lfemur", "rfemur", "lowerback", "Toes_L", "Toes_R",
                            "rig:LeftArm", "rig:RightArm", "r"});
  const std::vector<int> mirror = rolesOf(s).mirror;
  EXPECT_EQ(mirror, (std::vector<int>{0, 2, 1, 3, 5, 4, 7, 6, 8}));
}

TEST(Roles, HabitsOfOtherProgramsAreKnown) {
  // Unreal, OptiTrack Motive, DAZ, Character Creator, Valve, VRM, MakeHuman, Kinect, SMPL-X.
  expectRoles({"root",       "pelvis",     "spine_01",         "clavicle_l",
               "upperarm_l", "lowerarm_l", "clavicle_r",       "upperarm_r",
               "lowerarm_r", "thigh_l",    "thigh_twist_01_l", "calf_l",
               "foot_l",     "ball_l",     "thigh_r",          "thigh_twist_01_r",
               "calf_r",     "foot_r",     "ball_r",           "ik_foot_l",
               "ik_foot_r"},
              {"pelvis", "thigh_l", "thigh_r", "upperarm_l", "upperarm_r", {"foot_l", "foot_r"}});
  expectRoles({"Hip", "Ab", "Chest", "LShoulder", "LUArm", "LFArm", "LHand", "RShoulder", "RUArm",
               "RFArm", "RHand", "LThigh", "LShin", "LFoot", "RThigh", "RShin", "RFoot"},
              {"Hip", "LThigh", "RThigh", "LUArm", "RUArm", {"LFoot", "RFoot"}});
  expectRoles(
      {"hip", "pelvis", "lThighBend", "lThighTwist", "lShin", "lFoot", "rThighBend", "rThighTwist",
       "rShin", "rFoot", "abdomenLower", "lCollar", "lShldrBend", "rCollar", "rShldrBend"},
      {"hip", "lThighBend", "rThighBend", "lShldrBend", "rShldrBend", {"lFoot", "rFoot"}});
  expectRoles(
      {"CC_Base_Hip", "CC_Base_Pelvis", "CC_Base_L_Thigh", "CC_Base_L_Calf", "CC_Base_L_Foot",
       "CC_Base_R_Thigh", "CC_Base_R_Calf", "CC_Base_R_Foot", "CC_Base_L_Clavicle",
       "CC_Base_L_Upperarm", "CC_Base_R_Clavicle", "CC_Base_R_Upperarm"},
      {"CC_Base_Hip",
       "CC_Base_L_Thigh",
       "CC_Base_R_Thigh",
       "CC_Base_L_Upperarm",
       "CC_Base_R_Upperarm",
       {"CC_Base_L_Foot", "CC_Base_R_Foot"}});
  expectRoles(
      {"ValveBiped.Bip01_Pelvis", "ValveBiped.Bip01_L_Thigh", "ValveBiped.Bip01_L_Calf",
       "ValveBiped.Bip01_L_Foot", "ValveBiped.Bip01_R_Thigh", "ValveBiped.Bip01_R_Calf",
       "ValveBiped.Bip01_R_Foot", "ValveBiped.Bip01_L_UpperArm", "ValveBiped.Bip01_R_UpperArm"},
      {"ValveBiped.Bip01_Pelvis",
       "ValveBiped.Bip01_L_Thigh",
       "ValveBiped.Bip01_R_Thigh",
       "ValveBiped.Bip01_L_UpperArm",
       "ValveBiped.Bip01_R_UpperArm",
       {"ValveBiped.Bip01_L_Foot", "ValveBiped.Bip01_R_Foot"}});
  expectRoles({"root", "upperleg01.L", "upperleg02.L", "lowerleg01.L", "foot.L", "upperleg01.R",
               "upperleg02.R", "lowerleg01.R", "foot.R", "upperarm01.L", "upperarm01.R"},
              {"root",
               "upperleg01.L",
               "upperleg01.R",
               "upperarm01.L",
               "upperarm01.R",
               {"foot.L", "foot.R"}});
  expectRoles({"SpineBase", "HipLeft", "KneeLeft", "AnkleLeft", "FootLeft", "HipRight", "KneeRight",
               "AnkleRight", "FootRight", "ShoulderLeft", "ShoulderRight"},
              {"SpineBase",
               "HipLeft",
               "HipRight",
               "ShoulderLeft",
               "ShoulderRight",
               {"AnkleLeft", "AnkleRight"}});
  expectRoles({"pelvis", "left_hip", "left_knee", "left_ankle", "left_foot", "right_hip",
               "right_knee", "right_ankle", "right_foot", "left_collar", "left_shoulder",
               "right_collar", "right_shoulder"},
              {"pelvis",
               "left_hip",
               "right_hip",
               "left_shoulder",
               "right_shoulder",
               {"left_ankle", "right_ankle"}});
}

TEST(Roles, ALetterIsASideOnlyWhereTheOtherSideIsThere) {
  const Skeleton s = named({"root", "lowerback", "lowerneck", "ribs", "lwrist", "rwrist"});
  EXPECT_EQ(rolesOf(s).mirror, (std::vector<int>{0, 1, 2, 3, 5, 4}));
}

TEST(Roles, UnknownNamesGiveNoRolesAndNoFacing) {
  const SkeletonRoles roles = rolesOf(named({"a", "b", "c"}));
  EXPECT_EQ(roles.hips, 0);
  EXPECT_FALSE(roles.hasFacing());
  EXPECT_TRUE(roles.feet.empty());
  EXPECT_EQ(roles.mirror, (std::vector<int>{0, 1, 2}));
}

TEST(Roles, JointsByNameFindsThemInOrderAndNamesWhatItDoesNotKnow) {
  const Skeleton s = named({"Hips", "Foot_L", "Foot_R"});
  EXPECT_EQ(jointsByName(s, "Foot_R, Foot_L"), (std::vector<int>{2, 1}));
  try {
    jointsByName(s, "Foot_L,Fot_R");
    FAIL() << "expected an error";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("'Fot_R'"), std::string::npos);
    EXPECT_NE(std::string(e.what()).find("Foot_R"), std::string::npos);
  }
}

}  // namespace
}  // namespace marey
