// Joint positions of a dog as text (Zhang et al. 2018): 27 joints x 3 comma-separated numbers per
// line, metres, Y up, 60 frames per second.
#pragma once

#include "io/format.h"

namespace marey::io {

/// High when the first line holds 81 comma-separated numbers.
int canReadDogText(std::string_view head);
/// Throws InputError with the line.
Clip parseDogText(std::string_view bytes, const std::string& origin,
                  const ReadOptions& options = {});
std::vector<Clip> readDogText(std::string_view bytes, const std::filesystem::path& path,
                              const ReadOptions& options);

}  // namespace marey::io
