#include "io/gltf_writer.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <ostream>

#include <tiny_gltf.h>

#include "base/atomic_file.h"
#include "io/bone_mesh.h"
#include "io/export_record.h"
#include "io/utf8_names.h"
#include "motion/kinematics.h"

namespace marey::io {
namespace {

/// A translation that stays within this of the offset needs no channel (a micrometre).
constexpr float kStillM = 1e-6f;
/// The length fields of the binary form have 32 bits; text grows by a third.
constexpr size_t kMostBytes = size_t{3} << 30;

/// Numbers as the library keeps them; whole ones beyond its int become doubles, or text where a
/// double would round them.
tinygltf::Value numberValue(const Json& json) {
  if (json.is_number_float()) return tinygltf::Value(json.get<double>());
  const bool fits = json.is_number_unsigned() ? std::in_range<int>(json.get<uint64_t>())
                                              : std::in_range<int>(json.get<int64_t>());
  if (fits) return tinygltf::Value(json.get<int>());
  constexpr double kExact = 9007199254740992.0;  // 2^53
  const auto number = json.get<double>();
  return std::abs(number) < kExact ? tinygltf::Value(number) : tinygltf::Value(json.dump());
}

tinygltf::Value valueOf(const Json& json) {
  if (json.is_object()) {
    tinygltf::Value::Object out;
    for (const auto& [key, value] : json.items()) out[key] = valueOf(value);
    return tinygltf::Value(out);
  }
  if (json.is_array()) {
    tinygltf::Value::Array out;
    for (const Json& value : json) out.push_back(valueOf(value));
    return tinygltf::Value(out);
  }
  if (json.is_string()) return tinygltf::Value(json.get<std::string>());
  if (json.is_boolean()) return tinygltf::Value(json.get<bool>());
  return json.is_number() ? numberValue(json) : tinygltf::Value();
}

/// Without bytes that are no UTF-8, which JSON cannot hold.
Json cleaned(const Json& json) {
  return Json::parse(jsonText(json));
}

class GltfScene {
 public:
  GltfScene(const Clip& clip, const Json& record)
      : m_clip(clip), m_joints(static_cast<size_t>(clip.jointCount())) {
    m_model.asset.version = "2.0";
    m_model.asset.generator = "Marey";
    m_model.asset.extras = valueOf({{"recipe", cleaned(record)}});
    m_model.buffers.emplace_back();
    addNodes();
    addBody();
    addSkin();
    addAnimation();
  }

  const tinygltf::Model& model() const { return m_model; }

 private:
  template <typename T>
  int addView(const std::vector<T>& values, int target) {
    auto& bytes = m_model.buffers[0].data;
    bytes.resize((bytes.size() + 3) / 4 * 4);  // accessors begin at multiples of their component
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = bytes.size();
    view.byteLength = values.size() * sizeof(T);
    view.target = target;
    bytes.resize(bytes.size() + view.byteLength);
    std::memcpy(bytes.data() + view.byteOffset, values.data(), view.byteLength);
    m_model.bufferViews.push_back(view);
    return static_cast<int>(m_model.bufferViews.size()) - 1;
  }

  /// `values`: count x width, packed. `target` 0: neither vertices nor indices.
  template <typename T>
  int addAccessor(const std::vector<T>& values, int width, int componentType, int type,
                  int target = 0) {
    tinygltf::Accessor accessor;
    accessor.bufferView = addView(values, target);
    accessor.componentType = componentType;
    accessor.type = type;
    accessor.count = values.size() / static_cast<size_t>(width);
    m_model.accessors.push_back(accessor);
    return static_cast<int>(m_model.accessors.size()) - 1;
  }

  int addVectors(const std::vector<Vec3>& values, int target = 0) {
    std::vector<float> flat;
    flat.reserve(values.size() * 3);
    for (const Vec3& v : values) flat.insert(flat.end(), {v.x(), v.y(), v.z()});
    return addAccessor(flat, 3, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3, target);
  }

  void addNodes() {
    const Skeleton& s = *m_clip.skeleton;
    const std::vector<std::string> names = utf8Names(s.names);
    for (size_t j = 0; j < m_joints; ++j) {
      tinygltf::Node node;
      node.name = names[j];
      const Vec3& at = s.offsets[j];
      node.translation = {at.x(), at.y(), at.z()};
      m_model.nodes.push_back(node);
      if (j > 0)
        m_model.nodes[static_cast<size_t>(s.parents[j])].children.push_back(static_cast<int>(j));
    }
    tinygltf::Node body;
    body.name = "body";
    body.mesh = 0;
    body.skin = 0;
    m_model.nodes.push_back(body);
    tinygltf::Scene scene;
    scene.name = cleaned(m_clip.name).get<std::string>();
    scene.nodes = {0, static_cast<int>(m_joints)};
    m_model.scenes.push_back(scene);
    m_model.defaultScene = 0;
  }

  void addBody() {
    const BoneMesh mesh = boneMesh(*m_clip.skeleton);
    std::vector<uint16_t> joints;
    std::vector<float> weights;
    for (const uint16_t joint : mesh.joints) {
      joints.insert(joints.end(), {joint, 0, 0, 0});
      weights.insert(weights.end(), {1.0f, 0.0f, 0.0f, 0.0f});
    }
    constexpr int vertices = TINYGLTF_TARGET_ARRAY_BUFFER;
    tinygltf::Primitive primitive;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    primitive.material = 0;
    primitive.attributes["POSITION"] = addVectors(mesh.positions, vertices);
    setBounds(primitive.attributes["POSITION"], mesh.positions);
    primitive.attributes["NORMAL"] = addVectors(mesh.normals, vertices);
    primitive.attributes["JOINTS_0"] = addAccessor(
        joints, 4, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, TINYGLTF_TYPE_VEC4, vertices);
    primitive.attributes["WEIGHTS_0"] =
        addAccessor(weights, 4, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC4, vertices);
    primitive.indices = addAccessor(mesh.indices, 1, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT,
                                    TINYGLTF_TYPE_SCALAR, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
    tinygltf::Mesh body;
    body.name = "body";
    body.primitives.push_back(primitive);
    m_model.meshes.push_back(body);
    tinygltf::Material grey;
    grey.name = "grey";
    grey.pbrMetallicRoughness.baseColorFactor = {0.35, 0.38, 0.42, 1.0};
    grey.pbrMetallicRoughness.metallicFactor = 0.0;
    grey.pbrMetallicRoughness.roughnessFactor = 0.8;
    m_model.materials.push_back(grey);
  }

  /// The format demands them of vertex positions.
  void setBounds(int accessor, const std::vector<Vec3>& values) {
    Vec3 least = values.front(), most = values.front();
    for (const Vec3& v : values) {
      least = least.cwiseMin(v);
      most = most.cwiseMax(v);
    }
    auto& a = m_model.accessors[static_cast<size_t>(accessor)];
    a.minValues = {least.x(), least.y(), least.z()};
    a.maxValues = {most.x(), most.y(), most.z()};
  }

  void addSkin() {
    std::vector<float> matrices;
    for (const Vec3& rest : restPositions(*m_clip.skeleton)) {
      Eigen::Matrix4f inverse = Eigen::Matrix4f::Identity();  // column-major, as the format is
      inverse.topRightCorner<3, 1>() = -rest;
      matrices.insert(matrices.end(), inverse.data(), inverse.data() + inverse.size());
    }
    tinygltf::Skin skin;
    skin.name = "skeleton";
    skin.skeleton = 0;
    for (size_t j = 0; j < m_joints; ++j) skin.joints.push_back(static_cast<int>(j));
    skin.inverseBindMatrices =
        addAccessor(matrices, 16, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_MAT4);
    m_model.skins.push_back(skin);
  }

  void addAnimation() {
    std::vector<float> times;
    for (int t = 0; t < m_clip.frameCount(); ++t)
      times.push_back(static_cast<float>(t / m_clip.fps));
    m_times = addAccessor(times, 1, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_SCALAR);
    auto& accessor = m_model.accessors[static_cast<size_t>(m_times)];
    accessor.minValues = {times.front()};
    accessor.maxValues = {times.back()};
    m_animation.name = cleaned(m_clip.name).get<std::string>();
    m_animation.extras = valueOf({{"fps", m_clip.fps}});
    for (size_t j = 0; j < m_joints; ++j) {
      addChannel(j, "rotation", addRotations(j));
      if (j == 0 || translates(j)) addChannel(j, "translation", addVectors(translations(j)));
    }
    m_model.animations.push_back(m_animation);
  }

  void addChannel(size_t joint, const char* what, int output) {
    tinygltf::AnimationSampler sampler;
    sampler.input = m_times;
    sampler.output = output;
    sampler.interpolation = "LINEAR";
    m_animation.samplers.push_back(sampler);
    tinygltf::AnimationChannel channel;
    channel.sampler = static_cast<int>(m_animation.samplers.size()) - 1;
    channel.target_node = static_cast<int>(joint);
    channel.target_path = what;
    m_animation.channels.push_back(channel);
  }

  int addRotations(size_t joint) {
    std::vector<float> flat;
    Quat before = Quat::Identity();
    for (size_t i = joint; i < m_clip.transforms->rotations.size(); i += m_joints) {
      Quat q = m_clip.transforms->rotations[i].normalized();
      // q and -q are one rotation; viewers that do not look turn the long way round.
      if (q.dot(before) < 0.0f) q.coeffs() *= -1.0f;
      flat.insert(flat.end(), {q.x(), q.y(), q.z(), q.w()});
      before = q;
    }
    return addAccessor(flat, 4, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC4);
  }

  std::vector<Vec3> translations(size_t joint) const {
    std::vector<Vec3> out;
    for (size_t i = joint; i < m_clip.transforms->translations.size(); i += m_joints)
      out.push_back(m_clip.transforms->translations[i]);
    return out;
  }

  bool translates(size_t joint) const {
    const std::vector<Vec3> all = translations(joint);
    const Vec3& offset = m_clip.skeleton->offsets[joint];
    return std::any_of(all.begin(), all.end(), [&offset](const Vec3& v) {
      return (v - offset).cwiseAbs().maxCoeff() > kStillM;
    });
  }

  const Clip& m_clip;
  size_t m_joints;
  int m_times = 0;
  tinygltf::Animation m_animation;
  tinygltf::Model m_model;
};

void checkClip(const Clip& clip, const std::string& format, const std::filesystem::path& path,
               const WriteOptions& options) {
  if ((!options.unit.empty() && options.unit != "m") || options.up != "y")
    throw UsageError(fmt::format(
        "{}: expected metres and Y up, which this format always has, found unit '{}' and up '{}'",
        format, options.unit, options.up));
  if (!clip.transforms)
    throw InputError({.path = path.string()}, "a clip with rotations (see fitSkeleton)",
                     "positions only");
  if (clip.jointCount() > std::numeric_limits<uint16_t>::max())
    throwInput({.path = path.string()}, "at most 65535 joints", "{}", clip.jointCount());
  const size_t bytes = clip.positions.size() * (sizeof(Vec3) + sizeof(Quat));
  if (bytes > kMostBytes)
    throwInput({.path = path.string()}, fmt::format("at most {} bytes of motion", kMostBytes), "{}",
               bytes);
}

std::vector<std::filesystem::path> write(const Clip& clip, const std::string& format,
                                         const std::filesystem::path& path,
                                         const WriteOptions& options) {
  checkClip(clip, format, path, options);
  const Json details = {{"format", format}, {"unit", "m"}, {"up", "y"}};
  const GltfScene scene(clip, exportRecord(clip, options, details));
  writeFileAtomically(path, [&](std::ostream& out) {
    tinygltf::TinyGLTF writer;
    const bool binary = format == "glb";
    if (!writer.WriteGltfSceneToStream(&scene.model(), out, !binary, binary))
      throw FileError(path.string() + ": cannot write: the glTF library refused the scene");
  });
  return {path};
}

}  // namespace

std::vector<std::filesystem::path> writeGltf(const Clip& clip, const std::filesystem::path& path,
                                             const WriteOptions& options) {
  return write(clip, "gltf", path, options);
}

std::vector<std::filesystem::path> writeGlb(const Clip& clip, const std::filesystem::path& path,
                                            const WriteOptions& options) {
  return write(clip, "glb", path, options);
}

}  // namespace marey::io
