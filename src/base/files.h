#ifndef VERDURE_BASE_FILES_H_
#define VERDURE_BASE_FILES_H_

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "verdure/error.h"

namespace verdure {

/// Reads a whole file. Throws Error if it is missing, no regular file, or cannot be read.
std::vector<std::uint8_t> readFile(const std::filesystem::path& path);

/// Writes a file beside its place, then moves it there: whoever looks sees the old file, the new
/// file or none, never half of one. A process that is killed while it writes leaves nothing: the
/// file gets a name when it is complete (O_TMPFILE, linkat), and only a kill between that call and
/// the next leaves a complete `.name.NUMBER`. File systems without nameless files (NFS, FAT) hold
/// `.name.XXXXXX` while it is written; a kill leaves that behind. Throws Error if the folder is
/// missing or not writable, or if a folder, device or pipe is in the place.
void writeFile(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);
void writeFile(const std::filesystem::path& path, const std::string& text);

/// Writes several files that belong together: all of them are complete beside their places before
/// the first is moved there. Throws Error as writeFile() does, and then leaves all as they were
/// unless a move itself fails.
void writeFiles(
    const std::vector<std::pair<std::filesystem::path, std::vector<std::uint8_t>>>& files);

/// Throws Error unless a file could be written at `path` (checked before long work starts).
void checkWritable(const std::filesystem::path& path);

}  // namespace verdure

#endif  // VERDURE_BASE_FILES_H_
