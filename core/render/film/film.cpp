#include "render/film/film.h"

#include <algorithm>
#include <cmath>

#include "render/film/frame_sink.h"

namespace marey::render {

int frameCountOf(const Shot& shot, double fps) {
  double lastsS = 0.0;
  for (const SceneMotion& motion : shot.motions)
    if (motion.clip) lastsS = std::max(lastsS, motion.clip->seconds());
  const auto framesIn = [fps](double seconds) {
    return static_cast<int>(std::floor(seconds * fps + 1e-6));
  };
  int frames = framesIn(lastsS - shot.beginS);
  if (shot.endS) frames = std::min(frames, framesIn(*shot.endS - shot.beginS) + 1);
  return std::max(1, frames);
}

int writeFilm(const std::filesystem::path& path, const Shot& shot, const VideoFormat& format,
              const Recipe& recipe, Progress& progress) {
  VideoWriter writer(path, format, recipe);
  ShotPicture picture(shot, format.width, format.height);
  const int frames = frameCountOf(shot, format.fps);
  // Known before minutes of drawing.
  if (videoKind(path) == VideoKind::PngFrames && !format.replaceLonger)
    requireNoLaterFrame(path, frames);
  for (int k = 0; k < frames; ++k) {
    progress.throwIfCancelled();
    writer.add(picture.at(shot.beginS + k / format.fps));
    progress.report((k + 1.0) / frames, fmt::format("frame {} of {}", k + 1, frames));
  }
  writer.finish();
  return frames;
}

}  // namespace marey::render
