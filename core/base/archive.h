// Zip archives in memory (NPZ files, PyTorch checkpoints), read with limits.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>

namespace marey {

/// name -> content of every file of the archive. `maxBytes` bounds the unpacked sum, so a
/// small file cannot claim the memory of the machine.
/// Throws InputError (no zip, damaged entry, too large).
std::map<std::string, std::string> parseArchive(std::string_view bytes, const std::string& origin,
                                                size_t maxBytes = size_t{4} << 30);
/// Deflated when `compress`; written atomically. Throws FileError.
void writeArchive(const std::filesystem::path& path,
                  const std::map<std::string, std::string>& files, bool compress = true);

}  // namespace marey
