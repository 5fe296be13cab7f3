// Video files by frame index: frame k shows time k / fps, whatever the speed of the machine.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "render/base/image.h"
#include "render/base/recipe.h"

namespace marey::render {

enum class VideoKind {
  Mp4,       ///< H.264, yuv420p (BT.709)
  WebM,      ///< VP9, yuv420p (BT.709)
  Gif,       ///< one palette of 255 colours for all frames, endless; times in 1/100 s
  PngFrames  ///< a picture per frame
};

/// By the extension: .mp4, .webm, .gif, or .png with {frame} or {frame:04} in the file's name,
/// which becomes the number of the frame from 0 with at least so many digits. Nothing for other
/// names. Throws UsageError for a .png with other or several braces.
std::optional<VideoKind> videoKind(const std::filesystem::path& path);

/// The pictures that lie at the places of a numbered picture's names, by number; empty for the
/// names of other kinds.
std::map<int, std::filesystem::path> framesThere(const std::filesystem::path& path);

/// Quality and key frames are fixed, so that videos of one study are encoded alike. The same
/// frames give the same bytes.
struct VideoFormat {
  int width = 1280, height = 720;  ///< even in MP4 and WebM
  double fps = 30.0;               ///< at most 50 in GIF
  int quality = 18;        ///< constant rate factor of H.264: 0 lossless, 18 no visible loss,
                           ///< 51 worst; scaled for VP9, without effect on GIF and PNG
  int keyFrameEvery = 30;  ///< frames
  /// Numbered pictures of a longer video that was there go away with it; else they are refused.
  bool replaceLonger = false;
};

/// Collects frames; the file (or all pictures of frames) appears, whole, with `finish`.
class VideoWriter {
 public:
  /// The kind is that of the name. The recipe becomes the file's comment, or text chunk "marey" of
  /// every PNG, there with the frame's number. Throws UsageError for a name of no kind; InputError
  /// for odd or empty sizes, a rate outside the kind's or a quality outside 0..51; Error where the
  /// encoder is not installed.
  VideoWriter(std::filesystem::path path, const VideoFormat& format, const Recipe& recipe = {});
  ~VideoWriter();
  VideoWriter(const VideoWriter&) = delete;
  VideoWriter& operator=(const VideoWriter&) = delete;

  /// Throws InputError when the size is not that of the format.
  void add(const Image& frame);
  /// Throws FileError; Error for a video without frames; InputError where a numbered picture of a
  /// longer video follows the last frame.
  void finish();

 private:
  struct Internals;
  std::unique_ptr<Internals> m_internals;
};

}  // namespace marey::render
