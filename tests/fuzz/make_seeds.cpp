// Writes small valid inputs of every fuzz target, from the project's own walker.
#include <algorithm>
#include <array>
#include <iostream>
#include <string>

#include "experiment_seeds.h"
#include "npz_fuzz_names.h"
#include "pickle_seeds.h"
#include "text_seeds.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/npy.h"
#include "io/clip_io.h"
#include "io/npz_clips.h"
#include "motion/walker.h"

namespace marey {
namespace {

namespace fs = std::filesystem;

Clip shortWalk() {
  const std::vector<RootFrame> path(4);
  return walk(path, {.fps = 20.0}).clip;
}

/// The layout that npz_fuzz.cpp describes.
std::string packed(const NpzArrays& arrays) {
  std::string out(1, '\1');
  const auto add = [&out](const std::string& name, const std::string& npy) {
    const auto at = std::find(kFuzzNames.begin(), kFuzzNames.end(), name);
    if (at == kFuzzNames.end() || npy.size() > 0xFFFF) return;
    out += static_cast<char>(at - kFuzzNames.begin());
    out += static_cast<char>(npy.size() & 0xFFU);
    out += static_cast<char>(npy.size() >> 8U);
    out += npy;
  };
  for (const auto& [name, tensor] : arrays.numbers) add(name, serialiseNpy(tensor));
  for (const auto& [name, text] : arrays.texts) add(name, serialiseNpy(text));
  return out;
}

NpzArrays only(const std::string& name, const Tensor& tensor) {
  return {.numbers = {{name, tensor}}, .texts = {}, .others = {}};
}

/// Two frames of a standing person in SMPL's order.
Tensor smplJoints() {
  const std::array<float, 66> pose = {
      0,      0.9f,  0,      0.09f, 0.86f,  0,     -0.09f, 0.86f,  0,      0,      1.02f,
      0,      0.09f, 0.46f,  0.01f, -0.09f, 0.46f, 0.01f,  0,      1.1f,   0,      0.09f,
      0.08f,  0,     -0.09f, 0.08f, 0,      0,     1.17f,  0,      0.09f,  0.01f,  0.12f,
      -0.09f, 0.01f, 0.12f,  0,     1.42f,  0,     0.05f,  1.39f,  0,      -0.05f, 1.39f,
      0,      0,     1.52f,  0,     0.17f,  1.39f, 0,      -0.17f, 1.39f,  0,      0.2f,
      1.12f,  0,     -0.2f,  1.12f, 0,      0.22f, 0.89f,  0.07f,  -0.22f, 0.89f,  0.07f};
  std::vector<float> values(pose.begin(), pose.end());
  values.insert(values.end(), pose.begin(), pose.end());
  return Tensor::fromFloats({2, 22, 3}, values.data());
}

void writeNpzSeeds(const Clip& clip, const fs::path& folder) {
  io::writeClip(clip, folder / "whole.npz");
  const std::string archive = readFile(folder / "whole.npz");
  fs::remove(folder / "whole.npz");
  writeFileAtomically(folder / "archive", std::string(1, '\0') + archive);
  const NpzArrays whole = io::arraysOfClip(clip, Json::object());
  writeFileAtomically(folder / "clip", packed(whole));
  NpzArrays bare = whole;
  bare.numbers.erase("offsets");
  bare.texts.erase("source");
  writeFileAtomically(folder / "without_offsets", packed(bare));
  const std::vector<float> zeros(2 * 3 * 66, 0.0f);
  writeFileAtomically(folder / "features",
                      packed(only("clips", Tensor::fromFloats({2, 3, 66}, zeros.data()))));
  NpzArrays joints = only("joints", smplJoints());
  joints.texts["name"] = TextArray::one("walk");
  writeFileAtomically(folder / "joints", packed(joints));
  const std::string npy = serialiseNpy(smplJoints());
  writeFileAtomically(folder / "npy", std::string(1, '\2') + npy);
  std::string bigEndian = npy;
  bigEndian.replace(bigEndian.find("<f4"), 3, ">f4");
  writeFileAtomically(folder / "npy_big_endian", std::string(1, '\2') + bigEndian);
  const std::string columns = "'fortran_order': True ", lettersNone = "'<U0'";
  std::string empty = npy;
  empty.replace(empty.find("'fortran_order': False"), columns.size() + 1, columns + " ");
  empty.replace(empty.find("'<f4'"), lettersNone.size(), lettersNone);
  writeFileAtomically(folder / "npy_no_letters", std::string(1, '\2') + empty);
  std::string structure = npy;
  structure.replace(structure.find("'<f4'"), 5, "[('x'");
  writeFileAtomically(folder / "npy_structure", std::string(1, '\2') + structure);
}

void writeBvhSeeds(const Clip& clip, const fs::path& folder) {
  io::writeClip(clip, folder / "rotations.bvh");
  Clip positions = clip;
  positions.transforms.reset();
  io::writeClip(positions, folder / "positions.bvh", {.eulerOrder = "YXZ"});
  for (const char* name : {"rotations.bvh", "positions.bvh"})
    fs::remove(folder / (std::string(name) + ".recipe.json"));
  writeBvhKinds(folder);
}

void writeAcclaimSeed(const fs::path& folder) {
  const std::string asf =
      ":version 1.10\n:units\n length 0.45\n angle deg\n:root\n order TX TY TZ RX RY RZ\n axis "
      "XYZ\n"
      " position 0 0 0\n orientation 0 0 0\n:bonedata\n begin\n name leg\n direction 0 -1 0\n"
      " length 8\n axis 0 0 20 XYZ\n dof rx ry rz\n limits (-160 20)\n (-70 70)\n (-60 70)\n end\n"
      ":hierarchy\n begin\n root leg\n end\n";
  const std::string amc =
      ":FULLY-SPECIFIED\n:DEGREES\n1\nroot 1 2 3 0 0 0\nleg 1 2 3\n2\nroot 1 2 3 4 5 6\nleg 0 0 "
      "0\n";
  writeAcclaimKinds(folder, asf, amc);
}

void writeDogSeed(const fs::path& folder) {
  std::string row = "0.1";
  for (int i = 1; i < 81; ++i) row += fmt::format(",\t{:.2f}", 0.01 * i);
  writeTextKinds(folder, row + "\n" + row + "\n");
}

void writeExperimentSeeds(const fs::path& folder) {
  writeJson(folder / "whole", wholeDocument());
  writeJson(folder / "rich", richDocument());
  writeJson(folder / "training", trainingSeed());
  // Parts alone, which mutations reach sooner than inside a long document.
  const Json whole = viewSeed();
  for (const char* part : {"scene", "camera", "sets"})
    writeJson(folder / part, {{"natural", Json::array({"walker:4,10,1"})},
                              {"view", Json::object({{part, whole[part]}})}});
  writeJson(folder / "paths",
            {{"natural", Json::array({"walker:4,10,1"})}, {"paths", pathKinds()}});
}

}  // namespace
}  // namespace marey

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: fuzz_seeds FOLDER\n";
    return 2;
  }
  try {
    const std::filesystem::path folder = argv[1];
    const marey::Clip clip = marey::shortWalk();
    marey::writeBvhSeeds(clip, folder / "bvh");
    marey::writeNpzSeeds(clip, folder / "npz");
    marey::writeAcclaimSeed(folder / "asf_amc");
    marey::writeDogSeed(folder / "dog_text");
    marey::writePickleSeeds(folder / "pickle");
    marey::writeExperimentSeeds(folder / "experiment");
  } catch (const marey::Error& e) {
    std::cerr << e.what() << "\n";
    return 1;
  }
  return 0;
}
