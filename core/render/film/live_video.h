// The moving scene as a film: what a window shows, drawn again frame by frame at any size and rate.
#pragma once

#include <optional>
#include <vector>

#include "base/json.h"
#include "render/base/image.h"
#include "render/film/video.h"
#include "render/scene/live_scene.h"

namespace marey::render {

/// A copy of what a scene shows, and from where. Shared clips only, so it is cheap to hand to
/// another thread.
struct LiveShot {
  std::vector<LiveMotion> motions;
  LiveOptions options;
  std::optional<LiveView> view;  ///< turned to and fitted to the picture; none: `viewpoint`
  Viewpoint viewpoint;
  bool orthographic = false;  ///< of `view`; a viewpoint has its own
  bool follow = false;
  double beginS = 0.0;
  std::optional<double> endS;  ///< the last moment shown; none: the end of the longest motion
  Image over;  ///< laid over every picture, which has its size: a legend; empty: nothing
};

/// Frames that writeLiveVideo makes of it.
int frameCountOf(const LiveShot& shot, double fps);
/// The scene at one moment. Throws as LiveScene and LivePicture do.
Image drawLive(const LiveShot& shot, double timeS, int width, int height);
/// Frame k shows beginS + k / fps; returns their number. Throws CancelledError (no file is left),
/// and as VideoWriter, LiveScene and LivePicture do.
int writeLiveVideo(const std::filesystem::path& path, const LiveShot& shot,
                   const VideoFormat& format, const Recipe& recipe, Progress& progress);
/// What was shown and from where, for recipes; the motions themselves are left out.
Json toJson(const LiveShot& shot);

}  // namespace marey::render
