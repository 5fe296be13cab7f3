#include "experiment/clip_statistics.h"

#include <algorithm>
#include <map>
#include <utility>

#include "base/packing.h"
#include "io/clip_io.h"
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

/// The clips of files, each read when it is asked for.
class ClipReader {
 public:
  ClipReader(const ClipFiles& files, double fps, const Clip& first)
      : m_files(files), m_fps(fps), m_first(first) {}

  const std::vector<io::InputFile>& files() const { return m_files.files; }

  /// Of one file, at the rate of the analysis; none of one that was found and cannot be read.
  /// Throws InputError unless they are comparable.
  std::vector<Clip> read(size_t file) {
    io::InputReport unused;
    return read(file, unused);
  }
  /// The same; `report` gets what is to be told of the file.
  std::vector<Clip> read(size_t file, io::InputReport& report) {
    if (const auto kept = m_kept.find(file); kept != m_kept.end()) return kept->second;
    std::vector<Clip> clips = report.read(m_files.files[file], m_files.read);
    report.throwIfFailed();
    size_t bytes = 0;
    for (Clip& clip : clips) {
      report.resample(clip, m_fps);
      clip = resampled(clip, m_fps);
      stats::requireComparable(clip, m_first);
      bytes += bytesOf(clip);
    }
    if (m_keptBytes + bytes < kKeptBytes) {
      m_keptBytes += bytes;
      m_kept[file] = clips;
    }
    return clips;
  }

 private:
  const ClipFiles& m_files;
  double m_fps;
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
};

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
          io::InputReport report;
          const std::vector<Clip> clips = reader.read(file, report);
          report.pack(packer);
          packer.add(clips.size());
          for (const Clip& clip : clips) {
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
    for (const std::string& file : packed) {
      all.clipsBefore.push_back(all.facts.clips);
      Unpacker bytes(file);
      inputs.add(io::InputReport::unpacked(bytes));
      for (auto clips = bytes.number<size_t>(); clips > 0; --clips) {
        all.seconds += bytes.number<double>();
        all.facts.add(stats::SetFacts::unpacked(bytes));
      }
      if (!bytes.done()) all.facts.add(stats::SetFacts::unpacked(bytes));
    }
    Packer packer;
    packer.add(all.seconds).add(all.clipsBefore);
    all.facts.pack(packer);
    return packer.take();
  });
  Unpacker bytes(told);
  Overview out;
  out.inputs = std::move(inputs);
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
          for (const Clip& clip : reader.read(file))
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

/// Of the first file that can be read.
Clip firstClip(const ClipFiles& clips) {
  io::InputReport report;
  for (const io::InputFile& file : clips.files) {
    const std::vector<Clip> found = report.read(file, clips.read);
    report.throwIfFailed();
    if (!found.empty())
      return resampled(found.front(), clips.fps > 0.0 ? clips.fps : found.front().fps);
  }
  report.throwIfNone(0);
  throw InputError({.path = "inputs"}, "at least one clip", "none");
}

/// 1.0 cm/s for people, 0.3 cm/s for dogs, as the papers have it.
double toleranceStep(const Skeleton& skeleton, double chosen) {
  if (chosen > 0.0) return chosen;
  return rolesOf(skeleton).quadruped ? 0.3 : 1.0;
}

}  // namespace

ClipStatistics clipStatistics(const ClipStatisticsRequest& request, Ranks& ranks,
                              Progress& progress) {
  const Clip first = firstClip(request.clips);
  ClipReader reader(request.clips, first.fps, first);
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
  ClipReader naturalReader(naturalFiles, first.fps, first);
  out.feet = request.feet.empty() ? rolesOf(*first.skeleton).feet
                                  : jointsByName(*first.skeleton, request.feet);
  Progress reading = progress.part(0.0, 0.3), naturalReading = progress.part(0.3, 0.4),
           parting = progress.part(0.4, 0.6), naturalParting = progress.part(0.6, 0.7),
           combining = progress.part(0.7, 1.0);
  const Overview overview = overviewOf(reader, out.feet, ranks, reading);
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
  const auto set = partsOf(reader, overview, setting, ranks, parting);
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
