// Motions as files: videos, pictures and clips, each with the recipe that made them.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/job.h"
#include "experiment/motions.h"
#include "experiment/recipe.h"
#include "motion/skeleton_fit.h"
#include "render/base/recipe.h"
#include "render/film/film.h"

namespace marey {

enum class ExportFormat { Mp4, WebM, Gif, PngFrames, Still, Bvh, Gltf, Glb, Npz, Csv };

/// One file for all motions, instead of one for each.
bool isPicture(ExportFormat format);
/// With a rate and a camera that can move.
bool isVideo(ExportFormat format);

/// A motion and what its file says of it.
struct ExportItem {
  ClipPtr clip;
  std::string name;   ///< of its file, without extension: SYSTEM_PATH_000
  std::string group;  ///< name of its set
  std::string legend;
  render::Colour colour;
  std::vector<RootFrame> wanted;       ///< empty where no path was asked for
  std::optional<SampleOrigin> origin;  ///< of samples
  Json recipe;                         ///< of its file
};

struct ExportRequest {
  ExportFormat format = ExportFormat::Mp4;
  std::filesystem::path folder;
  std::string name = "motions";  ///< of pictures and videos, without extension
  std::vector<ExportItem> items;
  std::optional<TimeRange> range;  ///< only what lies inside it
  std::string experimentHash;      ///< of the document when the export was asked for
  int width = 1280, height = 720;
  double fps = 30.0;
  /// The scene of the window; none: strobed figures as `marey render` draws them.
  std::optional<render::Shot> shot;
  double stillS = 0.0;                 ///< moment of a still of `shot`
  Json shotSettings = Json::object();  ///< what the recipe of `shot` tells beside its own settings
  // Without a shot:
  render::View view = render::View::ThreeQuarter;
  bool orthographic = false;
  bool follow = false, trail = false, path = true;
  stats::ContactRule contacts = {};  ///< what the marks on the floor mark
  double strobeS = 0.4;              ///< between the figures of a still or a trail
};

struct ExportResult {
  std::vector<std::filesystem::path> files;  ///< frames of a video: the name with {frame:04}
  std::optional<FitResidual> fit;            ///< over all clips whose rotations had to be fitted
};

/// The motions of these ids under names that differ; those with nothing in the range are left out.
/// No motion is copied.
std::vector<ExportItem> exportItems(const Experiment& experiment,
                                    const std::vector<MotionGroup>& groups,
                                    const std::vector<MotionId>& ids,
                                    const std::optional<TimeRange>& range);
/// Files that an export writes, companions left out; one with {frame:04} for frames.
std::vector<std::filesystem::path> exportFiles(const ExportRequest& request);
/// Files that are there and would be replaced, or would go: all pictures of an earlier video.
std::vector<std::filesystem::path> replacedFiles(const ExportRequest& request);
/// What a picture of several motions carries.
render::Recipe pictureRecipe(const ExportRequest& request);
/// Clips appear all or none; what replacedFiles named is replaced. Throws InputError, FileError,
/// UsageError, CancelledError.
ExportResult exportMotions(const ExportRequest& request, Progress& progress);

}  // namespace marey
