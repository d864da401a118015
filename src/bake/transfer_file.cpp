// The layout is described in docs/transfer.md.
#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstring>

#include "base/files.h"
#include "base/random.h"
#include "verdure/error.h"
#include "verdure/harmonics.h"
#include "verdure/transfer.h"

namespace verdure {
namespace {

static_assert(std::endian::native == std::endian::little, "the file is written as it lies");

constexpr char kMagic[8] = {'V', 'E', 'R', 'D', 'U', 'R', 'E', 'T'};
constexpr std::uint32_t kVersion = 1;
constexpr std::uint32_t kTwoSided = 1;  ///< flag of a mesh

struct Header {
  char magic[8] = {};
  std::uint32_t version = 0, bands = 0, bounce_bands = 0, meshes = 0;
  std::uint32_t ground_size = 0;
  float ground_x = 0, ground_z = 0, ground_step = 0, ground_height = 0;
  std::uint32_t reserved = 0;
};
static_assert(sizeof(Header) == 48);

struct MeshHeader {
  std::uint32_t vertices = 0, flags = 0;
  std::uint64_t indices_hash = 0;
  glm::vec3 low{0.0f}, high{0.0f};
};
static_assert(sizeof(MeshHeader) == 40);

MeshHeader describe(const Mesh& mesh) {
  MeshHeader h;
  h.vertices = static_cast<std::uint32_t>(mesh.positions.size());
  h.flags = mesh.kind == PartKind::kFoliage ? kTwoSided : 0;
  for (const std::uint32_t i : mesh.indices) h.indices_hash = hash(h.indices_hash ^ i);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    h.low = v == 0 ? mesh.positions[v] : glm::min(h.low, mesh.positions[v]);
    h.high = v == 0 ? mesh.positions[v] : glm::max(h.high, mesh.positions[v]);
  }
  return h;
}

bool samePlace(const MeshHeader& a, const MeshHeader& b) {
  const float tolerance = 1e-4f * (glm::length(b.high - b.low) + glm::length(b.low)) + 1e-6f;
  return glm::length(a.low - b.low) < tolerance && glm::length(a.high - b.high) < tolerance;
}

/// Reads the parts of a file in order; a short file is an Error.
class Reader {
 public:
  Reader(const std::string& name, const std::vector<std::uint8_t>& bytes)
      : name_(name), bytes_(bytes) {}
  template <class T>
  void read(T* values, std::size_t count) {
    if ((bytes_.size() - at_) / sizeof(T) < count) refuse("ends too early");
    if (count > 0) std::memcpy(values, bytes_.data() + at_, count * sizeof(T));
    at_ += count * sizeof(T);
  }
  void halves(std::vector<std::uint16_t>& values, std::size_t count) {
    if ((bytes_.size() - at_) / sizeof(std::uint16_t) < count) refuse("ends too early");
    values.resize(count);
    read(values.data(), count);
    for (const std::uint16_t h : values)
      if ((h & 0x7c00u) == 0x7c00u) refuse("holds numbers that are not finite");
  }
  bool atEnd() const { return at_ == bytes_.size(); }
  [[noreturn]] void refuse(const std::string& what) const {
    throw Error(name_, what, "bake the transfer again");
  }

 private:
  const std::string& name_;
  const std::vector<std::uint8_t>& bytes_;
  std::size_t at_ = 0;
};

}  // namespace

std::filesystem::path transferPath(const std::filesystem::path& plant_file) {
  std::filesystem::path path = plant_file;
  return path.replace_extension(".transfer");
}

void saveTransfer(const PlantTransfer& transfer, const Plant& plant,
                  const std::filesystem::path& plant_file) {
  if (transfer.meshes.size() != plant.meshes.size())
    throw Error(plant.name, "the transfer belongs to another plant", "bake this plant");
  std::vector<std::uint8_t> bytes;
  const auto put = [&bytes](const auto* values, std::size_t count) {
    const auto* raw = reinterpret_cast<const std::uint8_t*>(values);
    bytes.insert(bytes.end(), raw, raw + count * sizeof(*values));
  };
  Header header;
  std::memcpy(header.magic, kMagic, sizeof(kMagic));
  header.version = kVersion;
  header.bands = static_cast<std::uint32_t>(transfer.bands);
  header.bounce_bands = static_cast<std::uint32_t>(transfer.bounce_bands);
  header.meshes = static_cast<std::uint32_t>(transfer.meshes.size());
  header.ground_size = static_cast<std::uint32_t>(transfer.ground.size);
  header.ground_x = transfer.ground.corner.x;
  header.ground_z = transfer.ground.corner.y;
  header.ground_step = transfer.ground.step;
  header.ground_height = transfer.ground.height;
  put(&header, 1);
  for (std::size_t m = 0; m < plant.meshes.size(); ++m) {
    MeshHeader mesh = describe(plant.meshes[m]);
    mesh.flags = transfer.meshes[m].back.empty() ? 0 : kTwoSided;
    put(&mesh, 1);
  }
  const auto putVectors = [&](const TransferVectors& v) {
    for (const auto* part : {&v.front, &v.back, &v.front_bounced, &v.back_bounced})
      put(part->data(), part->size());
  };
  for (const TransferVectors& mesh : transfer.meshes) putVectors(mesh);
  putVectors(transfer.ground.vectors);
  writeFile(transferPath(plant_file), bytes);
}

std::optional<PlantTransfer> loadTransfer(const std::filesystem::path& plant_file,
                                          const Plant& plant) {
  const std::filesystem::path path = transferPath(plant_file);
  if (!std::filesystem::exists(path)) return std::nullopt;
  const std::string name = path.string();
  const std::vector<std::uint8_t> bytes = readFile(path);
  Reader reader(name, bytes);
  Header header;
  if (bytes.size() < sizeof(header) || std::memcmp(bytes.data(), kMagic, sizeof(kMagic)) != 0)
    throw Error(name, "is no transfer file", "write it with verdure bake --transfer");
  reader.read(&header, 1);
  if (header.version != kVersion)
    reader.refuse(fmt::format("has version {}, not {}", header.version, kVersion));
  if (header.bands < 2 || header.bands > kMaxBands || header.bounce_bands > 3 ||
      header.ground_size > 1024 || header.ground_size == 1)
    reader.refuse("has a damaged header");
  for (const float f : {header.ground_x, header.ground_z, header.ground_step, header.ground_height})
    if (!std::isfinite(f)) reader.refuse("has a damaged header");
  if (header.ground_size > 0 && !(header.ground_step > 0.0f)) reader.refuse("has a damaged header");
  bool fits = header.meshes == plant.meshes.size();
  std::vector<MeshHeader> meshes(fits ? header.meshes : 0);
  reader.read(meshes.data(), meshes.size());
  for (std::size_t m = 0; fits && m < meshes.size(); ++m) {
    const MeshHeader own = describe(plant.meshes[m]);
    fits = meshes[m].vertices == own.vertices && meshes[m].flags == own.flags &&
           meshes[m].indices_hash == own.indices_hash && samePlace(meshes[m], own);
  }
  if (!fits) reader.refuse("belongs to another plant, or one with other parts as foliage");

  PlantTransfer transfer;
  transfer.bands = static_cast<int>(header.bands);
  transfer.bounce_bands = static_cast<int>(header.bounce_bands);
  const std::size_t all = 3 * std::size_t{header.bands} * header.bands;
  const std::size_t bounced = 3 * std::size_t{header.bounce_bands} * header.bounce_bands;
  const auto readVectors = [&](TransferVectors& v, std::size_t vertices, bool two_sided) {
    reader.halves(v.front, vertices * all);
    reader.halves(v.back, two_sided ? vertices * all : 0);
    reader.halves(v.front_bounced, vertices * bounced);
    reader.halves(v.back_bounced, two_sided ? vertices * bounced : 0);
  };
  for (const MeshHeader& mesh : meshes)
    readVectors(transfer.meshes.emplace_back(), mesh.vertices, (mesh.flags & kTwoSided) != 0);
  GroundTransfer& ground = transfer.ground;
  ground.size = static_cast<int>(header.ground_size);
  ground.corner = {header.ground_x, header.ground_z};
  ground.step = header.ground_step;
  ground.height = header.ground_height;
  readVectors(ground.vectors, std::size_t{header.ground_size} * header.ground_size, false);
  if (!reader.atEnd()) reader.refuse("is longer than it should be");
  return transfer;
}

}  // namespace verdure
