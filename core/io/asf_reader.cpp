#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <set>

#include "io/asf_amc.h"
#include "io/plain_text.h"
#include "io/text.h"

namespace marey::io {
namespace {

constexpr double kInchM = 0.0254;

struct Bone {
  std::string name;
  Vec3d direction = Vec3d::Zero();
  double length = 0.0;
  Quatd axis = Quatd::Identity();
  std::vector<AsfChannel> channels;
};

/// Turns in the order listed, about fixed axes.
Quatd fixedAxes(const Vec3d& angles, std::string_view order) {
  Quatd out = Quatd::Identity();
  for (size_t i = 0; i < order.size(); ++i) {
    const auto axis = static_cast<int>(std::string_view("XYZ").find(order[i]));
    out = axisRotation(axis, angles[static_cast<int>(i)]) * out;
  }
  return out;
}

class AsfParser {
 public:
  AsfParser(std::string_view text, const std::string& origin) : m_lines(text, origin) {}

  AsfSkeleton parse() {
    while (nextLine()) section();
    return assemble();
  }

 private:
  /// The next line with content that is no comment.
  bool nextLine() {
    while (const auto line = m_lines.nextFilled()) {
      m_rest = trim(*line);
      if (!m_rest.starts_with('#')) return true;
    }
    return false;
  }

  /// The next line of a section; false (and the line is kept) at the next section.
  bool nextInSection() {
    if (!nextLine()) return false;
    if (!m_rest.starts_with(':')) return true;
    m_lines.unread();
    return false;
  }

  void section() {
    const std::string_view key = takeWord(m_rest);
    if (sameIgnoringCase(key, ":units")) return units();
    if (sameIgnoringCase(key, ":root")) return root();
    if (sameIgnoringCase(key, ":bonedata")) return boneData();
    if (sameIgnoringCase(key, ":hierarchy")) return hierarchy();
    if (!key.starts_with(':'))
      throw InputError(m_lines.place(), "a section such as :bonedata", excerpt(key));
    static constexpr std::string_view kSilent[] = {":version", ":name", ":documentation", ":skin"};
    if (std::none_of(std::begin(kSilent), std::end(kSilent),
                     [key](std::string_view known) { return sameIgnoringCase(key, known); }))
      m_out.notes.push_back(fmt::format("{}: section {} is not read", m_lines.place().text(), key));
    while (nextInSection()) {  // nothing to keep
    }
  }

  double number(const std::string& what) {
    double value = 0.0;
    if (takeNumber(m_rest, value) != NumberResult::Number)
      throw InputError(m_lines.place(what), "a finite number", excerpt(trim(m_rest)));
    return value;
  }

  Vec3d threeNumbers(const std::string& what) {
    Vec3d out;
    for (int i = 0; i < 3; ++i) out[i] = number(what);
    return out;
  }

  std::string axisOrder() {
    const std::string_view word = takeWord(m_rest);
    return parseEulerOrderHere(word);
  }

  std::string parseEulerOrderHere(std::string_view word) {
    try {
      return parseEulerOrder(word).text();
    } catch (const InputError&) {
      throw InputError(m_lines.place("axis"), "an order such as XYZ", excerpt(word));
    }
  }

  void units() {
    while (nextInSection()) {
      const std::string_view key = takeWord(m_rest);
      if (sameIgnoringCase(key, "length")) {
        const double length = number("length");
        if (!(length > 0.0)) throwInput(m_lines.place("length"), "a positive number", "{}", length);
        m_out.unit = {length == 0.45 ? "cmu" : fmt::format("inch/{:g}", length), kInchM / length};
      } else if (sameIgnoringCase(key, "angle")) {
        const std::string_view word = takeWord(m_rest);
        m_out.degrees = sameIgnoringCase(word, "deg");
        if (!m_out.degrees && !sameIgnoringCase(word, "rad"))
          throw InputError(m_lines.place("angle"), "deg or rad", excerpt(word));
      }
    }
  }

  void root() {
    m_root.name = "root";
    std::string order = "XYZ";
    Vec3d orientation = Vec3d::Zero();
    while (nextInSection()) {
      const std::string_view key = takeWord(m_rest);
      if (sameIgnoringCase(key, "order"))
        m_root.channels = channels();
      else if (sameIgnoringCase(key, "axis"))
        order = axisOrder();
      else if (sameIgnoringCase(key, "position"))
        m_rootPosition = threeNumbers("position");
      else if (sameIgnoringCase(key, "orientation"))
        orientation = threeNumbers("orientation");
      else
        throw InputError(m_lines.place(":root"), "order, axis, position or orientation",
                         excerpt(key));
    }
    m_root.axis = fixedAxes(orientation * angleUnit(), order);
    if (!orientation.isZero(0.0))
      m_out.notes.push_back(
          fmt::format("root orientation ({:g}, {:g}, {:g}) is read as the axes of "
                      "the root's turns, not as a turn of the whole body",
                      orientation[0], orientation[1], orientation[2]));
  }

  std::vector<AsfChannel> channels() {
    std::vector<AsfChannel> out;
    for (std::string_view word = takeWord(m_rest); !word.empty(); word = takeWord(m_rest)) {
      using Kind = AsfChannel::Kind;
      static constexpr std::string_view names[] = {"tx", "ty", "tz", "rx", "ry", "rz", "l"};
      static constexpr Kind kinds[] = {Kind::Shift, Kind::Turn, Kind::Length};
      int found = -1;
      for (int i = 0; i < 7; ++i)
        if (sameIgnoringCase(word, names[i])) found = i;
      if (found < 0)
        throw InputError(m_lines.place(), "degrees of freedom among tx ty tz rx ry rz l",
                         excerpt(word));
      out.push_back({kinds[found / 3], found % 3});
    }
    return out;
  }

  void boneData() {
    while (nextInSection()) {
      const std::string_view key = takeWord(m_rest);
      if (!sameIgnoringCase(key, "begin"))
        throw InputError(m_lines.place(":bonedata"), "begin", excerpt(key));
      readBone();
    }
  }

  void readBone() {
    Bone bone;
    while (true) {
      if (!nextInSection())
        throw InputError(m_lines.place(":bonedata"), "end", "the end of the section");
      const std::string_view key = takeWord(m_rest);
      if (sameIgnoringCase(key, "end")) break;
      if (sameIgnoringCase(key, "name")) bone.name = std::string(trim(m_rest));
      if (sameIgnoringCase(key, "direction")) bone.direction = threeNumbers("direction");
      if (sameIgnoringCase(key, "length")) bone.length = number("length");
      if (sameIgnoringCase(key, "dof")) bone.channels = channels();
      if (sameIgnoringCase(key, "axis")) {
        const Vec3d angles = threeNumbers("axis") * angleUnit();
        bone.axis = fixedAxes(angles, axisOrder());
      }
    }
    const bool named = !bone.name.empty() && bone.name != "root";
    if (!named || !m_bones.emplace(bone.name, bone).second)
      throw InputError(m_lines.place(), "a name that no other bone has", excerpt(bone.name));
  }

  double angleUnit() const { return m_out.degrees ? std::numbers::pi / 180.0 : 1.0; }

  void hierarchy() {
    m_attached.insert(m_root.name);
    while (nextInSection()) {
      const std::string parent(takeWord(m_rest));
      if (sameIgnoringCase(parent, "begin") || sameIgnoringCase(parent, "end")) continue;
      if (!m_attached.contains(parent))
        throw InputError(m_lines.place(":hierarchy"), "a parent that an earlier line names",
                         excerpt(parent));
      for (std::string_view word = takeWord(m_rest); !word.empty(); word = takeWord(m_rest)) {
        const std::string child(word);
        if (!m_bones.contains(child) || !m_attached.insert(child).second)
          throw InputError(m_lines.place(":hierarchy"), "a bone of :bonedata, once",
                           excerpt(child));
        m_children[parent].push_back(child);
      }
    }
  }

  /// From where a bone begins to where it ends, at rest.
  static Vec3d vectorOf(const Bone& bone) {
    const double norm = bone.direction.norm();
    return norm > 0.0 ? Vec3d(bone.direction / norm * bone.length) : Vec3d(Vec3d::Zero());
  }

  void addJoint(const Bone& bone, int parent, const Vec3d& offset) {
    m_out.skeleton.names.push_back(bone.name);
    m_out.skeleton.parents.push_back(parent);
    m_out.skeleton.offsets.push_back(offset.cast<float>());
    m_out.channels.push_back(bone.channels);
    m_out.axes.push_back(bone.axis);
  }

  /// Joints in depth-first order, as other hierarchical formats list them.
  void addJoints() {
    std::vector<std::pair<std::string, int>> stack = {{m_root.name, -1}};
    while (!stack.empty()) {
      const auto [name, parent] = stack.back();
      stack.pop_back();
      const int joint = m_out.skeleton.jointCount();
      if (parent < 0) {
        addJoint(m_root, parent, m_rootPosition);
      } else {
        const std::string& above = m_out.skeleton.names[static_cast<size_t>(parent)];
        addJoint(m_bones.at(name), parent,
                 parent == 0 ? Vec3d(Vec3d::Zero()) : vectorOf(m_bones.at(above)));
      }
      const std::vector<std::string>& children = m_children[name];
      if (children.empty() && parent >= 0)
        m_out.skeleton.endSites.push_back({joint, vectorOf(m_bones.at(name)).cast<float>()});
      for (auto child = children.rbegin(); child != children.rend(); ++child)
        stack.emplace_back(*child, joint);
    }
  }

  AsfSkeleton assemble() {
    if (m_attached.empty() || m_root.channels.empty())
      throw InputError(m_lines.place(), "sections :root (with an order) and :hierarchy",
                       "an end without them");
    addJoints();
    if (m_out.unit.name.empty()) m_out.unit = {"inch", kInchM};
    return std::move(m_out);
  }

  LineReader m_lines;
  std::string_view m_rest;
  AsfSkeleton m_out;
  Bone m_root;
  Vec3d m_rootPosition = Vec3d::Zero();
  std::map<std::string, Bone> m_bones;
  std::map<std::string, std::vector<std::string>> m_children;
  std::set<std::string> m_attached;  ///< names that the hierarchy has reached
};

}  // namespace

AsfSkeleton parseAsf(std::string_view bytes, const std::string& origin) {
  const PlainText plain(bytes);
  AsfSkeleton out = AsfParser(plain.text(), origin).parse();
  for (const std::string& note : plain.notes()) out.notes.push_back(origin + ": " + note);
  return out;
}

}  // namespace marey::io
