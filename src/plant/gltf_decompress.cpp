#include <draco/compression/decode.h>
#include <draco/mesh/mesh.h>
#include <fmt/format.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <cstring>

#include "plant/gltf_accessor.h"
#include "plant/gltf_document.h"

namespace verdure {
namespace {

constexpr const char* kMeshopt = "EXT_meshopt_compression";
constexpr const char* kDraco = "KHR_draco_mesh_compression";

/// Takes a name out of extensionsUsed and extensionsRequired; the lists go when empty.
void forgetExtension(Json& json, const char* name) {
  for (const char* key : {"extensionsUsed", "extensionsRequired"}) {
    const auto list = json.find(key);
    if (list == json.end() || !list->is_array()) continue;
    Json kept = Json::array();
    for (const Json& entry : *list)
      if (entry != name) kept.push_back(entry);
    if (kept.empty())
      json.erase(key);
    else
      *list = std::move(kept);
  }
}

void removeExtension(Json& object, const char* name) {
  object["extensions"].erase(name);
  if (object["extensions"].empty()) object.erase("extensions");
}

/// Decodes one compressed buffer view (EXT_meshopt_compression, bitstream version 0).
std::vector<std::uint8_t> decodeMeshopt(const GltfDocument& document, const Json& packed,
                                        const std::string& who) {
  const auto buffer = readIndex(document, packed, "buffer", "buffers", who);
  const auto length = readSize(document, packed, "byteLength", who);
  const std::size_t offset = readSize(document, packed, "byteOffset", who).value_or(0);
  const std::size_t stride = readSize(document, packed, "byteStride", who).value_or(0);
  const std::size_t count = readSize(document, packed, "count", who).value_or(0);
  const std::string mode = readString(packed, "mode");
  const std::string filter = readString(packed, "filter", "NONE");
  if (!buffer || !length) document.fail(who + ": its compressed data has no buffer or length");
  const auto& bytes = document.buffers[*buffer];
  if (offset > bytes.size() || *length > bytes.size() - offset)
    document.fail(who + ": its compressed data ends beyond its buffer");
  const bool attributes = mode == "ATTRIBUTES";
  const bool triangles = mode == "TRIANGLES";
  const bool indices = mode == "INDICES";
  const bool good_stride =
      attributes ? stride > 0 && stride % 4 == 0 && stride <= 256
                 : (stride == 2 || stride == 4) && (indices || (triangles && count % 3 == 0));
  const bool good_filter =
      filter == "NONE" ||
      (attributes && ((filter == "OCTAHEDRAL" && (stride == 4 || stride == 8)) ||
                      (filter == "QUATERNION" && stride == 8) || filter == "EXPONENTIAL"));
  if (!good_stride || !good_filter)
    document.fail(fmt::format("{}: cannot decode meshopt mode {}, filter {}, stride {}", who, mode,
                              filter, stride));
  // The codecs spend at least 1/64 byte for a byte; more than that is a lie or a bomb.
  if (count > (*length * 128 + 1024) / stride)
    document.fail(fmt::format("{} claims {} elements in {} compressed bytes", who, count, *length));
  std::vector<std::uint8_t> out(count * stride);
  const std::uint8_t* in = bytes.data() + offset;
  const int result = attributes ? meshopt_decodeVertexBuffer(out.data(), count, stride, in, *length)
                     : triangles
                         ? meshopt_decodeIndexBuffer(out.data(), count, stride, in, *length)
                         : meshopt_decodeIndexSequence(out.data(), count, stride, in, *length);
  if (result != 0) document.fail(who + ": its meshopt data is damaged");
  if (filter == "OCTAHEDRAL") meshopt_decodeFilterOct(out.data(), count, stride);
  if (filter == "QUATERNION") meshopt_decodeFilterQuat(out.data(), count, stride);
  if (filter == "EXPONENTIAL") meshopt_decodeFilterExp(out.data(), count, stride);
  return out;
}

void decompressMeshopt(GltfDocument& document) {
  std::vector<std::vector<std::uint8_t>> decoded(document.list("bufferViews").size());
  bool any = false;
  for (std::size_t view = 0; view < decoded.size(); ++view) {
    const Json* packed = extension(document.list("bufferViews")[view], kMeshopt);
    if (packed == nullptr) continue;
    const std::string who = document.label("bufferViews", "buffer view", view);
    decoded[view] = decodeMeshopt(document, *packed, who);
    any = true;
  }
  for (std::size_t view = 0; view < decoded.size(); ++view) {
    if (extension(document.list("bufferViews")[view], kMeshopt) == nullptr) continue;
    Json& json = document.json["bufferViews"][view];
    removeExtension(json, kMeshopt);
    const std::string who = document.label("bufferViews", "buffer view", view);
    const auto buffer = readIndex(document, json, "buffer", "buffers", who);
    const std::size_t offset = readSize(document, json, "byteOffset", who).value_or(0);
    const std::size_t length = readSize(document, json, "byteLength", who).value_or(0);
    const auto& bytes = decoded[view];
    if (!buffer || length != bytes.size())
      document.fail(fmt::format("{} has {} bytes where its compressed data has {}", who, length,
                                bytes.size()));
    auto& target = document.buffers[*buffer];
    const std::size_t claimed =
        readSize(document, document.list("buffers")[*buffer], "byteLength", "buffer").value_or(0);
    if (offset > claimed || length > claimed - offset)
      document.fail(who + " ends beyond its fallback buffer");
    // Views follow each other: a gap larger than all that was decoded is a lie.
    if (offset > target.size() + (std::size_t{1} << 20))
      document.fail(who + " starts far beyond the view before it");
    if (target.size() < offset + length) target.resize(offset + length);
    std::memcpy(target.data() + offset, bytes.data(), length);
  }
  for (std::size_t i = 0; i < document.buffers.size(); ++i) {
    if (extension(document.list("buffers")[i], kMeshopt) == nullptr) continue;
    removeExtension(document.json["buffers"][i], kMeshopt);
    any = true;
  }
  if (any) forgetExtension(document.json, kMeshopt);
}

template <class T>
std::vector<std::uint8_t> dracoValues(const draco::Mesh& mesh,
                                      const draco::PointAttribute& attribute,
                                      std::size_t components, std::size_t stride) {
  std::vector<std::uint8_t> out(mesh.num_points() * stride, 0);
  std::vector<T> values(components);
  for (std::uint32_t i = 0; i < mesh.num_points(); ++i) {
    attribute.ConvertValue<T>(attribute.mapped_index(draco::PointIndex(i)),
                              static_cast<std::int8_t>(components), values.data());
    std::memcpy(out.data() + i * stride, values.data(), components * sizeof(T));
  }
  return out;
}

std::vector<std::uint8_t> dracoAttribute(const draco::Mesh& mesh,
                                         const draco::PointAttribute& attribute, int component_type,
                                         std::size_t components, std::size_t stride) {
  switch (component_type) {
    case kByte:
      return dracoValues<std::int8_t>(mesh, attribute, components, stride);
    case kUnsignedByte:
      return dracoValues<std::uint8_t>(mesh, attribute, components, stride);
    case kShort:
      return dracoValues<std::int16_t>(mesh, attribute, components, stride);
    case kUnsignedShort:
      return dracoValues<std::uint16_t>(mesh, attribute, components, stride);
    case kUnsignedInt:
      return dracoValues<std::uint32_t>(mesh, attribute, components, stride);
    default:
      return dracoValues<float>(mesh, attribute, components, stride);
  }
}

/// The decoded primitives and the buffer views that held them.
class DracoDecoder {
 public:
  explicit DracoDecoder(GltfDocument& document) : document_(document) {}

  void decodePrimitive(Json& primitive, const std::string& who) {
    const Json packed = *extension(primitive, kDraco);
    removeExtension(primitive, kDraco);
    any_ = true;
    const auto view = readIndex(document_, packed, "bufferView", "bufferViews", who);
    const Json* ids = member(packed, "attributes");
    const Json* attributes = member(primitive, "attributes");
    if (!view || ids == nullptr || attributes == nullptr)
      document_.fail(who + ": its draco data lacks the buffer view or the attributes");
    if (hasFallback(*attributes)) return;
    const std::shared_ptr<const draco::Mesh> mesh = decode(*view, who);

    const auto index_accessor = readIndex(document_, primitive, "indices", "accessors", who);
    if (index_accessor) {
      const std::size_t accessor = claim(primitive["indices"], *index_accessor, *view);
      if (!filled_.contains(accessor)) fillIndices(accessor, *mesh, *view);
    }
    Json& targets = primitive["attributes"];
    for (auto it = ids->begin(); it != ids->end(); ++it) {
      const auto accessor_index = readIndex(document_, targets, it.key().c_str(), "accessors", who);
      const auto id = readSize(document_, *ids, it.key().c_str(), who);
      if (!accessor_index) continue;
      const draco::PointAttribute* attribute =
          mesh->GetAttributeByUniqueId(static_cast<std::uint32_t>(*id));
      if (attribute == nullptr)
        document_.fail(who + ": its draco data has no attribute " + it.key());
      const std::size_t accessor = claim(targets[it.key()], *accessor_index, *view);
      if (!filled_.contains(accessor)) fillAttribute(accessor, *mesh, *attribute, *view, it.key());
    }
  }

  void finish() {
    if (any_) forgetExtension(document_.json, kDraco);
  }

 private:
  bool hasFallback(const Json& attributes) const {
    for (const auto& value : attributes) {
      if (!value.is_number_integer() ||
          value.get<std::size_t>() >= document_.list("accessors").size())
        return false;
      if (member(document_.list("accessors")[value.get<std::size_t>()], "bufferView") == nullptr)
        return false;
    }
    return true;
  }

  std::shared_ptr<const draco::Mesh> decode(std::size_t view, const std::string& who) {
    auto& mesh = meshes_[view];
    if (mesh) return mesh;
    const auto bytes = viewBytes(document_, view);
    draco::DecoderBuffer in;
    in.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    auto result = draco::Decoder().DecodeMeshFromBuffer(&in);
    if (!result.ok() || result.value() == nullptr)
      document_.fail(who + ": its draco data is damaged (" + result.status().error_msg_string() +
                     ")");
    mesh = std::shared_ptr<const draco::Mesh>(std::move(result).value().release());
    return mesh;
  }

  /// The accessor to fill from `view`: the one named, or a copy if other data already fills it.
  std::size_t claim(Json& reference, std::size_t accessor, std::size_t view) {
    const auto filled = filled_.find(accessor);
    if (filled == filled_.end() || filled->second == view) return accessor;
    Json copy = document_.json["accessors"][accessor];
    copy.erase("bufferView");
    document_.json["accessors"].push_back(std::move(copy));
    reference = document_.json["accessors"].size() - 1;
    return document_.json["accessors"].size() - 1;
  }

  void fill(std::size_t accessor, std::size_t count, std::vector<std::uint8_t> bytes, int target,
            std::size_t stride, std::size_t source) {
    // The compressed view is not needed any more: its place takes the first decoded data.
    std::optional<std::size_t> reuse;
    if (!reused_.contains(source)) reuse = source;
    reused_.insert({source, true});
    const std::size_t view = appendView(document_, std::move(bytes), target, stride, reuse);
    Json& json = document_.json["accessors"][accessor];
    json["bufferView"] = view;
    json.erase("byteOffset");
    json["count"] = count;
    filled_[accessor] = source;
  }

  void fillIndices(std::size_t accessor, const draco::Mesh& mesh, std::size_t view) {
    Json& json = document_.json["accessors"][accessor];
    const bool wide = mesh.num_points() > 65535;
    json["componentType"] = wide ? kUnsignedInt : kUnsignedShort;
    const std::size_t size = wide ? 4 : 2;
    const std::size_t count = std::size_t{mesh.num_faces()} * 3;
    std::vector<std::uint8_t> bytes(count * size);
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t point =
          mesh.face(draco::FaceIndex(static_cast<std::uint32_t>(i / 3)))[i % 3].value();
      std::memcpy(bytes.data() + i * size, &point, size);  // little endian
    }
    fill(accessor, count, std::move(bytes), kElementArrayBuffer, 0, view);
  }

  void fillAttribute(std::size_t accessor, const draco::Mesh& mesh,
                     const draco::PointAttribute& attribute, std::size_t view,
                     const std::string& semantic) {
    const std::string who = document_.label("accessors", "accessor", accessor);
    const Json& json = document_.list("accessors")[accessor];
    const std::size_t components = componentCount(readString(json, "type"));
    const int type = static_cast<int>(readSize(document_, json, "componentType", who).value_or(0));
    if (components == 0 || componentSize(type) == 0 || components > 4)
      document_.fail(who + " has no known type and component type");
    const std::size_t size = components * componentSize(type);
    const std::size_t stride = (size + 3) / 4 * 4;
    auto bytes = dracoAttribute(mesh, attribute, type, components, stride);
    if (semantic == "POSITION" && type == kFloat && components == 3) {
      std::array<float, 3> low{}, high{};
      for (std::size_t i = 0; i < mesh.num_points(); ++i) {
        std::array<float, 3> p;
        std::memcpy(p.data(), bytes.data() + i * stride, 12);
        for (std::size_t c = 0; c < 3; ++c) {
          low[c] = i == 0 ? p[c] : std::min(low[c], p[c]);
          high[c] = i == 0 ? p[c] : std::max(high[c], p[c]);
        }
      }
      document_.json["accessors"][accessor]["min"] = low;
      document_.json["accessors"][accessor]["max"] = high;
    }
    fill(accessor, mesh.num_points(), std::move(bytes), kArrayBuffer, stride == size ? 0 : stride,
         view);
  }

  GltfDocument& document_;
  bool any_ = false;
  std::map<std::size_t, std::shared_ptr<const draco::Mesh>> meshes_;  // by buffer view
  std::map<std::size_t, std::size_t> filled_;                         // accessor -> buffer view
  std::map<std::size_t, bool> reused_;
};

void decompressDraco(GltfDocument& document) {
  DracoDecoder decoder(document);
  for (std::size_t m = 0; m < document.list("meshes").size(); ++m) {
    const Json* primitives = member(document.list("meshes")[m], "primitives");
    if (primitives == nullptr || !primitives->is_array()) continue;
    for (std::size_t p = 0; p < primitives->size(); ++p)
      if (extension((*primitives)[p], kDraco) != nullptr)
        decoder.decodePrimitive(
            document.json["meshes"][m]["primitives"][p],
            fmt::format("{} primitive {}", document.label("meshes", "mesh", m), p));
  }
  decoder.finish();
}

}  // namespace

void decompressGltf(GltfDocument& document) {
  decompressMeshopt(document);
  decompressDraco(document);
}

}  // namespace verdure
