#include "experiment/clip_statistics.h"

#include <algorithm>
#include <map>
#include <memory>
#include <utility>

#include "base/error.h"
#include "base/packing.h"
#include "motion/main_body.h"
#include "motion/resample.h"
#include "motion/roles.h"

namespace marey {
namespace {

/// Clips that are kept between the two readings, as long as they take less than this.
constexpr size_t kKeptBytes = 256'000'000;

size_t bytesOf(const Clip& clip) {
  const size_t each = clip.transforms ? sizeof(Quat) + sizeof(Vec3) : 0;
  return clip.positions.size() * (sizeof(Vec3) + each);
}

/// What tells bodies apart.
std::string bodyOf(const Clip& clip) {
  return fmt::format("{}", fmt::join(clip.skeleton->names, "\n"));
}

/// What a file gives.
struct FileClips {
  std::vector<Clip> clips;
  std::vector<std::string> otherBodies;  ///< of the clips that are left out
  io::InputReport report;                ///< of the first reading alone
};

/// The clips of files, each read when it is asked for.
class ClipReader {
 public:
  ClipReader(const ClipFiles& files, const Clip& first) : m_files(files), m_first(first) {}

  const std::vector<io::InputFile>& files() const { return m_files.files; }

  /// Of one file, at the rate of the analysis; none of one that was found and cannot be read. Clips
  /// of another skeleton than the first one's are left out.
  FileClips read(size_t file) {
    FileClips out;
    if (const auto kept = m_kept.find(file); kept != m_kept.end()) {
      out.clips = kept->second;
      return out;
    }
    out.clips = out.report.read(m_files.files[file], m_files.read);
    out.report.throwIfFailed();
    leaveOthersOut(out);
    size_t bytes = 0;
    for (Clip& clip : out.clips) {
      out.report.resample(clip, m_first.fps);
      clip = resampled(clip, m_first.fps);
      stats::requireComparable(clip, m_first);
      bytes += bytesOf(clip);
    }
    if (m_keptBytes + bytes < kKeptBytes) {
      m_keptBytes += bytes;
      m_kept[file] = out.clips;
    }
    return out;
  }

 private:
  void leaveOthersOut(FileClips& from) const {
    std::erase_if(from.clips, [&](const Clip& clip) {
      if (clip.skeleton->names == m_first.skeleton->names) return false;
      from.report.leaveOut(clip, otherJoints(*clip.skeleton, *m_first.skeleton));
      from.otherBodies.push_back(bodyOf(clip));
      return true;
    });
  }

  const ClipFiles& m_files;
  const Clip& m_first;
  std::map<size_t, std::vector<Clip>> m_kept;
  size_t m_keptBytes = 0;
};

/// What the first reading tells.
struct Overview {
  stats::SetFacts facts;
  double seconds = 0.0;
  std::vector<size_t> clipsBefore;  ///< clips in the files before each file
  io::InputReport inputs;           ///< at the first rank only
  std::string mainBody;             ///< that more clips have than the first one's; empty: none
};

/// Of those that were left out the body of most clips, where they are more than `used`; of equally
/// many the first.
std::string bodyOfMore(const std::vector<std::string>& others, size_t used) {
  std::string out;
  std::map<std::string, size_t> counts;
  for (const std::string& body : others) ++counts[body];
  for (const std::string& body : others)
    if (counts[body] > used) used = counts[out = body];
  return out;
}

/// Runs `work` on the files of a share, with progress.
std::vector<std::string> eachFile(size_t first, size_t last, Progress& progress,
                                  const std::function<std::string(size_t file)>& work) {
  std::vector<std::string> out;
  for (size_t file = first; file < last; ++file) {
    progress.throwIfCancelled();
    out.push_back(work(file));
    progress.report(static_cast<double>(file + 1 - first) / static_cast<double>(last - first),
                    "reading");
  }
  return out;
}

Overview overviewOf(ClipReader& reader, const std::vector<int>& feet, Ranks& ranks,
                    Progress& progress) {
  const auto packed = ranks.gather(
      reader.files().size(),
      [&](size_t first, size_t last, Progress& share) {
        // Heights are merged here: those of every clip would be much.
        stats::SetFacts heights;
        auto out = eachFile(first, last, share, [&](size_t file) {
          Packer packer;
          const FileClips found = reader.read(file);
          found.report.pack(packer);
          packer.add(found.otherBodies.size());
          for (const std::string& body : found.otherBodies) packer.add(body);
          packer.add(found.clips.size());
          for (const Clip& clip : found.clips) {
            stats::SetFacts facts = stats::factsOf(clip, feet);
            heights.add({.footHeights = std::exchange(facts.footHeights, {})});
            packer.add(clip.seconds());
            facts.pack(packer);
          }
          return packer.take();
        });
        Packer packer;
        heights.pack(packer);
        out.front() += packer.take();
        return out;
      },
      progress);
  io::InputReport inputs;
  const std::string told = ranks.fromFirst([&] {
    Overview all;
    std::vector<std::string> others;
    for (const std::string& file : packed) {
      all.clipsBefore.push_back(all.facts.clips);
      Unpacker bytes(file);
      inputs.add(io::InputReport::unpacked(bytes));
      for (auto more = bytes.number<size_t>(); more > 0; --more) others.push_back(bytes.text());
      for (auto clips = bytes.number<size_t>(); clips > 0; --clips) {
        all.seconds += bytes.number<double>();
        all.facts.add(stats::SetFacts::unpacked(bytes));
      }
      if (!bytes.done()) all.facts.add(stats::SetFacts::unpacked(bytes));
    }
    inputs.throwIfNone(all.facts.clips);
    Packer packer;
    packer.add(bodyOfMore(others, all.facts.clips)).add(all.seconds).add(all.clipsBefore);
    all.facts.pack(packer);
    return packer.take();
  });
  Unpacker bytes(told);
  Overview out;
  out.inputs = std::move(inputs);
  out.mainBody = bytes.text();
  out.seconds = bytes.number<double>();
  out.clipsBefore = bytes.list<size_t>();
  out.facts = stats::SetFacts::unpacked(bytes);
  return out;
}

/// The second reading.
stats::StatisticSet partsOf(ClipReader& reader, const Overview& overview,
                            stats::StatisticSetting setting, Ranks& ranks, Progress& progress) {
  const auto& statistics = stats::allStatistics();
  const auto packed = ranks.gather(
      reader.files().size(),
      [&](size_t first, size_t last, Progress& share) {
        return eachFile(first, last, share, [&](size_t file) {
          Packer packer;
          size_t index = overview.clipsBefore[file];
          for (const Clip& clip : reader.read(file).clips)
            for (const auto& part : stats::partsOf(statistics, clip, index++, setting))
              packer.add(part);
          return packer.take();
        });
      },
      progress);
  stats::StatisticSet out{std::move(setting), stats::SetParts(stats::rulesOf(statistics).size())};
  for (const std::string& file : packed)
    for (Unpacker bytes(file); !bytes.done();)
      for (auto& ofRule : out.parts) ofRule.push_back(bytes.text());
  return out;
}

std::vector<std::string> stems(const std::vector<io::InputFile>& files) {
  std::vector<std::string> out;
  for (const io::InputFile& file : files) out.push_back(file.path.stem().string());
  return out;
}

/// For every file of clips the natural file that its clips are compared with or share a style with;
/// -1: none.
std::vector<int> followedFiles(const ClipStatisticsRequest& request) {
  const auto natural = stems(request.natural.files);
  const bool byStyle = request.against == NaturalChoice::SameStyle;
  std::vector<int> out;
  for (const std::string& name : stems(request.clips.files)) {
    const auto at = std::find_if(natural.begin(), natural.end(), [&](const std::string& other) {
      return byStyle ? styleOf(other) == styleOf(name) : other == name;
    });
    out.push_back(at == natural.end() ? -1 : static_cast<int>(at - natural.begin()));
  }
  return out;
}

/// The number of every clip's control, by the file that it is in.
std::vector<int> controlsByFile(const Overview& overview, size_t files,
                                const std::function<int(size_t file, size_t clip)>& number) {
  std::vector<int> out;
  for (size_t file = 0; file < files; ++file) {
    const size_t end = file + 1 < files ? overview.clipsBefore[file + 1] : overview.facts.clips;
    for (size_t clip = overview.clipsBefore[file]; clip < end; ++clip)
      out.push_back(number(file, clip));
  }
  return out;
}

/// Controls of both sides. Files of one name share theirs where the same control is compared; other
/// natural clips have one each.
void setControls(const ClipStatisticsRequest& request, const Overview& overview,
                 const Overview& natural, const std::vector<io::InputFile>& naturalFiles,
                 stats::StatisticSetting& setting) {
  std::map<std::filesystem::path, int> folders;
  std::map<std::string, int> names;
  setting.controls =
      controlsByFile(overview, request.clips.files.size(), [&](size_t file, size_t clip) {
        const std::filesystem::path& path = request.clips.files[file].path;
        if (request.against == NaturalChoice::SameControl)
          return names.emplace(path.stem().string(), static_cast<int>(names.size())).first->second;
        if (request.controls == ControlRule::One) return 0;
        if (request.controls == ControlRule::Each) return static_cast<int>(clip);
        return folders.emplace(path.parent_path(), static_cast<int>(folders.size())).first->second;
      });
  const int first = 1 + *std::max_element(setting.controls.begin(), setting.controls.end());
  setting.naturalControls =
      controlsByFile(natural, naturalFiles.size(), [&](size_t file, size_t clip) {
        const auto shared = names.find(naturalFiles[file].path.stem().string());
        return shared != names.end() ? shared->second : first + static_cast<int>(clip);
      });
}

/// Of the files that can be read the first clip that is wanted; the first of all where none is.
Clip firstClip(const ClipFiles& clips, const std::function<bool(const Clip&)>& wanted) {
  io::InputReport report;
  std::optional<Clip> first;
  for (const io::InputFile& file : clips.files) {
    const std::vector<Clip> found = report.read(file, clips.read);
    report.throwIfFailed();
    const auto clip = std::find_if(found.begin(), found.end(), wanted);
    if (!first && !found.empty()) first = found.front();
    if (clip == found.end()) continue;
    first = *clip;
    break;
  }
  report.throwIfNone(first ? 1 : 0);
  return resampled(*first, clips.fps > 0.0 ? clips.fps : first->fps);
}

std::vector<int> feetOf(const Clip& clip, const std::string& names) {
  return names.empty() ? rolesOf(*clip.skeleton).feet : jointsByName(*clip.skeleton, names);
}

bool hasFeet(const Clip& clip, const std::string& names) {
  try {
    feetOf(clip, names);
    return true;
  } catch (const InputError&) {
    return false;
  } catch (const UsageError&) {
    return false;
  }
}

/// The clips of one body, read for the first time.
struct Reading {
  Reading(const ClipFiles& files, Clip clip, const std::string& feetNames)
      : first(std::move(clip)), feet(feetOf(first, feetNames)), reader(files, first) {}

  const Clip first;
  const std::vector<int> feet;
  ClipReader reader;
  Overview overview;
};

/// Of the body that most clips have: seldom another one than the first clip's, and then all are
/// read again.
std::unique_ptr<Reading> firstReading(const ClipStatisticsRequest& request, Ranks& ranks,
                                      Progress& progress) {
  std::string body;
  for (;;) {
    auto out = std::make_unique<Reading>(
        request.clips,
        firstClip(request.clips,
                  [&](const Clip& clip) {
                    return body.empty() ? hasFeet(clip, request.feet) : bodyOf(clip) == body;
                  }),
        request.feet);
    out->overview = overviewOf(out->reader, out->feet, ranks, progress);
    if (out->overview.mainBody.empty()) return out;
    body = out->overview.mainBody;
  }
}

/// 1.0 cm/s for people, 0.3 cm/s for dogs, as the papers have it.
double toleranceStep(const Skeleton& skeleton, double chosen) {
  if (chosen > 0.0) return chosen;
  return rolesOf(skeleton).quadruped ? 0.3 : 1.0;
}

}  // namespace

ClipStatistics clipStatistics(const ClipStatisticsRequest& request, Ranks& ranks,
                              Progress& progress) {
  Progress reading = progress.part(0.0, 0.3), naturalReading = progress.part(0.3, 0.4),
           parting = progress.part(0.4, 0.6), naturalParting = progress.part(0.6, 0.7),
           combining = progress.part(0.7, 1.0);
  const std::unique_ptr<Reading> own = firstReading(request, ranks, reading);
  const Clip& first = own->first;
  const Overview& overview = own->overview;
  ClipStatistics out{.skeleton = first.skeleton, .fps = first.fps};
  out.compared = !request.natural.files.empty();
  ClipFiles naturalFiles = request.natural;
  if (out.compared) {
    const auto chosen =
        naturalToCompare(stems(request.natural.files), followedFiles(request), request.against);
    naturalFiles.files.clear();
    for (const size_t i : chosen.clips) naturalFiles.files.push_back(request.natural.files[i]);
    out.comparedWith = chosen.text;
  }
  ClipReader naturalReader(naturalFiles, first);
  out.feet = own->feet;
  const Overview naturalOverview =
      out.compared ? overviewOf(naturalReader, out.feet, ranks, naturalReading) : Overview{};
  stats::StatisticSetting setting{
      .skeleton = first.skeleton,
      .feet = out.feet,
      .toes = request.feet.empty() ? std::vector<int>() : out.feet,
      .footStepCmS = toleranceStep(*first.skeleton, request.footStepCmS),
      .own = overview.facts,
      .natural = out.compared ? &naturalOverview.facts : nullptr};
  setControls(request, overview, naturalOverview, naturalFiles.files, setting);
  setting.completeReferences();
  const auto set = partsOf(own->reader, overview, setting, ranks, parting);
  std::optional<stats::StatisticSet> natural;
  if (out.compared)
    natural = partsOf(naturalReader, naturalOverview, setting.ofNatural(), ranks, naturalParting);
  if (!ranks.first()) return out;
  out.inputs = overview.inputs;
  out.inputs.add(naturalOverview.inputs);
  out.clips = overview.facts.clips;
  out.seconds = overview.seconds;
  if (!out.feet.empty()) {
    const auto rules = stats::rulesOf(stats::allStatistics());
    const auto at = std::find(rules.begin(), rules.end(), stats::footstepRule()) - rules.begin();
    out.footsteps =
        curveOf(stats::footstepTolerances({.feet = out.feet, .stepCmS = setting.footStepCmS}),
                stats::footstepTallies(set.parts[static_cast<size_t>(at)]),
                stats::ControlSets(setting.controls, {}).once().clips);
  }
  out.results = stats::evaluate(stats::allStatistics(), set, natural ? &*natural : nullptr,
                                request.options, combining);
  return out;
}

}  // namespace marey
