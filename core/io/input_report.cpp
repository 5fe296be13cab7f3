#include "io/input_report.h"

#include "base/error.h"
#include "io/clip_io.h"

namespace marey::io {
namespace {

/// What is missing from a clip is told of every one.
bool isLoss(const Doubt& doubt) {
  return doubt.kind == "frame_count" || doubt.kind == "left_out";
}

std::string sentence(const LeftOutClip& one) {
  return fmt::format("{} is left out: {}", one.path.empty() ? one.clip : one.path, one.why);
}

}  // namespace

InputReport::InputReport(const Inputs& inputs) : m_inputs(inputs) {
  m_inputs.files.clear();
}

std::vector<Clip> InputReport::read(const InputFile& file, const ReadOptions& options) {
  const auto failed = [&](const Error& e) {
    if (file.named)
      m_failed.emplace_back(e.what());
    else
      m_inputs.notRead.push_back({file.path, e.what()});
    return std::vector<Clip>();
  };
  try {
    std::vector<Clip> clips = readClips(file.path, options);
    for (const Clip& clip : clips)
      for (const Fault& fault : doubtsOf(clip))
        add({file.path.string(), clip.name, fault.kind, fault.evidence});
    return clips;
  } catch (const InputError& e) {
    return failed(e);
  } catch (const FileError& e) {
    return failed(e);
  }
}

void InputReport::resample(const Clip& clip, double fps) {
  constexpr double kSame = 1.0 + 1e-6;
  if (!(fps > clip.fps * kSame)) return;
  add({clip.source.path, clip.name, "upsampled",
       fmt::format("{:g} frames per second are made of {:g}: those between are interpolated", fps,
                   clip.fps)});
}

void InputReport::leaveOut(const Clip& clip, std::string why) {
  m_leftOut.push_back({clip.source.path, clip.name, std::move(why)});
}

void InputReport::add(const InputReport& other) {
  const auto append = [](auto& to, const auto& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  append(m_inputs.notRead, other.m_inputs.notRead);
  for (const auto& [extension, count] : other.m_inputs.otherMotion)
    m_inputs.otherMotion[extension] += count;
  for (const auto& [extension, count] : other.m_inputs.others) m_inputs.others[extension] += count;
  append(m_doubts, other.m_doubts);
  append(m_leftOut, other.m_leftOut);
  append(m_failed, other.m_failed);
}

void InputReport::throwIfFailed() const {
  if (m_failed.empty()) return;
  std::string text = m_failed.front();
  for (size_t i = 1; i < m_failed.size(); ++i) text += "; " + m_failed[i];
  throw InputError(m_failed.size() == 1
                       ? text
                       : fmt::format("{} files cannot be read: {}", m_failed.size(), text));
}

void InputReport::throwIfNone(size_t clips) const {
  throwIfFailed();
  if (clips > 0) return;
  std::vector<std::string> reasons = m_inputs.remarks();
  for (const LeftOutClip& one : m_leftOut) reasons.push_back(sentence(one));
  throw InputError({.path = "inputs"},
                   m_leftOut.empty() ? "a motion file that can be read" : "a clip that can be used",
                   reasons.empty() ? "none" : fmt::format("{}", fmt::join(reasons, "; ")));
}

std::string InputReport::missingText() const {
  const auto counted = [](size_t count, const char* what, const char* done) {
    return fmt::format("{} {}{} {}", count, what, count == 1 ? "" : "s", done);
  };
  std::vector<std::string> parts;
  if (const size_t files = m_inputs.notRead.size(); files > 0)
    parts.push_back(counted(files, "file", "not read"));
  if (!m_leftOut.empty()) parts.push_back(counted(m_leftOut.size(), "clip", "left out"));
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::vector<std::string> InputReport::remarks() const {
  constexpr int kMostOfAKind = 3;
  std::vector<std::string> out = m_inputs.remarks();
  for (const LeftOutClip& one : m_leftOut) out.push_back(sentence(one));
  std::map<std::string, int> counts;
  for (const Doubt& doubt : m_doubts)
    if (isLoss(doubt) || counts[doubt.kind]++ < kMostOfAKind)
      out.push_back(
          fmt::format("{}: {}", doubt.path.empty() ? doubt.clip : doubt.path, doubt.text));
  for (const auto& [kind, count] : counts)
    if (count > kMostOfAKind)
      out.push_back(fmt::format("{}: {} more clips", kind, count - kMostOfAKind));
  return out;
}

void InputReport::addTo(Json& result) const {
  m_inputs.addTo(result);
  for (const LeftOutClip& one : m_leftOut)
    result["left_out"].push_back({{"name", one.clip}, {"path", one.path}, {"why", one.why}});
  for (const Doubt& doubt : m_doubts)
    result["warnings"].push_back({{"path", doubt.path},
                                  {"clip", doubt.clip},
                                  {"kind", doubt.kind},
                                  {"evidence", doubt.text}});
}

void InputReport::pack(Packer& packer) const {
  packer.add(m_inputs.notRead.size());
  for (const NotRead& one : m_inputs.notRead) packer.add(one.path.string()).add(one.reason);
  packer.add(m_leftOut.size());
  for (const LeftOutClip& one : m_leftOut) packer.add(one.path).add(one.clip).add(one.why);
  packer.add(m_doubts.size());
  for (const Doubt& d : m_doubts) packer.add(d.path).add(d.clip).add(d.kind).add(d.text);
}

InputReport InputReport::unpacked(Unpacker& bytes) {
  InputReport out;
  for (auto n = bytes.number<size_t>(); n > 0; --n) {
    std::string path = bytes.text();
    out.m_inputs.notRead.push_back({std::move(path), bytes.text()});
  }
  for (auto n = bytes.number<size_t>(); n > 0; --n) {
    LeftOutClip one;
    for (std::string* part : {&one.path, &one.clip, &one.why}) *part = bytes.text();
    out.m_leftOut.push_back(std::move(one));
  }
  for (auto n = bytes.number<size_t>(); n > 0; --n) {
    Doubt doubt;
    for (std::string* part : {&doubt.path, &doubt.clip, &doubt.kind, &doubt.text})
      *part = bytes.text();
    out.m_doubts.push_back(std::move(doubt));
  }
  return out;
}

}  // namespace marey::io
