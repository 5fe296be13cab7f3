#include "report/motion_export.h"

#include <algorithm>
#include <set>

#include "base/atomic_file.h"
#include "base/error.h"
#include "experiment/file_names.h"
#include "io/clip_io.h"

namespace marey {
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

ClipPtr inRange(const ClipPtr& clip, const std::optional<TimeRange>& range) {
  if (!range) return clip;
  const auto [first, last] = framesIn(*clip, range);
  return std::make_shared<const Clip>(sliceFrames(*clip, first, last));
}

std::optional<SampleOrigin> originOf(const MotionGroup& group) {
  if (!group.recipe) return std::nullopt;
  return SampleOrigin{group.modelHash, group.recipe->seed, group.recipe->system.temperature,
                      group.recipe->system.options};
}

Json recipeOf(const std::string& experiment, const MotionGroup& group, int index,
              const std::optional<TimeRange>& range) {
  Json out = motionRecipe(experiment, originOf(group));
  out["group"] = group.name;
  if (group.recipe) {
    out["sample"] = index;
    out["recipe"] = toJson(*group.recipe);
  } else {
    const Clip& clip = *group.motions[static_cast<size_t>(index)].clip;
    if (!clip.source.path.empty()) out["source"] = clip.source.path;
    out["clip"] = clip.name;
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

render::Shot printedShot(const ExportRequest& request) {
  std::vector<render::SceneMotion> motions;
  std::vector<RootFrame> path;
  for (const ExportItem& item : request.items) {
    motions.push_back(
        {.clip = inRange(item.clip, request.range), .colour = item.colour, .label = item.legend});
    if (request.path && path.empty()) path = item.wanted;
  }
  render::Shot shot = render::shotOfMotions(std::move(motions));
  shot.view = request.view;
  shot.orthographic = request.orthographic;
  shot.follow = request.follow;
  shot.options.path = std::move(path);
  shot.options.contacts = request.contacts;
  if (request.format == ExportFormat::Still) return render::strobed(shot, request.strobeS);
  return request.trail ? render::withTrail(shot, request.strobeS) : shot;
}

ExportResult exportPicture(const ExportRequest& request, Progress& progress) {
  const fs::path file = exportFiles(request).front();
  const render::Recipe recipe = pictureRecipe(request);
  // A folder that cannot be written is told of before minutes of drawing.
  { const StagedFolder probe(request.folder); }
  const render::VideoFormat format{
      .width = request.width, .height = request.height, .fps = request.fps, .replaceLonger = true};
  const bool still = request.format == ExportFormat::Still;
  const render::Shot shot = request.shot ? *request.shot : printedShot(request);
  if (!still)
    render::writeFilm(file, shot, format, recipe, progress);
  else if (request.shot)
    render::writePng(file, render::drawShot(shot, request.stillS, request.width, request.height),
                     recipe);
  else
    render::writePng(file, render::drawEnd(shot, request.width, request.height), recipe);
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
    const auto written =
        io::writeClip(*inRange(item.clip, request.range),
                      staged.path() / (item.name + extensionOf(request.format)), options);
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
    if (framesIn(*motion.clip, range).empty()) continue;
    const std::string wanted = nameOf(*group, motion, id.index);
    std::string name = wanted;
    for (int n = 2; !names.insert(name).second; ++n) name = fmt::format("{}_{}", wanted, n);
    out.push_back({.clip = motion.clip,
                   .name = name,
                   .group = group->name,
                   .legend = group->natural() ? group->name : group->system,
                   .colour = render::colourOf(group->colourIndex),
                   .wanted = group->wanted,
                   .origin = originOf(*group),
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

std::vector<fs::path> replacedFiles(const ExportRequest& request) {
  std::vector<fs::path> out;
  for (const fs::path& file : exportFiles(request)) {
    std::error_code ec;
    if (request.format != ExportFormat::PngFrames) {
      if (fs::exists(file, ec)) out.push_back(file);
      continue;
    }
    for (const auto& [number, frame] : render::framesThere(file)) out.push_back(frame);
  }
  return out;
}

render::Recipe pictureRecipe(const ExportRequest& request) {
  std::vector<RecipeSet> sets;
  for (const ExportItem& item : request.items) {
    const auto found = std::find_if(sets.begin(), sets.end(),
                                    [&](const RecipeSet& set) { return set.name == item.group; });
    // A natural motion is known by its file.
    const std::string source = item.recipe.value("source", "");
    const std::string name = source.empty() ? item.name : item.name + " from " + source;
    if (found == sets.end())
      sets.push_back({item.group, item.origin, name});
    else
      found->motions += ", " + name;
  }
  render::Recipe out = recipeOf(request.experimentHash, sets);
  if (request.range)
    out.emplace_back("range_s",
                     fmt::format("{:g} to {:g}", request.range->beginS, request.range->endS));
  if (!request.shot) return out;
  Json scene = render::toJson(*request.shot);
  scene.update(request.shotSettings);
  if (request.format == ExportFormat::Still) scene["time_s"] = request.stillS;
  out.emplace_back("scene", scene.dump());
  return out;
}

ExportResult exportMotions(const ExportRequest& request, Progress& progress) {
  if (request.items.empty())
    throw InputError({.path = request.folder.string()},
                     request.shot ? "motions that the 3D view shows" : "motions to export", "none");
  return isPicture(request.format) ? exportPicture(request, progress)
                                   : exportClips(request, progress);
}

}  // namespace marey
