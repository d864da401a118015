#ifndef VERDURE_BASE_FILES_H_
#define VERDURE_BASE_FILES_H_

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "verdure/error.h"

namespace verdure {

/// Reads a whole file. Throws Error if it is missing, a folder, or cannot be read.
std::vector<std::uint8_t> readFile(const std::filesystem::path& path);

/// Writes a file under a temporary name in the same folder, then renames it: whoever looks sees the
/// old file, the new file or none, never half of one. Throws Error if the folder is missing or not
/// writable.
void writeFile(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);
void writeFile(const std::filesystem::path& path, const std::string& text);

/// Throws Error unless a file could be written at `path` (checked before long work starts).
void checkWritable(const std::filesystem::path& path);

}  // namespace verdure

#endif  // VERDURE_BASE_FILES_H_
