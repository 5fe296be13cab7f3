// What a motion format is, and the choices of a reading or a writing.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/json.h"
#include "motion/clip.h"
#include "motion/skeleton_fit.h"

namespace marey::io {

/// Empty members mean: as the file says, else as its content suggests (see ClipSource::notes).
struct ReadOptions {
  std::string unit;            ///< "m", "cm", "mm", "inch", "foot", "cmu"
  std::string up;              ///< "y" or "z"
  std::optional<double> fps;   ///< replaces the rate of the file
  bool dropStaticRoot = true;  ///< leave out a root joint that never moves or only
                               ///< marks the body's place on the floor (its motion is kept)
  std::filesystem::path asf;   ///< skeleton of an AMC file; found beside it when empty
  bool swapSides = false;      ///< the file names left what is right
  bool wholeRows = false;      ///< take the whole frames of a file that says it has more or fewer
  std::string eulerOrder;  ///< "ZYX": order of the intrinsic turns of formats with Euler angles;
                           ///< the file's values keep their axes
};

struct WriteOptions {
  std::string format;              ///< name of a format; by the file's extension when empty
  std::string unit;                ///< unit of length; the format's own when empty
  std::string up = "y";            ///< "y" or "z"
  std::string eulerOrder = "ZXY";  ///< of rotation channels
  Json recipe = Json::object();    ///< where the motion came from; kept inside or beside the file
};

/// One motion file format. Functions are null where a direction is not supported.
struct ClipFormat {
  std::string name;
  std::string description;
  std::vector<std::string> extensions;  ///< lower case, with the dot
  /// 0 (no) to 100 (certain) for the first bytes of a file.
  int (*canRead)(std::string_view head) = nullptr;
  /// The clips of a file's bytes. `path` names them and leads to companion files.
  std::vector<Clip> (*read)(std::string_view bytes, const std::filesystem::path& path,
                            const ReadOptions& options) = nullptr;
  /// Writes one clip atomically; returns every file written. See `holdsRotations`.
  std::vector<std::filesystem::path> (*write)(const Clip& clip, const std::filesystem::path& path,
                                              const WriteOptions& options) = nullptr;
  /// The format stores rotations: `write` wants clips that have them (see writeClip).
  bool holdsRotations = false;
};

/// What a writing left behind.
struct WrittenClip {
  std::vector<std::filesystem::path> files;
  std::optional<FitResidual> fit;  ///< where rotations had to be fitted to positions
};

/// Every format, in the order in which ties of canRead are broken.
const std::vector<ClipFormat>& clipFormats();

}  // namespace marey::io
