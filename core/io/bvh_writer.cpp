#include <algorithm>
#include <iterator>
#include <numbers>

#include "base/atomic_file.h"
#include "base/json.h"
#include "io/bvh.h"
#include "io/export_record.h"
#include "io/normalise.h"
#include "motion/rotation.h"

namespace marey::io {
namespace {

/// A translation that stays within this of the offset needs no channels (a micrometre).
constexpr float kStillM = 1e-6f;
constexpr double kDegrees = 180.0 / std::numbers::pi;

class BvhText {
 public:
  BvhText(const Clip& clip, const EulerOrder& order, double metresPerUnit)
      : m_clip(clip),
        m_order(order),
        m_perMetre(1.0 / metresPerUnit),
        m_children(clip.skeleton->names.size()) {
    const Skeleton& s = *clip.skeleton;
    for (const auto& [parent, child] : s.bones())
      m_children[static_cast<size_t>(parent)].push_back(child);
    for (int j = 0; j < s.jointCount(); ++j) m_moves.push_back(j == 0 || translates(j));
  }

  std::string text() {
    m_out = "HIERARCHY\n";
    hierarchy();
    print("MOTION\nFrames: {}\nFrame Time: {:.12g}\n", m_clip.frameCount(), 1.0 / m_clip.fps);
    rows();
    return std::move(m_out);
  }

 private:
  template <typename... Args>
  void print(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(m_out), format, std::forward<Args>(args)...);
  }

  bool translates(int joint) const {
    const auto width = static_cast<size_t>(m_clip.jointCount());
    const Vec3& offset = m_clip.skeleton->offsets[static_cast<size_t>(joint)];
    const auto& translations = m_clip.transforms->translations;
    for (size_t i = static_cast<size_t>(joint); i < translations.size(); i += width)
      if ((translations[i] - offset).cwiseAbs().maxCoeff() > kStillM) return true;
    return false;
  }

  /// The tree in depth-first order (the order of the columns), without recursion.
  void hierarchy() {
    struct Open {
      int joint;
      size_t nextChild;
    };
    std::vector<Open> stack = {{0, 0}};
    openJoint(0, 0);
    while (!stack.empty()) {
      Open& top = stack.back();
      const auto& children = m_children[static_cast<size_t>(top.joint)];
      if (top.nextChild < children.size()) {
        const int child = children[top.nextChild++];
        openJoint(child, stack.size());
        stack.push_back({child, 0});
        continue;
      }
      closeJoint(top.joint, stack.size() - 1);
      stack.pop_back();
    }
  }

  void openJoint(int joint, size_t depth) {
    const auto j = static_cast<size_t>(joint);
    const std::string indent(2 * depth, ' ');
    print("{}{} {}\n{}{{\n", indent, joint == 0 ? "ROOT" : "JOINT", m_clip.skeleton->names[j],
          indent);
    // The root's place is wholly in its channels.
    printOffset(indent, joint == 0 ? Vec3(Vec3::Zero()) : m_clip.skeleton->offsets[j]);
    print("{}  CHANNELS {}", indent, m_moves[j] ? 6 : 3);
    if (m_moves[j]) print(" Xposition Yposition Zposition");
    for (const char axis : m_order.text()) print(" {}rotation", axis);
    print("\n");
    m_columns.push_back(joint);
  }

  void closeJoint(int joint, size_t depth) {
    const std::string indent(2 * depth, ' ');
    bool ended = !m_children[static_cast<size_t>(joint)].empty();
    for (const auto& site : m_clip.skeleton->endSites)
      if (site.parent == joint) {
        endSite(indent, site.offset);
        ended = true;
      }
    if (!ended) endSite(indent, Vec3::Zero());
    print("{}}}\n", indent);
  }

  void endSite(const std::string& indent, const Vec3& offset) {
    print("{}  End Site\n{}  {{\n", indent, indent);
    printOffset(indent + "  ", offset);
    print("{}  }}\n", indent);
  }

  void printOffset(const std::string& indent, const Vec3& metres) {
    const Vec3d v = metres.cast<double>() * m_perMetre;
    print("{}  OFFSET {:.6f} {:.6f} {:.6f}\n", indent, v.x(), v.y(), v.z());
  }

  void rows() {
    const auto width = static_cast<size_t>(m_clip.jointCount());
    std::vector<Vec3d> previous(width, Vec3d::Zero());
    for (int t = 0; t < m_clip.frameCount(); ++t) {
      const char* separator = "";
      for (const int joint : m_columns) {
        const auto j = static_cast<size_t>(joint);
        const size_t i = static_cast<size_t>(t) * width + j;
        if (m_moves[j]) {
          const Vec3d p = m_clip.transforms->translations[i].cast<double>() * m_perMetre;
          print("{}{:.6f} {:.6f} {:.6f} ", separator, p.x(), p.y(), p.z());
          separator = "";
        }
        previous[j] = angles(m_clip.transforms->rotations[i], t, previous[j]);
        const Vec3d degrees = previous[j] * kDegrees;
        print("{}{:.6f} {:.6f} {:.6f}", separator, degrees[0], degrees[1], degrees[2]);
        separator = " ";
      }
      print("\n");
    }
  }

  Vec3d angles(const Quat& rotation, int frame, const Vec3d& previous) const {
    const Quatd q = rotation.cast<double>().normalized();
    return frame == 0 ? eulerFromQuat(q, m_order) : eulerNear(q, m_order, previous);
  }

  const Clip& m_clip;
  EulerOrder m_order;
  double m_perMetre;
  std::vector<std::vector<int>> m_children;
  std::vector<char> m_moves;   ///< joints with position channels
  std::vector<int> m_columns;  ///< joints in the order of the file
  std::string m_out;
};

}  // namespace

std::vector<std::filesystem::path> writeBvh(const Clip& clip, const std::filesystem::path& path,
                                            const WriteOptions& options) {
  const LengthUnit& unit = unitByName(options.unit.empty() ? "cm" : options.unit);
  const EulerOrder order = parseEulerOrder(options.eulerOrder);
  if (!order.allDifferent())
    throw UsageError("Euler order: expected three different axes for BVH, found " + order.text());
  if (!clip.transforms)
    throw InputError({.path = path.string()}, "a clip with rotations (see fitSkeleton)",
                     "positions only");
  Clip out = clip;
  if (checkedUp(options.up) == "z") turnToZUp(out);
  writeFileAtomically(path, BvhText(out, order, unit.metres).text());
  const Json details = {
      {"format", "bvh"}, {"unit", unit.name}, {"up", options.up}, {"euler_order", order.text()}};
  writeJson(recipePath(path), exportRecord(clip, options, details));
  return {path, recipePath(path)};
}

}  // namespace marey::io
