// Where the frames of a video go: one implementation per kind of file, behind VideoWriter.
#pragma once

#include <filesystem>
#include <memory>

#include "render/film/video.h"

namespace marey::render {

/// Frames have the size of the format; there is at least one before `finish`. Nothing appears at
/// the path before that.
class FrameSink {
 public:
  virtual ~FrameSink() = default;
  virtual void add(const Image& frame) = 0;
  virtual void finish() = 0;
};

/// H.264 in MP4 or VP9 in WebM, as `kind` says.
std::unique_ptr<FrameSink> openEncoded(const std::filesystem::path& path, VideoKind kind,
                                       const VideoFormat& format, const Recipe& recipe);
/// One palette for all frames; they wait as PNG until it is known.
std::unique_ptr<FrameSink> openGif(const std::filesystem::path& path, const VideoFormat& format,
                                   const Recipe& recipe);
/// A PNG per frame, numbered from 0.
std::unique_ptr<FrameSink> openPngFrames(const std::filesystem::path& path,
                                         const VideoFormat& format, const Recipe& recipe);

/// Throws UsageError unless the name of a numbered picture has one template, and its folder none.
void checkFrameTemplate(const std::filesystem::path& path);
/// Throws InputError where a frame `count` lies at the place of a numbered picture: the end of a
/// longer video, which would seem to belong to this one.
void requireNoLaterFrame(const std::filesystem::path& path, int count);

}  // namespace marey::render
