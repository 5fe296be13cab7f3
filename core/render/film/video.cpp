#include "render/film/video.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "render/film/frame_sink.h"

namespace marey::render {
namespace {

/// GIF counts hundredths of a second, and players slow down what lasts less than two.
constexpr double kMostGifFps = 50.0;

VideoKind requireKind(const std::filesystem::path& path) {
  const std::optional<VideoKind> kind = videoKind(path);
  if (!kind)
    throw UsageError(
        fmt::format("{}: expected a video's name (.mp4, .webm, .gif, or .png with {{frame:04}}), "
                    "found '{}'",
                    path.string(), path.filename().string()));
  return *kind;
}

void checkFormat(const std::filesystem::path& path, VideoKind kind, const VideoFormat& f) {
  const Place place{.path = path.string()};
  // Both codecs halve the resolution of colour.
  const bool even = kind == VideoKind::Mp4 || kind == VideoKind::WebM;
  if (f.width < 16 || f.height < 16 || (even && (f.width % 2 != 0 || f.height % 2 != 0)))
    throwInput(place, fmt::format("{} picture size of 16x16 or more", even ? "an even" : "a"),
               "{}x{}", f.width, f.height);
  const double most = kind == VideoKind::Gif ? kMostGifFps : 1000.0;
  if (!(f.fps > 0.0 && f.fps <= most))
    throwInput(place, fmt::format("a frame rate in (0, {}]", most), "{}", f.fps);
  if (f.quality < 0 || f.quality > 51) throwInput(place, "a quality from 0 to 51", "{}", f.quality);
  if (f.keyFrameEvery < 1)
    throwInput(place, "a key frame every frame or more", "{}", f.keyFrameEvery);
}

std::unique_ptr<FrameSink> open(const std::filesystem::path& path, const VideoFormat& format,
                                const Recipe& recipe) {
  const VideoKind kind = requireKind(path);
  checkFormat(path, kind, format);
  if (kind == VideoKind::Gif) return openGif(path, format, recipe);
  if (kind == VideoKind::PngFrames) return openPngFrames(path, format, recipe);
  return openEncoded(path, kind, format, recipe);
}

}  // namespace

std::optional<VideoKind> videoKind(const std::filesystem::path& path) {
  const std::string extension = path.extension().string();
  if (extension == ".mp4") return VideoKind::Mp4;
  if (extension == ".webm") return VideoKind::WebM;
  if (extension == ".gif") return VideoKind::Gif;
  if (extension != ".png" || path.string().find('{') == std::string::npos) return std::nullopt;
  checkFrameTemplate(path);
  return VideoKind::PngFrames;
}

struct VideoWriter::Internals {
  std::filesystem::path path;
  VideoFormat format;
  std::unique_ptr<FrameSink> sink;
  int64_t count = 0;
};

VideoWriter::VideoWriter(std::filesystem::path path, const VideoFormat& format,
                         const Recipe& recipe) {
  auto sink = open(path, format, recipe);
  m_internals = std::make_unique<Internals>(Internals{std::move(path), format, std::move(sink)});
}

VideoWriter::~VideoWriter() = default;

void VideoWriter::add(const Image& image) {
  Internals& i = *m_internals;
  if (image.width != i.format.width || image.height != i.format.height) {
    throwInput({.path = i.path.string(), .frame = i.count + 1},
               fmt::format("{}x{} pixels", i.format.width, i.format.height), "{}x{}", image.width,
               image.height);
  }
  i.sink->add(image);
  ++i.count;
}

void VideoWriter::finish() {
  Internals& i = *m_internals;
  if (i.count == 0) throw Error(i.path.string() + ": a video needs at least one frame");
  i.sink->finish();
}

}  // namespace marey::render
