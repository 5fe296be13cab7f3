// Video files by frame index: frame k shows time k / fps, whatever the speed of the machine.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "base/job.h"
#include "render/scene.h"

namespace marey::render {

/// H.264 in MP4, yuv420p (BT.709), quality and key frames fixed, so that videos of one study are
/// encoded alike. The same frames give the same bytes.
struct VideoFormat {
  int width = 1280, height = 720;  ///< even
  double fps = 30.0;
  int quality = 18;        ///< constant rate factor: 0 lossless, 18 no visible loss, 51 worst
  int keyFrameEvery = 30;  ///< frames
};

/// Collects frames; the file appears, whole, with `finish`.
class VideoWriter {
 public:
  /// The recipe becomes the file's comment. Throws InputError for odd or empty sizes, a rate that
  /// is not positive or a quality outside 0..51; Error where no H.264 encoder is installed.
  VideoWriter(std::filesystem::path path, const VideoFormat& format, const Recipe& recipe = {});
  ~VideoWriter();
  VideoWriter(const VideoWriter&) = delete;
  VideoWriter& operator=(const VideoWriter&) = delete;

  /// Throws InputError when the size is not that of the format.
  void add(const Image& frame);
  /// Throws FileError, or Error for a video without frames.
  void finish();

 private:
  struct Internals;
  std::unique_ptr<Internals> m_internals;
};

struct VideoOptions {
  bool follow = false;  ///< the camera moves along with the figures
  bool trail = false;   ///< earlier figures stay, lighter
};

/// Every frame of a scene; returns their number. Throws CancelledError (no file is left) and what
/// VideoWriter throws.
int writeSceneVideo(const std::filesystem::path& path, const SceneSpec& scene,
                    const VideoFormat& format, const VideoOptions& options, const Recipe& recipe,
                    Progress& progress);

}  // namespace marey::render
