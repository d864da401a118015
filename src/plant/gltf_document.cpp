#include "plant/gltf_document.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <fstream>

#include "base/files.h"

namespace verdure {
namespace fs = std::filesystem;

const Json& GltfDocument::list(const char* key) const {
  static const Json kEmpty = Json::array();
  const auto found = json.find(key);
  return found != json.end() && found->is_array() ? *found : kEmpty;
}

std::string GltfDocument::label(const char* list_key, const char* noun, std::size_t index) const {
  const Json& items = list(list_key);
  const std::string name = index < items.size() ? readString(items[index], "name") : "";
  return name.empty() ? fmt::format("{} {}", noun, index)
                      : fmt::format("{} {} '{}'", noun, index, name);
}

const Json* member(const Json& object, const char* key) {
  if (!object.is_object()) return nullptr;
  const auto found = object.find(key);
  return found == object.end() || found->is_null() ? nullptr : &*found;
}

std::optional<std::size_t> readSize(const GltfDocument& document, const Json& object,
                                    const char* key, const std::string& who) {
  const Json* value = member(object, key);
  if (value == nullptr) return std::nullopt;
  // Some exporters write whole numbers as 3.0, which the schema allows.
  const bool whole =
      (value->is_number_integer() && value->get<std::int64_t>() >= 0) ||
      (value->is_number_float() && value->get<double>() >= 0.0 && value->get<double>() < 9e15 &&
       std::floor(value->get<double>()) == value->get<double>());
  if (!whole) document.fail(fmt::format("{}: '{}' is not a whole number of 0 or more", who, key));
  return value->is_number_integer() ? value->get<std::size_t>()
                                    : static_cast<std::size_t>(value->get<double>());
}

std::optional<std::size_t> readIndex(const GltfDocument& document, const Json& object,
                                     const char* key, const char* list_key,
                                     const std::string& who) {
  const auto index = readSize(document, object, key, who);
  if (!index) return std::nullopt;
  const std::size_t count = document.list(list_key).size();
  if (*index >= count)
    document.fail(
        fmt::format("{}: '{}' is {}, but the file has {} {}", who, key, *index, count, list_key));
  return index;
}

double readNumber(const GltfDocument& document, const Json& object, const char* key,
                  double fallback, const std::string& who) {
  const Json* value = member(object, key);
  if (value == nullptr) return fallback;
  if (!value->is_number() || !std::isfinite(value->get<double>()))
    document.fail(fmt::format("{}: '{}' is not a number", who, key));
  return value->get<double>();
}

bool readBool(const Json& object, const char* key) {
  const Json* value = member(object, key);
  return value != nullptr && value->is_boolean() && value->get<bool>();
}

std::string readString(const Json& object, const char* key, const std::string& fallback) {
  const Json* value = member(object, key);
  return value != nullptr && value->is_string() ? value->get<std::string>() : fallback;
}

bool readNumbers(const GltfDocument& document, const Json& object, const char* key,
                 std::span<double> values, const std::string& who) {
  const Json* array = member(object, key);
  if (array == nullptr) return false;
  bool good = array->is_array() && array->size() == values.size();
  for (std::size_t i = 0; good && i < values.size(); ++i) {
    good = (*array)[i].is_number();
    if (good) values[i] = (*array)[i].get<double>();
    good = good && std::isfinite(values[i]);
  }
  if (!good) document.fail(fmt::format("{}: '{}' is not {} numbers", who, key, values.size()));
  return true;
}

const Json* extension(const Json& object, const char* name) {
  const Json* extensions = member(object, "extensions");
  return extensions == nullptr ? nullptr : member(*extensions, name);
}

std::span<const std::uint8_t> viewBytes(const GltfDocument& document, std::size_t view) {
  const std::string who = document.label("bufferViews", "buffer view", view);
  const Json& json = document.list("bufferViews")[view];
  const auto buffer = readIndex(document, json, "buffer", "buffers", who);
  const auto length = readSize(document, json, "byteLength", who);
  const std::size_t offset = readSize(document, json, "byteOffset", who).value_or(0);
  if (!buffer || !length) document.fail(who + " lacks its buffer or byteLength");
  const auto& bytes = document.buffers[*buffer];
  if (offset > bytes.size() || *length > bytes.size() - offset)
    document.fail(fmt::format("{} (offset {}, length {}) ends beyond buffer {} of {} bytes", who,
                              offset, *length, *buffer, bytes.size()));
  return {bytes.data() + offset, *length};
}

std::optional<std::vector<std::uint8_t>> decodeDataUri(const GltfDocument& document,
                                                       const std::string& uri,
                                                       const std::string& who) {
  if (uri.compare(0, 5, "data:") != 0) return std::nullopt;
  const std::size_t comma = uri.find(',');
  if (comma == std::string::npos || comma < 7 || uri.compare(comma - 7, 7, ";base64") != 0)
    document.fail(who + ": its data URI is not base64");
  std::vector<std::uint8_t> bytes;
  bytes.reserve((uri.size() - comma) / 4 * 3);
  std::uint32_t bits = 0;
  int count = 0;
  for (std::size_t i = comma + 1; i < uri.size() && uri[i] != '='; ++i) {
    const char c = uri[i];
    std::uint32_t value = 0;
    if (c >= 'A' && c <= 'Z')
      value = static_cast<std::uint32_t>(c - 'A');
    else if (c >= 'a' && c <= 'z')
      value = static_cast<std::uint32_t>(c - 'a' + 26);
    else if (c >= '0' && c <= '9')
      value = static_cast<std::uint32_t>(c - '0' + 52);
    else if (c == '+' || c == '-')
      value = 62;
    else if (c == '/' || c == '_')
      value = 63;
    else
      document.fail(who + ": its data URI holds characters that are not base64");
    bits = (bits << 6) | value;
    count += 6;
    if (count >= 8) {
      count -= 8;
      bytes.push_back(static_cast<std::uint8_t>(bits >> count));
    }
  }
  return bytes;
}

fs::path uriPath(const GltfDocument& document, const std::string& uri, const std::string& who) {
  if (uri.find("://") != std::string::npos)
    document.fail(who + " is on the network ('" + uri.substr(0, 80) + "')",
                  "download it beside the file and name it by a relative path");
  std::string decoded;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const auto hex = [](char c) {
      return c >= '0' && c <= '9'   ? c - '0'
             : c >= 'a' && c <= 'f' ? c - 'a' + 10
             : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                    : -1;
    };
    if (uri[i] == '%' && i + 2 < uri.size() && hex(uri[i + 1]) >= 0 && hex(uri[i + 2]) >= 0) {
      decoded += static_cast<char>(hex(uri[i + 1]) * 16 + hex(uri[i + 2]));
      i += 2;
    } else {
      decoded += uri[i];
    }
  }
  if (decoded.empty() || decoded.find('\0') != std::string::npos)
    document.fail(who + ": its URI is empty or holds a zero byte");
  return document.folder / fs::path(std::u8string(decoded.begin(), decoded.end()));
}

std::vector<std::uint8_t> imageBytes(const GltfDocument& document, std::size_t image) {
  const std::string who = document.label("images", "image", image);
  const Json& json = document.list("images")[image];
  if (const auto view = readIndex(document, json, "bufferView", "bufferViews", who)) {
    const auto bytes = viewBytes(document, *view);
    return {bytes.begin(), bytes.end()};
  }
  const std::string uri = readString(json, "uri");
  if (uri.empty()) document.fail(who + " has neither a buffer view nor a URI");
  if (auto bytes = decodeDataUri(document, uri, who)) return *bytes;
  return readFile(uriPath(document, uri, who));
}

namespace {

constexpr std::uint32_t kGlbMagic = 0x46546c67;   // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4e4f534a;  // "JSON"
constexpr std::uint32_t kBinChunk = 0x004e4942;   // "BIN\0"
constexpr int kMaxNesting = 256;

std::uint32_t wordAt(std::span<const std::uint8_t> bytes, std::size_t offset) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + offset, 4);
  return word;
}

/// The two chunks of a GLB file.
struct Glb {
  std::span<const std::uint8_t> json, bin;
};

Glb splitGlb(const GltfDocument& document, std::span<const std::uint8_t> bytes) {
  if (bytes.size() < 20) document.fail("the file is cut off within its header", "copy it again");
  if (wordAt(bytes, 4) != 2)
    document.fail(fmt::format("is glTF {}, not glTF 2", wordAt(bytes, 4)), "export it as glTF 2.0");
  const std::size_t length = wordAt(bytes, 8);
  if (length > bytes.size())
    document.fail(fmt::format("the file is cut off: {} of {} bytes", bytes.size(), length),
                  "copy it again");
  Glb glb;
  std::size_t offset = 12;
  while (offset + 8 <= length) {
    const std::size_t size = wordAt(bytes, offset);
    const std::uint32_t type = wordAt(bytes, offset + 4);
    if (size > length - offset - 8)
      document.fail(fmt::format("the chunk at byte {} ends beyond the file", offset));
    const auto chunk = bytes.subspan(offset + 8, size);
    if (offset == 12) {
      if (type != kJsonChunk) document.fail("its first chunk is not JSON");
      glb.json = chunk;
    } else if (type == kBinChunk && glb.bin.data() == nullptr) {
      glb.bin = chunk;
    }
    offset += 8 + size;
  }
  return glb;
}

/// Refuses JSON so deeply nested that whoever walks it would run out of stack.
void checkNesting(const GltfDocument& document, std::span<const std::uint8_t> text) {
  int depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const std::uint8_t c = text[i];
    if (in_string) {
      if (c == '\\')
        ++i;
      else if (c == '"')
        in_string = false;
    } else if (c == '"') {
      in_string = true;
    } else if (c == '{' || c == '[') {
      if (++depth > kMaxNesting)
        document.fail(fmt::format("its JSON is nested deeper than {}", kMaxNesting));
    } else if (c == '}' || c == ']') {
      --depth;
    }
  }
}

void parseJson(GltfDocument& document, std::span<const std::uint8_t> text) {
  checkNesting(document, text);
  // A GLB may pad its JSON with zero bytes, although it should be blanks.
  while (!text.empty() && text.back() == 0) text = text.first(text.size() - 1);
  try {
    document.json = Json::parse(text.begin(), text.end());
  } catch (const Json::exception& e) {
    std::string message = e.what();
    // "[json.exception.parse_error.101] parse error at line 1, column 9: ..." -> from "parse".
    if (const auto bracket = message.find("] "); bracket != std::string::npos)
      message.erase(0, bracket + 2);
    for (char& c : message)
      if (static_cast<unsigned char>(c) < 32) c = ' ';
    if (message.size() > 160) message = message.substr(0, 160) + "...";
    document.fail("is not a glTF file (" + message + ")", "check that it is a .glb or .gltf");
  }
  const Json* asset = member(document.json, "asset");
  const std::string version = asset == nullptr ? "" : readString(*asset, "version");
  if (version.empty())
    document.fail("is not a glTF file (no asset version)", "check that it is a .glb or .gltf");
  if (version.compare(0, 2, "2.") != 0)
    document.fail("is glTF " + version + ", not glTF 2", "export it as glTF 2.0");
  for (const char* key : {"accessors", "buffers", "bufferViews", "images", "materials", "meshes",
                          "nodes", "samplers", "scenes", "skins", "textures"}) {
    const Json* list = member(document.json, key);
    if (list == nullptr) continue;
    bool good = list->is_array();
    for (std::size_t i = 0; good && i < list->size(); ++i) good = (*list)[i].is_object();
    if (!good) document.fail(fmt::format("'{}' is not a list of objects", key));
  }
}

std::vector<std::uint8_t> readBufferFile(const GltfDocument& document, const std::string& uri,
                                         const std::string& who) {
  const fs::path path = uriPath(document, uri, who);
  std::error_code status;
  if (!fs::is_regular_file(path, status))
    document.fail(who + ": there is no file " + path.string(), "copy it there");
  return readFile(path);
}

void loadBuffers(GltfDocument& document, std::span<const std::uint8_t> bin) {
  const Json& buffers = document.list("buffers");
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    const std::string who = document.label("buffers", "buffer", i);
    const auto length = readSize(document, buffers[i], "byteLength", who);
    if (!length) document.fail(who + " has no byteLength");
    std::vector<std::uint8_t> bytes;
    if (const std::string uri = readString(buffers[i], "uri"); !uri.empty()) {
      if (auto decoded = decodeDataUri(document, uri, who))
        bytes = std::move(*decoded);
      else
        bytes = readBufferFile(document, uri, who);
    } else if (i == 0 && bin.data() != nullptr) {
      bytes.assign(bin.begin(), bin.end());
    } else if (extension(buffers[i], "EXT_meshopt_compression") != nullptr) {
      document.buffers.emplace_back();  // a fallback without bytes, filled by decompressGltf
      continue;
    } else {
      document.fail(who + " has neither a URI nor a binary chunk");
    }
    if (bytes.size() < *length)
      document.fail(fmt::format("{} has {} bytes instead of {}", who, bytes.size(), *length),
                    "copy the file (and its .bin) again");
    bytes.resize(*length);
    document.buffers.push_back(std::move(bytes));
  }
}

}  // namespace

GltfDocument readGltf(const fs::path& path) {
  const std::vector<std::uint8_t> bytes = readFile(path);
  GltfDocument document;
  document.where = path.string();
  document.folder = path.parent_path();
  if (bytes.size() >= 4 && wordAt(bytes, 0) == kGlbMagic) {
    const Glb glb = splitGlb(document, bytes);
    parseJson(document, glb.json);
    loadBuffers(document, glb.bin);
  } else {
    parseJson(document, bytes);
    loadBuffers(document, {});
  }
  return document;
}

}  // namespace verdure
