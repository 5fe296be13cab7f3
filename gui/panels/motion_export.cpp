#include "panels/motion_export.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "base/atomic_file.h"
#include "base/error.h"
#include "io/clip_io.h"
#include "render/video.h"

namespace marey::gui {
namespace {
namespace fs = std::filesystem;

const char* extensionOf(ExportFormat format) {
  switch (format) {
    case ExportFormat::Mp4:
      return ".mp4";
    case ExportFormat::WebM:
      return ".webm";
    case ExportFormat::Gif:
      return ".gif";
    case ExportFormat::PngFrames:
    case ExportFormat::Still:
      return ".png";
    case ExportFormat::Bvh:
      return ".bvh";
    case ExportFormat::Gltf:
      return ".gltf";
    case ExportFormat::Glb:
      return ".glb";
    case ExportFormat::Npz:
      return ".npz";
    case ExportFormat::Csv:
      break;
  }
  return ".csv";
}

/// Null where nothing of the clip is inside the range.
ClipPtr inRange(const ClipPtr& clip, const std::optional<TimeRange>& range) {
  if (!range) return clip;
  const int first = std::max(0, static_cast<int>(std::ceil(range->beginS * clip->fps - 1e-9)));
  const int last = std::min(clip->frameCount(),
                            static_cast<int>(std::floor(range->endS * clip->fps + 1e-9)) + 1);
  if (first >= last) return nullptr;
  return std::make_shared<const Clip>(sliceFrames(*clip, first, last));
}

Json recipeOf(const std::string& experiment, const MotionGroup& group, int index,
              const std::optional<TimeRange>& range) {
  Json out = {{"marey", MAREY_VERSION}, {"experiment_hash", experiment}, {"group", group.name}};
  if (group.recipe) {
    out["model_hash"] = group.modelHash;
    out["seed"] = group.recipe->seed;
    out["temperature"] = group.recipe->system.temperature;
    out["sample"] = index;
    out["recipe"] = toJson(*group.recipe);
  }
  if (range) out["range_s"] = {range->beginS, range->endS};
  return out;
}

std::string nameOf(const MotionGroup& group, const Motion& motion, int index) {
  if (!group.recipe)
    return safeName(motion.clip->name.empty() ? fmt::format("{}_{:03}", group.name, index)
                                              : motion.clip->name);
  return fmt::format("{}_{}_{:03}", safeName(group.recipe->system.name),
                     safeName(group.recipe->path.name), index);
}

render::SceneSpec sceneOf(const ExportRequest& request) {
  // Many figures over each other show how they spread only while one sees through them.
  constexpr double kSolidFigures = 3.0, kFaintest = 0.25;
  render::SceneSpec scene{.view = request.view};
  const auto samples = std::count_if(request.items.begin(), request.items.end(), [](const auto& i) {
    return i.colour != render::naturalColour();
  });
  const double opacity =
      std::clamp(kSolidFigures / std::max(1.0, static_cast<double>(samples)), kFaintest, 1.0);
  for (const ExportItem& item : request.items) {
    scene.motions.push_back({.clip = item.clip,
                             .system = item.group,
                             .colour = item.colour,
                             .opacity = item.colour == render::naturalColour() ? 1.0 : opacity,
                             .strobeS = request.strobeS});
    if (request.path && scene.path.empty()) scene.path = item.wanted;
  }
  return scene;
}

ExportResult exportPicture(const ExportRequest& request, Progress& progress) {
  const fs::path file = exportFiles(request).front();
  const render::SceneSpec scene = sceneOf(request);
  const render::Recipe recipe = pictureRecipe(request.items);
  if (request.format == ExportFormat::Still)
    render::writePng(file, render::renderScene(scene, request.width, request.height), recipe);
  else
    render::writeSceneVideo(file, scene,
                            {.width = request.width, .height = request.height, .fps = request.fps},
                            {.follow = request.follow, .trail = request.trail}, recipe, progress);
  return {.files = {file}, .fit = {}};
}

ExportResult exportClips(const ExportRequest& request, Progress& progress) {
  ExportResult out;
  StagedFolder staged(request.folder);
  for (size_t i = 0; i < request.items.size(); ++i) {
    const ExportItem& item = request.items[i];
    progress.throwIfCancelled();
    io::WriteOptions options;
    options.recipe = item.recipe;
    const auto written = io::writeClip(
        *item.clip, staged.path() / (item.name + extensionOf(request.format)), options);
    for (const fs::path& file : written.files)
      out.files.push_back(request.folder / file.filename());
    if (written.fit) out.fit = out.fit ? pooled(*out.fit, *written.fit) : *written.fit;
    progress.report(static_cast<double>(i + 1) / static_cast<double>(request.items.size()),
                    item.name);
  }
  staged.commit();
  return out;
}

}  // namespace

bool isVideo(ExportFormat format) {
  return format == ExportFormat::Mp4 || format == ExportFormat::WebM ||
         format == ExportFormat::Gif || format == ExportFormat::PngFrames;
}

bool isPicture(ExportFormat format) {
  return isVideo(format) || format == ExportFormat::Still;
}

std::string safeName(const std::string& text) {
  std::string out;
  for (const char c : text) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '-' || c == '_';
    if (plain)
      out += c;
    else if (!out.empty() && out.back() != '_')
      out += '_';
  }
  while (!out.empty() && out.back() == '_') out.pop_back();
  return out.empty() ? "motion" : out;
}

std::vector<ExportItem> exportItems(const Experiment& experiment,
                                    const std::vector<MotionGroup>& groups,
                                    const std::vector<MotionId>& ids,
                                    const std::optional<TimeRange>& range) {
  std::vector<ExportItem> out;
  std::set<std::string> names;
  const std::string hash = experimentHash(experiment);
  for (const MotionId& id : ids) {
    const auto group = std::find_if(groups.begin(), groups.end(),
                                    [&](const MotionGroup& g) { return g.id == id.group; });
    const auto index = static_cast<size_t>(id.index);
    if (group == groups.end() || index >= group->motions.size()) continue;
    const Motion& motion = group->motions[index];
    const ClipPtr clip = inRange(motion.clip, range);
    if (!clip) continue;
    const std::string wanted = nameOf(*group, motion, id.index);
    std::string name = wanted;
    for (int n = 2; !names.insert(name).second; ++n) name = fmt::format("{}_{}", wanted, n);
    out.push_back({.clip = clip,
                   .name = name,
                   .group = group->natural() ? group->name : group->system,
                   .colour = group->colour(),
                   .wanted = group->wanted,
                   .recipe = recipeOf(hash, *group, id.index, range)});
  }
  return out;
}

std::vector<fs::path> exportFiles(const ExportRequest& request) {
  const std::string extension = extensionOf(request.format);
  const std::string number = request.format == ExportFormat::PngFrames ? "_{frame:04}" : "";
  if (isPicture(request.format))
    return {request.folder / (safeName(request.name) + number + extension)};
  std::vector<fs::path> out;
  for (const ExportItem& item : request.items)
    out.push_back(request.folder / (item.name + extension));
  return out;
}

render::Recipe pictureRecipe(const std::vector<ExportItem>& items) {
  render::Recipe out{{"marey", MAREY_VERSION}};
  if (items.empty()) return out;
  const Json& first = items.front().recipe;
  out.emplace_back("experiment_hash", first.value("experiment_hash", ""));
  if (first.contains("range_s")) out.emplace_back("range_s", jsonText(first["range_s"]));
  std::map<std::string, std::vector<std::string>> names;
  for (const ExportItem& item : items) {
    const std::string group = item.recipe.value("group", item.group);
    if (names[group].empty() && item.recipe.contains("recipe")) {
      out.emplace_back("model_hash " + group, item.recipe.value("model_hash", ""));
      out.emplace_back("seed " + group, jsonText(item.recipe["seed"]));
      out.emplace_back("temperature " + group, jsonText(item.recipe["temperature"]));
    }
    names[group].push_back(item.name);
  }
  for (const auto& [group, list] : names)
    out.emplace_back("motions " + group, fmt::format("{}", fmt::join(list, ", ")));
  return out;
}

ExportResult exportMotions(const ExportRequest& request, Progress& progress) {
  if (request.items.empty())
    throw InputError({.path = request.folder.string()}, "motions to export", "none");
  return isPicture(request.format) ? exportPicture(request, progress)
                                   : exportClips(request, progress);
}

}  // namespace marey::gui
