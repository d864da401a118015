#include "plant/gltf_accessor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace verdure {

std::size_t componentSize(int component_type) {
  switch (component_type) {
    case kByte:
    case kUnsignedByte:
      return 1;
    case kShort:
    case kUnsignedShort:
      return 2;
    case kUnsignedInt:
    case kFloat:
      return 4;
    default:
      return 0;
  }
}

std::size_t componentCount(const std::string& type) {
  if (type == "SCALAR") return 1;
  if (type == "VEC2") return 2;
  if (type == "VEC3") return 3;
  if (type == "VEC4" || type == "MAT2") return 4;
  if (type == "MAT3") return 9;
  if (type == "MAT4") return 16;
  return 0;
}

namespace {

/// Accessors without a buffer view are all zeros: nothing in the file bounds their size.
constexpr std::size_t kMaxZeros = std::size_t{1} << 24;

template <class T>
T load(const std::uint8_t* at) {
  T value;
  std::memcpy(&value, at, sizeof(T));
  return value;
}

std::uint32_t loadUnsigned(const std::uint8_t* at, int component_type) {
  switch (component_type) {
    case kUnsignedByte:
      return *at;
    case kUnsignedShort:
      return load<std::uint16_t>(at);
    default:
      return load<std::uint32_t>(at);
  }
}

float loadFloat(const std::uint8_t* at, int component_type, bool normalized) {
  switch (component_type) {
    case kByte: {
      const auto v = static_cast<float>(load<std::int8_t>(at));
      return normalized ? std::max(v / 127.0f, -1.0f) : v;
    }
    case kUnsignedByte: {
      const auto v = static_cast<float>(*at);
      return normalized ? v / 255.0f : v;
    }
    case kShort: {
      const auto v = static_cast<float>(load<std::int16_t>(at));
      return normalized ? std::max(v / 32767.0f, -1.0f) : v;
    }
    case kUnsignedShort: {
      const auto v = static_cast<float>(load<std::uint16_t>(at));
      return normalized ? v / 65535.0f : v;
    }
    case kUnsignedInt:
      return static_cast<float>(load<std::uint32_t>(at));
    default:
      return load<float>(at);
  }
}

/// `count` tightly or loosely packed elements of `size` bytes within a view; null if they do not
/// fit.
const std::uint8_t* elements(std::span<const std::uint8_t> view, std::size_t offset,
                             std::size_t count, std::size_t size, std::size_t stride) {
  if (count == 0) return view.data();
  if (offset > view.size() || view.size() - offset < size) return nullptr;
  if (stride > 0 && (count - 1) > (view.size() - offset - size) / stride) return nullptr;
  return view.data() + offset;
}

void applySparse(const GltfDocument& document, const Json& sparse, AccessorData& accessor,
                 const std::string& who) {
  const std::size_t size = accessor.components * componentSize(accessor.component_type);
  const std::size_t count = readSize(document, sparse, "count", who).value_or(0);
  const Json* indices = member(sparse, "indices");
  const Json* values = member(sparse, "values");
  const std::string part = who + ", sparse part";
  if (indices == nullptr || values == nullptr || count > accessor.count)
    document.fail(part + " is incomplete or longer than the accessor");
  const auto index_view = readIndex(document, *indices, "bufferView", "bufferViews", part);
  const auto value_view = readIndex(document, *values, "bufferView", "bufferViews", part);
  const int index_type =
      static_cast<int>(readSize(document, *indices, "componentType", part).value_or(0));
  if (!index_view || !value_view ||
      (index_type != kUnsignedByte && index_type != kUnsignedShort && index_type != kUnsignedInt))
    document.fail(part + " has no buffer views or a wrong component type");
  const std::size_t index_size = componentSize(index_type);
  const std::uint8_t* index_data = elements(
      viewBytes(document, *index_view),
      readSize(document, *indices, "byteOffset", part).value_or(0), count, index_size, index_size);
  const std::uint8_t* value_data =
      elements(viewBytes(document, *value_view),
               readSize(document, *values, "byteOffset", part).value_or(0), count, size, size);
  if (index_data == nullptr || value_data == nullptr)
    document.fail(part + " ends beyond its buffer view");
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t at = loadUnsigned(index_data + i * index_size, index_type);
    if (at >= accessor.count)
      document.fail(
          fmt::format("{}: index {} is out of range ({} elements)", part, at, accessor.count));
    std::memcpy(accessor.owned.data() + at * size, value_data + i * size, size);
  }
}

}  // namespace

AccessorData openAccessor(const GltfDocument& document, std::size_t index) {
  const std::string who = document.label("accessors", "accessor", index);
  const Json& json = document.list("accessors")[index];
  AccessorData accessor;
  accessor.count = readSize(document, json, "count", who).value_or(0);
  accessor.components = componentCount(readString(json, "type"));
  accessor.component_type =
      static_cast<int>(readSize(document, json, "componentType", who).value_or(0) & 0xffff);
  accessor.normalized = readBool(json, "normalized");
  const std::size_t size = accessor.components * componentSize(accessor.component_type);
  if (size == 0) document.fail(who + " has no known type and component type");
  const std::size_t offset = readSize(document, json, "byteOffset", who).value_or(0);
  const auto view = readIndex(document, json, "bufferView", "bufferViews", who);
  const Json* sparse = member(json, "sparse");
  if (view) {
    const auto bytes = viewBytes(document, *view);
    accessor.stride = readSize(document, document.list("bufferViews")[*view], "byteStride",
                               document.label("bufferViews", "buffer view", *view))
                          .value_or(size);
    if (accessor.stride < size || accessor.stride > 252 + size)
      document.fail(
          fmt::format("{}: byteStride {} does not suit its {} bytes", who, accessor.stride, size));
    accessor.data = elements(bytes, offset, accessor.count, size, accessor.stride);
    if (accessor.data == nullptr)
      document.fail(fmt::format("{} of {} elements ends beyond its buffer view {} of {} bytes", who,
                                accessor.count, *view, bytes.size()));
  } else if (accessor.count > kMaxZeros) {
    document.fail(fmt::format("{} claims {} elements without data", who, accessor.count));
  }
  if (!view || sparse != nullptr) {
    accessor.owned.assign(accessor.count * size, 0);
    if (view)
      for (std::size_t i = 0; i < accessor.count; ++i)
        std::memcpy(accessor.owned.data() + i * size, accessor.data + i * accessor.stride, size);
    if (sparse != nullptr) applySparse(document, *sparse, accessor, who);
    accessor.data = accessor.owned.data();
    accessor.stride = size;
  }
  return accessor;
}

std::vector<float> readFloats(const GltfDocument& document, std::size_t index,
                              std::size_t components, const std::string& who) {
  const AccessorData accessor = openAccessor(document, index);
  if (accessor.components != components)
    document.fail(fmt::format("{}: {} has {} components instead of {}", who,
                              document.label("accessors", "accessor", index), accessor.components,
                              components));
  std::vector<float> values(accessor.count * components);
  const std::size_t size = componentSize(accessor.component_type);
  for (std::size_t i = 0; i < accessor.count; ++i) {
    const std::uint8_t* element = accessor.data + i * accessor.stride;
    if (accessor.component_type == kFloat) {
      std::memcpy(&values[i * components], element, components * 4);
      continue;
    }
    for (std::size_t c = 0; c < components; ++c)
      values[i * components + c] =
          loadFloat(element + c * size, accessor.component_type, accessor.normalized);
  }
  return values;
}

std::vector<std::uint32_t> readUnsigned(const GltfDocument& document, std::size_t index,
                                        std::size_t components, const std::string& who) {
  const AccessorData accessor = openAccessor(document, index);
  const int type = accessor.component_type;
  if (accessor.components != components ||
      (type != kUnsignedByte && type != kUnsignedShort && type != kUnsignedInt))
    document.fail(fmt::format("{}: {} is not {} unsigned integers per element", who,
                              document.label("accessors", "accessor", index), components));
  std::vector<std::uint32_t> values(accessor.count * components);
  const std::size_t size = componentSize(type);
  for (std::size_t i = 0; i < accessor.count; ++i)
    for (std::size_t c = 0; c < components; ++c)
      values[i * components + c] =
          loadUnsigned(accessor.data + i * accessor.stride + c * size, type);
  return values;
}

std::vector<std::uint32_t> readIndices(const GltfDocument& document, std::size_t index,
                                       const std::string& who) {
  return readUnsigned(document, index, 1, who);
}

}  // namespace verdure
