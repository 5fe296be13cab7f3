#include "io/doctor.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "io/clip_io.h"
#include "io/doctor_checks.h"
#include "io/units.h"

namespace marey::io {
namespace {

/// A bone that changes by more is no rigid bone: 5 mm is above what rounding in files does.
constexpr double kDriftM = 0.005;
constexpr double kSkateShare = 0.2;
/// The window of the papers' models; shorter clips are padded and masked there.
constexpr double kWindowS = 4.0;
constexpr double kShortS = 1.0;
constexpr double kLowFps = 10.0;

/// The first of the reader's notes that begins so, or empty.
std::string noteBeginning(const Clip& clip, const std::string& prefix) {
  for (const std::string& note : clip.source.notes)
    if (note.starts_with(prefix)) return note;
  return {};
}

Finding unitFinding(const Clip& clip) {
  const std::string note = noteBeginning(clip, "unit ");
  return {clip.source.unit, note.empty() ? "the format fixes it" : note};
}

Finding upFinding(const Clip& clip, const UpGuess& guess) {
  const std::string note = noteBeginning(clip, "up axis ");
  if (!note.empty()) return {clip.source.up, note};
  const bool guessed = clip.source.format == "bvh" || clip.source.format == "npy";
  return {clip.source.up, guessed ? guess.evidence : "the format fixes it"};
}

/// Strides are judged in metres, so the unit has to be sure.
void addRateDoubt(const Clip& clip, const SkeletonRoles& roles, std::vector<Fault>& out) {
  if (std::any_of(out.begin(), out.end(),
                  [](const Fault& f) { return f.kind == "unit_uncertain"; }))
    return;
  if (auto fault = doubtfulRate(clip, roles)) out.push_back(*std::move(fault));
}

void addBodyFaults(const DoctorReport& report, const UpGuess& up, std::vector<Fault>& out) {
  const bool told =
      std::any_of(out.begin(), out.end(), [](const Fault& f) { return f.kind == "up_uncertain"; });
  if (!told && up.evidence.starts_with("from feet") && !(up.up == "y" && up.certain))
    out.push_back({"up_uncertain", Severity::Warning,
                   "after conversion " + up.evidence + ", expected about (0, 1, 0)", std::nullopt});
  if (report.sides.value == "swapped")
    out.push_back({"swapped_sides", Severity::Warning, report.sides.evidence, std::nullopt});
  if (report.boneDrift.maxStdM > kDriftM)
    out.push_back({"bone_drift", Severity::Warning,
                   fmt::format("bone {} changes its length with a standard deviation of {:.1f} cm",
                               report.boneDrift.bone, 100.0 * report.boneDrift.maxStdM),
                   std::nullopt});
  if (report.footSkateShare.value_or(0.0) > kSkateShare)
    out.push_back({"foot_skate", Severity::Warning,
                   fmt::format("feet slide in {:.0f} % of the frames near the floor",
                               100.0 * *report.footSkateShare),
                   std::nullopt});
  if (report.fps < kLowFps)
    out.push_back(
        {"low_rate", Severity::Note,
         fmt::format("{:g} frames per second: key frames rather than a recording", report.fps),
         std::nullopt});
  if (report.seconds < kWindowS)
    out.push_back({"short_clip", report.seconds < kShortS ? Severity::Warning : Severity::Note,
                   fmt::format("{:.2f} s, shorter than a training window of {:g} s", report.seconds,
                               kWindowS),
                   std::nullopt});
}

DoctorReport unreadable(const std::filesystem::path& path, const std::string& message) {
  DoctorReport out;
  out.path = path.string();
  out.clip = path.stem().string();
  out.format = "unknown";
  try {
    if (const ClipFormat* format = formatOfContent(readHead(path))) out.format = format->name;
  } catch (const FileError&) {  // the message says it
  }
  out.up = {"unknown", "not read"};
  out.unit = {"unknown", "not read"};
  out.sides = {"unknown", "not read"};
  out.skeleton = "unknown";
  out.faults.push_back({"unreadable", Severity::Error, message, std::nullopt});
  return out;
}

/// A note that stands nowhere else in the report.
bool isOnlyNote(const DoctorReport& r, const std::string& note) {
  return note != r.unit.evidence && note != r.up.evidence &&
         std::none_of(r.faults.begin(), r.faults.end(),
                      [&note](const Fault& f) { return f.evidence == note; });
}

Json optionalNumber(const std::optional<double>& value) {
  return value ? Json(*value) : Json();
}

}  // namespace

const char* name(Severity severity) {
  switch (severity) {
    case Severity::Note:
      return "note";
    case Severity::Warning:
      return "warning";
    case Severity::Error:
      break;
  }
  return "error";
}

DoctorReport examineClip(const Clip& clip) {
  const SkeletonRoles roles = rolesOf(*clip.skeleton);
  const UpGuess up = guessUp(clip);
  DoctorReport out;
  out.path = clip.source.path;
  out.clip = clip.name;
  out.format = clip.source.format;
  out.fps = clip.fps;
  out.frames = clip.frameCount();
  out.joints = clip.jointCount();
  out.seconds = clip.seconds();
  out.up = upFinding(clip, up);
  out.unit = unitFinding(clip);
  out.metresPerUnit = clip.source.metresPerUnit;
  out.skeleton = skeletonKind(*clip.skeleton, roles);
  for (const std::string& order : clip.source.eulerOrders)
    if (!order.empty()) ++out.eulerOrders[order];
  out.sides = sidesByGeometry(clip, roles);
  out.floorM = floorHeight(clip, roles);
  out.boneDrift = boneDrift(clip);
  out.footSkateShare = footSkateShare(clip, roles);
  out.notes = clip.source.notes;
  addReaderFaults(clip, out.faults);
  if (auto fault = calibrationPose(clip)) out.faults.push_back(*std::move(fault));
  addRateDoubt(clip, roles, out.faults);
  checkTeleports(clip, out.faults);
  checkSpikes(clip, out.faults);
  checkRepeats(clip, out.faults);
  if (out.floorM) checkFloor(clip, *out.floorM, out.faults);
  addBodyFaults(out, up, out.faults);
  return out;
}

std::vector<Fault> doubtsOf(const Clip& clip) {
  std::vector<Fault> out;
  addReaderFaults(clip, out);
  std::erase_if(out, [](const Fault& f) {
    return f.severity != Severity::Warning || f.kind == "repeated_name";
  });
  if (auto fault = calibrationPose(clip)) out.push_back(*std::move(fault));
  addRateDoubt(clip, rolesOf(*clip.skeleton), out);
  return out;
}

std::vector<DoctorReport> examine(const std::filesystem::path& path, const ReadOptions& options) {
  std::vector<DoctorReport> out;
  try {
    for (const Clip& clip : readClips(path, options)) out.push_back(examineClip(clip));
  } catch (const InputError& e) {
    return {unreadable(path, e.what())};
  } catch (const FileError& e) {
    return {unreadable(path, e.what())};
  }
  return out;
}

Json toJson(const Fault& fault) {
  Json out = {
      {"kind", fault.kind}, {"severity", name(fault.severity)}, {"evidence", fault.evidence}};
  if (fault.frame) out["frame"] = *fault.frame;
  return out;
}

Json toJson(const DoctorReport& r) {
  Json out = {{"path", r.path},
              {"clip", r.clip},
              {"format", r.format},
              {"fps", r.fps},
              {"frames", r.frames},
              {"joints", r.joints},
              {"seconds", r.seconds},
              {"up", r.up.value},
              {"up_evidence", r.up.evidence},
              {"unit", r.unit.value},
              {"unit_evidence", r.unit.evidence},
              {"metres_per_unit", r.metresPerUnit},
              {"skeleton", r.skeleton}};
  out["euler_orders"] = Json::object();
  for (const auto& [order, joints] : r.eulerOrders) out["euler_orders"][order] = joints;
  out["sides"] = r.sides.value;
  out["sides_evidence"] = r.sides.evidence;
  out["floor_m"] = optionalNumber(r.floorM);
  out["bone_drift"] = {{"max_std_m", r.boneDrift.maxStdM}, {"bone", r.boneDrift.bone}};
  out["sliding_near_floor_share"] = optionalNumber(r.footSkateShare);
  out["faults"] = Json::array();
  for (const Fault& fault : r.faults) out["faults"].push_back(toJson(fault));
  out["notes"] = r.notes;
  return out;
}

std::string toText(const DoctorReport& r) {
  std::string out = fmt::format("{}\n", r.path);
  if (r.frames > 0) {
    out += fmt::format("  clip      {} ({}, {} frames, {:g} fps, {:.2f} s)\n", r.clip, r.format,
                       r.frames, r.fps, r.seconds);
    out += fmt::format("  skeleton  {}, {} joints\n", r.skeleton, r.joints);
    out += fmt::format("  unit      {}: {}\n  up        {}: {}\n  sides     {}: {}\n", r.unit.value,
                       r.unit.evidence, r.up.value, r.up.evidence, r.sides.value, r.sides.evidence);
    for (const auto& [order, joints] : r.eulerOrders)
      out += fmt::format("  rotation  {} on {} joints\n", order, joints);
    if (r.floorM) out += fmt::format("  floor     {:.1f} cm\n", 100.0 * *r.floorM);
    out += fmt::format("  bones     largest standard deviation {:.3f} cm ({})\n",
                       100.0 * r.boneDrift.maxStdM, r.boneDrift.bone);
    if (r.footSkateShare)
      out += fmt::format("  skate     {:.1f} % of foot-frames near the floor\n",
                         100.0 * *r.footSkateShare);
  }
  for (const Fault& fault : r.faults)
    out +=
        fmt::format("  {:9} {}{}: {}\n", name(fault.severity), fault.kind,
                    fault.frame ? fmt::format(" at frame {}", *fault.frame) : "", fault.evidence);
  for (const std::string& note : r.notes)
    if (isOnlyNote(r, note)) out += fmt::format("  read      {}\n", note);
  if (r.faults.empty()) out += "  no fault found\n";
  return out;
}

}  // namespace marey::io
