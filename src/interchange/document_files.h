#ifndef VERDURE_INTERCHANGE_DOCUMENT_FILES_H_
#define VERDURE_INTERCHANGE_DOCUMENT_FILES_H_

#include "base/files.h"
#include "plant/gltf_document.h"
#include "verdure/wind_files.h"

namespace verdure {

/// Throws Error unless the path is one that a plant can be written to.
inline void checkPlantPath(const std::filesystem::path& path) {
  if (path.extension() != ".glb" && path.extension() != ".gltf")
    throw Error(path.string(), "is not a kind of file that can be written", "use .glb or .gltf");
}

using FileBytes = std::vector<std::pair<std::filesystem::path, std::vector<std::uint8_t>>>;

/// The document at `path` and the others, all or none; notes them in the report.
inline void writeAll(GltfDocument document, const std::filesystem::path& path, FileBytes others,
                     WindFiles& report) {
  FileBytes files = encodeGltf(std::move(document), path);
  files.insert(files.begin(), std::make_move_iterator(others.begin()),
               std::make_move_iterator(others.end()));
  for (const auto& [file, bytes] : files) {
    if (file.parent_path() != path.parent_path())
      std::filesystem::create_directories(file.parent_path());
    report.files.emplace_back(file, bytes.size());
  }
  writeFiles(files);
}

}  // namespace verdure

#endif  // VERDURE_INTERCHANGE_DOCUMENT_FILES_H_
