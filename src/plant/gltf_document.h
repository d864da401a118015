#ifndef VERDURE_PLANT_GLTF_DOCUMENT_H_
#define VERDURE_PLANT_GLTF_DOCUMENT_H_

#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "verdure/error.h"
#include "verdure/plant.h"

namespace verdure {

/// Keeps the order of members, so that an export differs from its source only where it must.
using Json = nlohmann::ordered_json;

/// A glTF file: its JSON, whole and untouched, and the bytes of its buffers. No model class in
/// between: whatever is not understood (extras, unknown extensions, 64-bit integers) survives.
struct GltfDocument {
  std::string where;             ///< file name for messages
  std::filesystem::path folder;  ///< of the file: external URIs are relative to it
  Json json;
  std::vector<std::vector<std::uint8_t>> buffers;           ///< parallel to json["buffers"]
  std::map<std::size_t, std::vector<std::uint8_t>> images;  ///< external image files, by image

  [[noreturn]] void fail(const std::string& what,
                         const std::string& advice = "export the file again") const {
    throw Error(where, what, advice);
  }
  /// json[key] if it is an array, else an empty one.
  const Json& list(const char* key) const;
  /// "accessor 3 'name'" for messages.
  std::string label(const char* list_key, const char* noun, std::size_t index) const;
};

/// Where a Plant mesh came from. Vertex v of the Plant mesh belongs to instance v / n and is vertex
/// `vertex_of[v % n]` of the accessors (n = vertices per instance; identity if vertex_of is empty).
struct MeshSource {
  std::size_t node = 0, mesh = 0, primitive = 0;
  std::size_t vertices_per_instance = 0;
  std::size_t accessor_count = 0;  ///< elements of the primitive's POSITION accessor
  std::vector<std::uint32_t> vertex_of;
};

struct SourceDocument {
  GltfDocument gltf;               ///< decompressed
  std::vector<MeshSource> meshes;  ///< parallel to Plant::meshes
  std::vector<std::vector<glm::vec3>>
      normals;  ///< as loaded; empty where the file had no good ones
  std::vector<std::string> attributes;
};

/// Reads .glb or .gltf with its external buffers. Throws Error for files that are missing,
/// truncated, not glTF 2.0, nested absurdly, or whose buffers are missing or short.
GltfDocument readGltf(const std::filesystem::path& path);

/// Undoes EXT_meshopt_compression and KHR_draco_mesh_compression: the document is then as if its
/// exporter had never compressed it (KHR_mesh_quantization stays). Throws Error.
void decompressGltf(GltfDocument& document);

/// Checked access to JSON members; `who` begins the message ("mesh 2 'leaves'"). Absent members
/// give null, nullopt or `fallback`; members of the wrong type throw Error.
const Json* member(const Json& object, const char* key);
std::optional<std::size_t> readIndex(const GltfDocument& document, const Json& object,
                                     const char* key, const char* list_key, const std::string& who);
std::optional<std::size_t> readSize(const GltfDocument& document, const Json& object,
                                    const char* key, const std::string& who);
double readNumber(const GltfDocument& document, const Json& object, const char* key,
                  double fallback, const std::string& who);
bool readBool(const Json& object, const char* key);
std::string readString(const Json& object, const char* key, const std::string& fallback = "");
/// `count` finite numbers into `values`; false if absent.
bool readNumbers(const GltfDocument& document, const Json& object, const char* key,
                 std::span<double> values, const std::string& who);
/// The extension's object, or null.
const Json* extension(const Json& object, const char* name);

/// The bytes of a buffer view. Throws Error if it points outside its buffer.
std::span<const std::uint8_t> viewBytes(const GltfDocument& document, std::size_t view);

/// Decodes "data:...;base64,..." ; nullopt if `uri` is no data URI. Throws Error for bad base64.
std::optional<std::vector<std::uint8_t>> decodeDataUri(const GltfDocument& document,
                                                       const std::string& uri,
                                                       const std::string& who);
/// The file that a relative URI names: percent-decoded. Throws Error for http: and the like.
std::filesystem::path uriPath(const GltfDocument& document, const std::string& uri,
                              const std::string& who);

/// The bytes of an image: buffer view, data URI or external file. Throws Error.
std::vector<std::uint8_t> imageBytes(const GltfDocument& document, std::size_t image);

/// Appends bytes as a new buffer view (in buffer 0's list of its own, at the end) and returns its
/// index. `target`: 34962 vertices, 34963 indices, 0 none. `stride` 0: tightly packed.
std::size_t appendView(GltfDocument& document, std::vector<std::uint8_t> bytes, int target,
                       std::size_t stride, std::optional<std::size_t> reuse = std::nullopt);

/// The files that .glb or .gltf needs, the one at `path` last: .gltf has a .bin and images beside
/// it. Only bytes that a buffer view names are kept.
std::vector<std::pair<std::filesystem::path, std::vector<std::uint8_t>>> encodeGltf(
    GltfDocument document, const std::filesystem::path& path);
/// Writes them.
void writeGltf(GltfDocument document, const std::filesystem::path& path);

/// The generator string that verdure writes.
std::string gltfGenerator();

}  // namespace verdure

#endif  // VERDURE_PLANT_GLTF_DOCUMENT_H_
