#include <algorithm>
#include <iterator>
#include <map>
#include <numbers>

#include "base/atomic_file.h"
#include "io/asf_amc.h"
#include "io/euler_order.h"
#include "io/normalise.h"
#include "io/plain_text.h"
#include "io/text.h"

namespace marey::io {
namespace {

constexpr double kCmuFps = 120.0;

class AmcParser {
 public:
  AmcParser(std::string_view text, const std::string& origin, const AsfSkeleton& asf,
            const std::vector<std::vector<size_t>>& turns)
      : m_lines(text, origin), m_asf(asf), m_turns(turns), m_degrees(asf.degrees) {
    for (int j = 0; j < asf.skeleton.jointCount(); ++j) {
      m_joints.emplace(asf.skeleton.names[static_cast<size_t>(j)], j);
      if (!asf.channels[static_cast<size_t>(j)].empty()) ++m_moving;
    }
    m_given.assign(asf.skeleton.names.size(), 0);
  }

  JointTransforms parse() {
    while (const auto line = m_lines.nextFilled()) {
      std::string_view rest = trim(*line);
      if (isComment(rest)) continue;
      if (rest.starts_with(':'))
        setting(rest);
      else if (const auto number = parseNumber(rest))
        startFrame(*number);
      else
        readBone(rest);
    }
    finishFrame();
    if (m_frame == 0) throw InputError(m_lines.place(), "at least one frame", "zero frames");
    return std::move(m_out);
  }

  /// As the file states it.
  std::optional<double> fps() const { return m_fps; }
  const std::vector<std::string>& notes() const { return m_notes; }

 private:
  void setting(std::string_view rest) {
    const std::string_view key = takeWord(rest);
    if (sameIgnoringCase(key, ":fully-specified")) return;
    if (sameIgnoringCase(key, ":degrees"))
      m_degrees = true;
    else if (sameIgnoringCase(key, ":radians"))
      m_degrees = false;
    else if (isRateKey(key))
      m_fps = rateOf(rest);
    else
      m_notes.push_back(fmt::format("line {}: {} is not read", m_lines.line(),
                                    excerpt(std::string(key) + std::string(rest))));
  }

  static bool isRateKey(std::string_view key) {
    if (key.ends_with(':')) key.remove_suffix(1);
    static constexpr std::string_view keys[] = {":samples-per-second", ":frames-per-second",
                                                ":frame-rate", ":framerate", ":fps"};
    return std::any_of(std::begin(keys), std::end(keys),
                       [key](std::string_view known) { return sameIgnoringCase(key, known); });
  }

  double rateOf(std::string_view text) const {
    const std::optional<double> rate = parseNumber(trim(text));
    if (!rate || !(*rate > 0.0))
      throw InputError(m_lines.place(), "a positive number of samples per second",
                       excerpt(trim(text)));
    return *rate;
  }

  void startFrame(double number) {
    finishFrame();
    if (m_frame > 0 && number != m_number + 1.0)
      throwInput(m_lines.place(), fmt::format("frame {:g}", m_number + 1.0), "frame {:g}", number);
    m_number = number;
    ++m_frame;
    m_count = 0;
    std::fill(m_given.begin(), m_given.end(), 0);
    const Skeleton& s = m_asf.skeleton;
    m_out.rotations.resize(m_out.rotations.size() + s.names.size(), Quat::Identity());
    m_out.translations.insert(m_out.translations.end(), s.offsets.begin(), s.offsets.end());
  }

  /// Every joint with degrees of freedom was given.
  void finishFrame() const {
    if (m_frame == 0 || m_count == m_moving) return;
    for (size_t j = 0; j < m_given.size(); ++j)
      if (m_given[j] == 0 && !m_asf.channels[j].empty())
        throw InputError({.path = m_lines.origin(), .line = m_lines.line(), .frame = m_frame},
                         "values of bone '" + m_asf.skeleton.names[j] + "'", "none");
  }

  void readBone(std::string_view rest) {
    const std::string_view name = takeWord(rest);
    if (m_frame == 0)
      throw InputError(m_lines.place(), "a frame number before the first bone", excerpt(name));
    const auto joint = m_joints.find(name);
    if (joint == m_joints.end())
      throw InputError(m_lines.place(), "a bone of the ASF skeleton", excerpt(name));
    const auto j = static_cast<size_t>(joint->second);
    if (m_given[j]++ != 0)
      throw InputError(m_lines.place(), "every bone once per frame", excerpt(name) + " again");
    if (!m_asf.channels[j].empty()) ++m_count;
    pose(j, rest);
  }

  void pose(size_t j, std::string_view rest) {
    const double unit = m_degrees ? std::numbers::pi / 180.0 : 1.0;
    Quatd motion = Quatd::Identity();
    Vec3d shift = Vec3d::Zero();
    const std::vector<AsfChannel>& channels = m_asf.channels[j];
    m_values.clear();
    for (const AsfChannel& channel : channels) {
      m_values.push_back(take(j, rest));
      if (channel.kind == AsfChannel::Kind::Shift) shift[channel.axis] += m_values.back();
      if (channel.kind == AsfChannel::Kind::Length && m_values.back() != 0.0)
        throwInput(place(j), "0 for the degree of freedom 'l' (the bone's length)", "{}",
                   m_values.back());
    }
    for (const size_t turn : m_turns[j]) {
      const size_t c = channels.size() - 1 - turn;
      motion = motion * axisRotation(channels[c].axis, m_values[c] * unit);
    }
    if (!trim(rest).empty())
      throw InputError(place(j), fmt::format("{} numbers", m_asf.channels[j].size()),
                       "more: " + excerpt(trim(rest)));
    const size_t at = m_out.rotations.size() - m_given.size() + j;
    const Quatd& axis = m_asf.axes[j];
    m_out.rotations[at] = (axis * motion * axis.conjugate()).cast<float>().normalized();
    m_out.translations[at] += shift.cast<float>();
  }

  double take(size_t j, std::string_view& rest) const {
    double value = 0.0;
    const NumberResult result = takeNumber(rest, value);
    if (result == NumberResult::Number) return value;
    throw InputError(place(j), fmt::format("{} finite numbers", m_asf.channels[j].size()),
                     result == NumberResult::End ? "fewer" : excerpt(takeWord(rest)));
  }

  Place place(size_t j) const {
    return {.path = m_lines.origin(),
            .line = m_lines.line(),
            .frame = m_frame,
            .item = "bone '" + m_asf.skeleton.names[j] + "'"};
  }

  LineReader m_lines;
  const AsfSkeleton& m_asf;
  const std::vector<std::vector<size_t>>& m_turns;  ///< see intrinsicAxes
  std::vector<double> m_values;                     ///< of one bone's line
  bool m_degrees = true;
  std::map<std::string, int, std::less<>> m_joints;
  size_t m_moving = 0;        ///< joints with degrees of freedom
  std::vector<char> m_given;  ///< per joint, in this frame
  size_t m_count = 0;
  double m_number = 0.0;
  int64_t m_frame = 0;
  std::optional<double> m_fps;
  std::vector<std::string> m_notes;
  JointTransforms m_out;
};

/// Axes of the channels for turnsInOrder: the list backwards, since its turns are about fixed axes.
std::vector<int> intrinsicAxes(const std::vector<AsfChannel>& channels) {
  std::vector<int> out;
  for (auto it = channels.rbegin(); it != channels.rend(); ++it)
    out.push_back(it->kind == AsfChannel::Kind::Turn ? it->axis : -1);
  return out;
}

size_t commonPrefix(const std::string& a, const std::string& b) {
  const auto [end, ignored] = std::mismatch(a.begin(), a.end(), b.begin(), b.end());
  return static_cast<size_t>(end - a.begin());
}

}  // namespace

int canReadAmc(std::string_view head) {
  const PlainText plain(head);
  LineReader lines(plain.text(), {});
  while (const auto line = lines.nextFilled()) {
    const std::string_view text = trim(*line);
    for (const std::string_view key : {":FULLY-SPECIFIED", ":DEGREES", ":RADIANS"})
      if (sameIgnoringCase(text, key)) return 95;
    if (!text.starts_with(':') && !isComment(text)) return 0;
  }
  return 0;
}

Clip parseAmc(std::string_view bytes, const std::string& origin, const AsfSkeleton& asf,
              const ReadOptions& options) {
  Clip clip;
  clip.name = std::filesystem::path(origin).stem().string();
  std::vector<std::vector<size_t>> turns;
  for (const auto& channels : asf.channels) {
    const std::vector<int> axes = intrinsicAxes(channels);
    turns.push_back(turnsInOrder(axes, options.eulerOrder));
    clip.source.eulerOrders.push_back(orderText(axes, turns.back()));
  }
  const PlainText plain(bytes);
  AmcParser parser(plain.text(), origin, asf, turns);
  clip.transforms = parser.parse();
  clip.skeleton = std::make_shared<const Skeleton>(asf.skeleton);
  clip.fps = parser.fps().value_or(kCmuFps);
  clip.source.path = origin;
  clip.source.format = "amc";
  clip.source.fps = clip.fps;
  for (const auto* notes : {&asf.notes, &plain.notes(), &parser.notes()})
    clip.source.notes.insert(clip.source.notes.end(), notes->begin(), notes->end());
  if (!options.fps && !parser.fps())
    clip.source.notes.push_back(
        "AMC states no frame rate: 120 is assumed, as in the CMU data base");
  if (!options.eulerOrder.empty())
    clip.source.notes.push_back("Euler order " + options.eulerOrder + " as given");
  return normalised(std::move(clip), {.unit = asf.unit, .up = "y", .unitFromFile = true}, options);
}

std::filesystem::path asfBeside(const std::filesystem::path& amc) {
  const std::string stem = amc.stem().string();
  std::filesystem::path folder = amc.parent_path();
  if (folder.empty()) folder = ".";
  std::vector<std::filesystem::path> all;
  std::error_code ec;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ec))
    if (sameIgnoringCase(entry.path().extension().string(), ".asf")) all.push_back(entry.path());
  std::sort(all.begin(), all.end());
  const auto best = std::max_element(all.begin(), all.end(), [&](const auto& a, const auto& b) {
    const std::string x = a.stem().string(), y = b.stem().string();
    const size_t inX = commonPrefix(x, stem), inY = commonPrefix(y, stem);
    return inX != inY ? inX < inY : x.size() > y.size();
  });
  const bool related = best != all.end() && commonPrefix(best->stem().string(), stem) > 0;
  if (!related && all.size() != 1)
    throw InputError({.path = amc.string()}, "its ASF skeleton beside it (or a given one)",
                     all.empty() ? "no ASF file" : "none with a similar name");
  return *best;
}

std::vector<Clip> readAmc(std::string_view bytes, const std::filesystem::path& path,
                          const ReadOptions& options) {
  const std::filesystem::path asfPath = options.asf.empty() ? asfBeside(path) : options.asf;
  const AsfSkeleton asf = parseAsf(readFile(asfPath), asfPath.string());
  Clip clip = parseAmc(bytes, path.string(), asf, options);
  clip.source.notes.insert(clip.source.notes.begin(),
                           "skeleton from " + asfPath.filename().string());
  return {std::move(clip)};
}

}  // namespace marey::io
