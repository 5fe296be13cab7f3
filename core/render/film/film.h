// Shots as films: frame by frame at any size and rate, whatever the speed of the machine.
#pragma once

#include <filesystem>

#include "base/job.h"
#include "render/film/video.h"
#include "render/scene/shot.h"

namespace marey::render {

/// Frames that writeFilm makes of it.
int frameCountOf(const Shot& shot, double fps);
/// Frame k shows beginS + k / fps; returns their number. Throws CancelledError (no file is left),
/// and as VideoWriter and ShotPicture do.
int writeFilm(const std::filesystem::path& path, const Shot& shot, const VideoFormat& format,
              const Recipe& recipe, Progress& progress);

}  // namespace marey::render
