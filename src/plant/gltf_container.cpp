#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "base/files.h"
#include "plant/gltf_document.h"

namespace verdure {
namespace fs = std::filesystem;
namespace {

Json& listIn(GltfDocument& document, const char* key) {
  Json& list = document.json[key];
  if (!list.is_array()) list = Json::array();
  return list;
}

void appendWord(std::vector<std::uint8_t>& out, std::size_t word) {
  const auto value = static_cast<std::uint32_t>(word);
  const std::size_t at = out.size();
  out.resize(at + 4);
  std::memcpy(out.data() + at, &value, 4);
}

std::string mimeType(const std::vector<std::uint8_t>& bytes, const fs::path& path) {
  if (bytes.size() > 3 && bytes[0] == 0x89 && bytes[1] == 'P') return "image/png";
  if (bytes.size() > 3 && bytes[0] == 0xff && bytes[1] == 0xd8) return "image/jpeg";
  return path.extension() == ".ktx2" ? "image/ktx2" : "image/webp";
}

std::string percentEncoded(const std::string& text) {
  std::string out;
  for (const char c : text) {
    const auto u = static_cast<unsigned char>(c);
    if (std::isalnum(u) != 0 || c == '-' || c == '_' || c == '.' || c == '~')
      out += c;
    else
      out += fmt::format("%{:02X}", u);
  }
  return out;
}

/// External images become buffer views of a .glb; for a .gltf in another folder they are copied.
/// Images that cannot be read stay as they are named.
void placeImages(GltfDocument& document, const fs::path& path, bool binary,
                 std::vector<std::pair<fs::path, std::vector<std::uint8_t>>>& files) {
  for (std::size_t i = 0; i < document.list("images").size(); ++i) {
    const std::string uri = readString(document.list("images")[i], "uri");
    if (uri.empty() || uri.starts_with("data:")) continue;
    std::vector<std::uint8_t> bytes;
    fs::path from;
    try {
      from = uriPath(document, uri, document.label("images", "image", i));
      bytes = readFile(from);
    } catch (const Error&) {
      continue;
    }
    if (binary) {
      const std::string mime = mimeType(bytes, from);
      const std::size_t view = appendView(document, std::move(bytes), 0, 0);
      Json& image = document.json["images"][i];
      image.erase("uri");
      image["mimeType"] = mime;
      image["bufferView"] = view;
      continue;
    }
    // URIs that leave the folder are brought into it.
    const fs::path relative = fs::path(from).lexically_relative(
        document.folder.empty() ? fs::path(".") : document.folder);
    fs::path to = path.parent_path() / relative;
    if (relative.empty() || *relative.begin() == "..") {
      to = path.parent_path() / from.filename();
      document.json["images"][i]["uri"] = percentEncoded(from.filename().string());
    }
    std::error_code status;
    if (!fs::equivalent(from, to, status)) files.emplace_back(to, std::move(bytes));
  }
}

/// One run of bytes that buffer views share.
struct Run {
  std::size_t buffer = 0, begin = 0, end = 0;
  std::size_t placed = 0;  ///< in the merged buffer
};

/// Merges all buffers into one that holds just the bytes that buffer views name.
std::vector<std::uint8_t> mergeBuffers(GltfDocument& document) {
  std::vector<Run> runs;
  const std::size_t views = document.list("bufferViews").size();
  std::vector<Run> of_view(views);
  for (std::size_t v = 0; v < views; ++v) {
    const auto bytes = viewBytes(document, v);
    const auto buffer =
        *readIndex(document, document.list("bufferViews")[v], "buffer", "buffers", "buffer view");
    const auto begin = static_cast<std::size_t>(bytes.data() - document.buffers[buffer].data());
    of_view[v] = {buffer, begin, begin + bytes.size(), 0};
  }
  runs = of_view;
  std::stable_sort(runs.begin(), runs.end(), [](const Run& a, const Run& b) {
    return a.buffer != b.buffer ? a.buffer < b.buffer : a.begin < b.begin;
  });
  std::vector<Run> merged;
  for (const Run& run : runs) {
    if (!merged.empty() && merged.back().buffer == run.buffer && run.begin <= merged.back().end)
      merged.back().end = std::max(merged.back().end, run.end);
    else
      merged.push_back(run);
  }
  std::vector<std::uint8_t> out;
  for (Run& run : merged) {
    // The alignment to 8 bytes that a view had, it keeps.
    while (out.size() % 8 != run.begin % 8) out.push_back(0);
    run.placed = out.size();
    const auto& bytes = document.buffers[run.buffer];
    out.insert(out.end(), bytes.begin() + static_cast<std::ptrdiff_t>(run.begin),
               bytes.begin() + static_cast<std::ptrdiff_t>(run.end));
  }
  for (std::size_t v = 0; v < views; ++v) {
    const Run& mine = of_view[v];
    const auto run =
        std::upper_bound(merged.begin(), merged.end(), mine, [](const Run& a, const Run& b) {
          return a.buffer != b.buffer ? a.buffer < b.buffer : a.begin < b.begin;
        });
    const Run& home = *std::prev(run);
    Json& json = document.json["bufferViews"][v];
    json["buffer"] = 0;
    json["byteOffset"] = home.placed + mine.begin - home.begin;
  }
  return out;
}

}  // namespace

std::size_t appendView(GltfDocument& document, std::vector<std::uint8_t> bytes, int target,
                       std::size_t stride, std::optional<std::size_t> reuse) {
  Json view = {{"buffer", document.buffers.size()}, {"byteLength", bytes.size()}};
  if (stride != 0) view["byteStride"] = stride;
  if (target != 0) view["target"] = target;
  listIn(document, "buffers").push_back({{"byteLength", bytes.size()}});
  document.buffers.push_back(std::move(bytes));
  Json& views = listIn(document, "bufferViews");
  if (reuse) {
    views[*reuse] = std::move(view);
    return *reuse;
  }
  views.push_back(std::move(view));
  return views.size() - 1;
}

std::vector<std::pair<fs::path, std::vector<std::uint8_t>>> encodeGltf(GltfDocument document,
                                                                       const fs::path& path) {
  const bool binary = path.extension() != ".gltf";
  std::vector<std::pair<fs::path, std::vector<std::uint8_t>>> files;
  placeImages(document, path, binary, files);
  std::vector<std::uint8_t> bin = mergeBuffers(document);
  if (bin.empty()) {
    document.json.erase("buffers");
  } else {
    Json buffer = Json::object();
    const Json& old = document.list("buffers")[0];
    for (const char* key : {"name", "extras"})
      if (member(old, key) != nullptr) buffer[key] = old[key];
    buffer["byteLength"] = bin.size();
    if (!binary) buffer["uri"] = percentEncoded(path.stem().string()) + ".bin";
    document.json["buffers"] = Json::array({buffer});
  }
  constexpr auto kReplace = Json::error_handler_t::replace;
  if (!binary) {
    const std::string json = document.json.dump(1, ' ', false, kReplace) + "\n";
    if (!bin.empty())
      files.emplace_back(path.parent_path() / (path.stem().string() + ".bin"), std::move(bin));
    files.emplace_back(path, std::vector<std::uint8_t>(json.begin(), json.end()));
    return files;
  }
  std::string json = document.json.dump(-1, ' ', false, kReplace);
  while (json.size() % 4 != 0) json += ' ';
  while (bin.size() % 4 != 0) bin.push_back(0);
  const std::size_t length = 12 + 8 + json.size() + (bin.empty() ? 0 : 8 + bin.size());
  if (length > 0xffffffffu)
    throw Error(path.string(), "would be larger than 4 GB", "write it as .gltf");
  std::vector<std::uint8_t> out;
  out.reserve(length);
  appendWord(out, 0x46546c67);  // "glTF"
  appendWord(out, 2);
  appendWord(out, length);
  appendWord(out, json.size());
  appendWord(out, 0x4e4f534a);  // "JSON"
  out.insert(out.end(), json.begin(), json.end());
  if (!bin.empty()) {
    appendWord(out, bin.size());
    appendWord(out, 0x004e4942);  // "BIN"
    out.insert(out.end(), bin.begin(), bin.end());
  }
  files.emplace_back(path, std::move(out));
  return files;
}

void writeGltf(GltfDocument document, const fs::path& path) {
  const auto files = encodeGltf(std::move(document), path);
  for (const auto& [file, bytes] : files)
    if (file.parent_path() != path.parent_path()) fs::create_directories(file.parent_path());
  writeFiles(files);
}

}  // namespace verdure
