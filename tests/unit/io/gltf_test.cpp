// The written files are read back by tinygltf; node transforms are multiplied here, from the
// format's definition.
#include <cmath>
#include <cstring>

#include "unit/io/support.h"
#include <tiny_gltf.h>

#include "base/atomic_file.h"
#include "base/json.h"
#include "io/clip_io.h"
#include "motion/kinematics.h"

namespace marey::io {
namespace {

using Matrix = Eigen::Matrix4f;

Clip person() {
  Clip clip = test::smallPerson();
  clip.positions = forwardKinematics(*clip.skeleton, *clip.transforms);
  return clip;
}

tinygltf::Model readScene(const std::filesystem::path& path) {
  tinygltf::TinyGLTF reader;
  tinygltf::Model out;
  std::string error, warning;
  const bool read = path.extension() == ".glb"
                        ? reader.LoadBinaryFromFile(&out, &error, &warning, path.string())
                        : reader.LoadASCIIFromFile(&out, &error, &warning, path.string());
  EXPECT_TRUE(read) << error;
  EXPECT_EQ(error + warning, "");
  return out;
}

/// The numbers of an accessor, one after the other.
template <typename T>
std::vector<T> valuesOf(const tinygltf::Model& model, int index) {
  const auto& accessor = model.accessors.at(static_cast<size_t>(index));
  const auto& view = model.bufferViews.at(static_cast<size_t>(accessor.bufferView));
  const auto& bytes = model.buffers.at(static_cast<size_t>(view.buffer)).data;
  EXPECT_EQ(tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(accessor.componentType)),
            static_cast<int>(sizeof(T)));
  const size_t count =
      accessor.count *
      static_cast<size_t>(tinygltf::GetNumComponentsInType(static_cast<uint32_t>(accessor.type)));
  const size_t begin = view.byteOffset + accessor.byteOffset;
  EXPECT_EQ(begin % 4, 0u);
  EXPECT_LE(begin + count * sizeof(T), bytes.size());
  std::vector<T> out(count);
  std::memcpy(out.data(), bytes.data() + begin, count * sizeof(T));
  return out;
}

Matrix localMatrix(const Vec3& translation, const Quat& rotation) {
  Matrix out = Matrix::Identity();
  out.topLeftCorner<3, 3>() = rotation.toRotationMatrix();
  out.topRightCorner<3, 1>() = translation;
  return out;
}

/// World matrices of every node at key `frame`, or at rest for -1.
std::vector<Matrix> worldMatrices(const tinygltf::Model& model, int frame) {
  std::vector<Vec3> translations(model.nodes.size(), Vec3::Zero());
  std::vector<Quat> rotations(model.nodes.size(), Quat::Identity());
  std::vector<int> parents(model.nodes.size(), -1);
  for (size_t n = 0; n < model.nodes.size(); ++n) {
    const auto& at = model.nodes[n].translation;
    if (!at.empty()) translations[n] = Eigen::Vector3d(at[0], at[1], at[2]).cast<float>();
    for (const int child : model.nodes[n].children)
      parents[static_cast<size_t>(child)] = static_cast<int>(n);
  }
  const auto& animation = model.animations.at(0);
  for (const auto& channel : animation.channels) {
    if (frame < 0) break;
    const auto& sampler = animation.samplers.at(static_cast<size_t>(channel.sampler));
    EXPECT_EQ(sampler.interpolation, "LINEAR");
    const std::vector<float> v = valuesOf<float>(model, sampler.output);
    const auto node = static_cast<size_t>(channel.target_node);
    const size_t i = static_cast<size_t>(frame);
    if (channel.target_path == "rotation")
      rotations[node] = Quat(v[4 * i + 3], v[4 * i], v[4 * i + 1], v[4 * i + 2]);
    else
      translations[node] = Vec3(v[3 * i], v[3 * i + 1], v[3 * i + 2]);
  }
  std::vector<Matrix> out;
  for (size_t n = 0; n < model.nodes.size(); ++n) {
    const Matrix local = localMatrix(translations[n], rotations[n]);
    out.push_back(parents[n] < 0 ? local : Matrix(out[static_cast<size_t>(parents[n])] * local));
  }
  return out;
}

Vec3 placeOf(const Matrix& m) {
  return m.topRightCorner<3, 1>();
}

double largestDistance(const tinygltf::Model& model, const Clip& clip, int frame) {
  const std::vector<Matrix> world = worldMatrices(model, frame);
  double out = 0.0;
  for (int j = 0; j < clip.jointCount(); ++j)
    out =
        std::max<double>(out, (placeOf(world[static_cast<size_t>(j)]) - clip.at(frame, j)).norm());
  return out;
}

class Gltf : public testing::TestWithParam<const char*> {
 protected:
  test::TemporaryFolder m_folder;
  std::filesystem::path file() const { return m_folder / (std::string("a.") + GetParam()); }
};
INSTANTIATE_TEST_SUITE_P(Formats, Gltf, testing::Values("gltf", "glb"));

TEST_P(Gltf, NodesStandWhereTheJointsOfTheClipAre) {
  const Clip clip = person();
  const WrittenClip written = writeClip(clip, file());
  EXPECT_EQ(written.files, std::vector<std::filesystem::path>{file()});
  EXPECT_FALSE(written.fit);
  const tinygltf::Model model = readScene(file());
  for (int j = 0; j < clip.jointCount(); ++j)
    EXPECT_EQ(model.nodes.at(static_cast<size_t>(j)).name,
              clip.skeleton->names[static_cast<size_t>(j)]);
  for (const int frame : {0, 1, 17, 39}) EXPECT_LT(largestDistance(model, clip, frame), 1e-5);
}

TEST_P(Gltf, TimesAreThoseOfTheFrames) {
  writeClip(person(), file());
  const tinygltf::Model model = readScene(file());
  const int input = model.animations.at(0).samplers.at(0).input;
  const std::vector<float> times = valuesOf<float>(model, input);
  ASSERT_EQ(times.size(), 40u);
  for (size_t t = 0; t < times.size(); ++t) EXPECT_FLOAT_EQ(times[t], static_cast<float>(t) / 30);
  const auto& accessor = model.accessors.at(static_cast<size_t>(input));
  EXPECT_NEAR(accessor.minValues.at(0), 0.0, 1e-6);
  EXPECT_NEAR(accessor.maxValues.at(0), 39.0 / 30.0, 1e-6);
}

TEST_P(Gltf, InverseBindMatricesUndoTheRestPose) {
  writeClip(person(), file());
  const tinygltf::Model model = readScene(file());
  const auto& skin = model.skins.at(0);
  const std::vector<float> inverse = valuesOf<float>(model, skin.inverseBindMatrices);
  const std::vector<Matrix> rest = worldMatrices(model, -1);
  ASSERT_EQ(skin.joints.size(), 10u);
  ASSERT_EQ(inverse.size(), 160u);
  for (size_t j = 0; j < skin.joints.size(); ++j) {
    const Matrix bound = Eigen::Map<const Matrix>(&inverse[16 * j]);
    EXPECT_LT((bound * rest[static_cast<size_t>(skin.joints[j])] - Matrix::Identity()).norm(), 1e-6)
        << j;
  }
}

/// Every vertex is carried by one joint; the tip of each bone follows the child joint.
TEST_P(Gltf, TheBodyMovesWithItsBones) {
  const Clip clip = person();
  writeClip(clip, file());
  const tinygltf::Model model = readScene(file());
  const auto& primitive = model.meshes.at(0).primitives.at(0);
  const auto at = valuesOf<float>(model, primitive.attributes.at("POSITION"));
  const auto joints = valuesOf<uint16_t>(model, primitive.attributes.at("JOINTS_0"));
  const auto weights = valuesOf<float>(model, primitive.attributes.at("WEIGHTS_0"));
  const auto indices = valuesOf<uint32_t>(model, primitive.indices);
  const auto inverse = valuesOf<float>(model, model.skins.at(0).inverseBindMatrices);
  ASSERT_EQ(at.size() / 3, joints.size() / 4);
  for (const uint32_t index : indices) ASSERT_LT(index, at.size() / 3);
  const std::vector<Vec3> rest = restPositions(*clip.skeleton);
  const std::vector<Matrix> world = worldMatrices(model, 23);
  int tips = 0;
  for (size_t v = 0; v < at.size() / 3; ++v) {
    ASSERT_FLOAT_EQ(weights[4 * v] + weights[4 * v + 1] + weights[4 * v + 2] + weights[4 * v + 3],
                    1.0f);
    const size_t joint = joints[4 * v];
    const Vec3 vertex(at[3 * v], at[3 * v + 1], at[3 * v + 2]);
    for (const auto& [parent, child] : clip.skeleton->bones()) {
      if (static_cast<size_t>(parent) != joint ||
          (vertex - rest[static_cast<size_t>(child)]).norm() > 1e-6f)
        continue;
      const Matrix skinned = world[joint] * Eigen::Map<const Matrix>(&inverse[16 * joint]);
      const Vec3 moved = (skinned * vertex.homogeneous()).head<3>();
      EXPECT_LT((moved - clip.at(23, child)).norm(), 1e-5f);
      ++tips;
    }
  }
  EXPECT_EQ(tips, 4 * 9) << "four faces meet at the tip of each of nine bones";
}

TEST_P(Gltf, TrianglesFaceOutwards) {
  writeClip(person(), file());
  const tinygltf::Model model = readScene(file());
  const auto& primitive = model.meshes.at(0).primitives.at(0);
  const auto at = valuesOf<float>(model, primitive.attributes.at("POSITION"));
  const auto normals = valuesOf<float>(model, primitive.attributes.at("NORMAL"));
  const auto indices = valuesOf<uint32_t>(model, primitive.indices);
  // Volume by the divergence theorem: positive only where faces turn outwards.
  double volume = 0.0;
  for (size_t i = 0; i < indices.size(); i += 3) {
    Eigen::Matrix3f corners;
    for (int k = 0; k < 3; ++k)
      corners.col(k) = Eigen::Map<const Vec3>(&at[3 * indices[i + static_cast<size_t>(k)]]);
    volume += corners.determinant() / 6.0;
    const Vec3 face = (corners.col(1) - corners.col(0)).cross(corners.col(2) - corners.col(0));
    EXPECT_GT(face.normalized().dot(Eigen::Map<const Vec3>(&normals[3 * indices[i]])), 0.999f);
  }
  EXPECT_GT(volume, 1e-4);
}

TEST_P(Gltf, TheRecipeIsInTheAsset) {
  writeClip(person(), file(),
            {.recipe = {{"seed", uint64_t{1} << 63}, {"temperature", 0.5}, {"model", "a\xff"}}});
  const tinygltf::Model model = readScene(file());
  EXPECT_EQ(model.asset.version, "2.0");
  const tinygltf::Value recipe = model.asset.extras.Get("recipe");
  EXPECT_EQ(recipe.Get("seed").Get<std::string>(), "9223372036854775808");
  EXPECT_EQ(recipe.Get("temperature").GetNumberAsDouble(), 0.5);
  EXPECT_EQ(recipe.Get("model").Get<std::string>(), "a\xef\xbf\xbd");
  EXPECT_EQ(recipe.Get("export").Get("format").Get<std::string>(), GetParam());
  EXPECT_FALSE(recipe.Has("fit"));
}

/// Positions of which no skeleton with these bones is: the file differs from them by what it says.
TEST_P(Gltf, PositionsAloneAreFittedAndTheResidualIsTheStatedOne) {
  Clip clip = person();
  clip.transforms.reset();
  for (size_t i = 0; i < clip.positions.size(); ++i)
    clip.positions[i].x() += 0.02f * static_cast<float>(std::sin(1.7 * static_cast<double>(i)));
  const WrittenClip written = writeClip(clip, file());
  ASSERT_TRUE(written.fit);
  const tinygltf::Model model = readScene(file());
  std::vector<double> sums(static_cast<size_t>(clip.jointCount()));
  double largest = 0.0;
  for (int t = 0; t < clip.frameCount(); ++t) {
    const std::vector<Matrix> world = worldMatrices(model, t);
    for (int j = 0; j < clip.jointCount(); ++j) {
      const double distance = (placeOf(world[static_cast<size_t>(j)]) - clip.at(t, j)).norm();
      sums[static_cast<size_t>(j)] += distance * distance;
      largest = std::max(largest, distance);
    }
  }
  EXPECT_GT(largest, 0.005);
  const tinygltf::Value fit = model.asset.extras.Get("recipe").Get("fit");
  EXPECT_NEAR(fit.Get("fit_residual_max_cm").GetNumberAsDouble(), 100.0 * largest, 1e-3);
  EXPECT_NEAR(written.fit->largestM(), largest, 1e-5);
  for (int j = 0; j < clip.jointCount(); ++j) {
    const double rms = std::sqrt(sums[static_cast<size_t>(j)] / clip.frameCount());
    EXPECT_NEAR(fit.Get("fit_residual_cm")
                    .Get(clip.skeleton->names[static_cast<size_t>(j)])
                    .GetNumberAsDouble(),
                100.0 * rms, 1e-3);
    EXPECT_NEAR(written.fit->rmsM[static_cast<size_t>(j)], rms, 1e-5);
  }
}

TEST_P(Gltf, JointsThatMoveInTheirParentKeepMoving) {
  Clip clip = person();
  for (int t = 0; t < clip.frameCount(); ++t)
    clip.transforms->translations[static_cast<size_t>(t) * 10 + 7].y() +=
        0.01f * static_cast<float>(t);
  clip.positions = forwardKinematics(*clip.skeleton, *clip.transforms);
  writeClip(clip, file());
  const tinygltf::Model model = readScene(file());
  EXPECT_LT(largestDistance(model, clip, 30), 1e-5);
  EXPECT_EQ(model.animations.at(0).channels.size(), 10u + 2u);
}

TEST_P(Gltf, TheSameClipGivesTheSameBytes) {
  writeClip(person(), file());
  const std::string first = readFile(file());
  writeClip(person(), file());
  EXPECT_EQ(first, readFile(file()));
}

TEST_P(Gltf, OtherUnitsAndAxesAndMissingFoldersAreRefused) {
  EXPECT_THROW(writeClip(person(), file(), {.unit = "cm"}), UsageError);
  EXPECT_THROW(writeClip(person(), file(), {.up = "z"}), UsageError);
  writeFileAtomically(m_folder / "plain", "");
  EXPECT_THROW(writeClip(person(), m_folder / "plain" / file().filename().string()), FileError);
  EXPECT_FALSE(std::filesystem::exists(file()));
}

TEST(GltfFile, ABinaryFileStatesItsLength) {
  const test::TemporaryFolder folder;
  writeClip(person(), folder / "a.glb");
  const std::string bytes = readFile(folder / "a.glb");
  EXPECT_EQ(bytes.substr(0, 4), "glTF");
  uint32_t length = 0;
  std::memcpy(&length, bytes.data() + 8, 4);
  EXPECT_EQ(length, bytes.size());
}

TEST(GltfFile, TheFormatIsNotRead) {
  EXPECT_EQ(formatByName("glb").read, nullptr);
  EXPECT_EQ(formatByName("gltf").read, nullptr);
}

}  // namespace
}  // namespace marey::io
