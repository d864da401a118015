// PNG of 16 bits (ISO/IEC 15948), which stb_image_write does not write.
#include <zlib.h>

#include <cstdlib>
#include <limits>

#include "verdure/error.h"
#include "verdure/image.h"

namespace verdure {
namespace {

void append32(std::vector<std::uint8_t>& out, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8)
    out.push_back(static_cast<std::uint8_t>(value >> shift));
}

void appendChunk(std::vector<std::uint8_t>& out, const char* type,
                 const std::vector<std::uint8_t>& data) {
  append32(out, static_cast<std::uint32_t>(data.size()));
  const std::size_t begin = out.size();
  for (int i = 0; i < 4; ++i) out.push_back(static_cast<std::uint8_t>(type[i]));
  out.insert(out.end(), data.begin(), data.end());
  append32(out, static_cast<std::uint32_t>(
                    crc32(0, out.data() + begin, static_cast<uInt>(out.size() - begin))));
}

/// The one of left, up and up-left that is nearest to left + up - up-left.
std::uint8_t paeth(int left, int up, int corner) {
  const int p = left + up - corner;
  const int a = std::abs(p - left), b = std::abs(p - up), c = std::abs(p - corner);
  return static_cast<std::uint8_t>(a <= b && a <= c ? left : b <= c ? up : corner);
}

}  // namespace

std::vector<std::uint8_t> encodePng(const Image16& image) {
  const auto height = static_cast<std::size_t>(image.height);
  const std::size_t texel = 2 * static_cast<std::size_t>(image.channels);
  const std::size_t row = static_cast<std::size_t>(image.width) * texel;
  if ((row + 1) * height >= std::size_t{std::numeric_limits<int>::max()})
    throw Error("PNG", "the image has 2 GiB or more", "make it smaller");
  std::vector<std::uint8_t> above(row, 0), bytes(row), filtered;
  filtered.reserve((row + 1) * height);
  for (std::size_t y = 0; y < height; ++y) {
    const std::uint16_t* values = image.values.data() + y * (row / 2);
    for (std::size_t i = 0; i < row / 2; ++i) {
      bytes[2 * i] = static_cast<std::uint8_t>(values[i] >> 8);
      bytes[2 * i + 1] = static_cast<std::uint8_t>(values[i] & 255);
    }
    filtered.push_back(4);  // the Paeth filter
    for (std::size_t i = 0; i < row; ++i) {
      const bool first = i < texel;
      const std::uint8_t guess =
          paeth(first ? 0 : bytes[i - texel], above[i], first ? 0 : above[i - texel]);
      filtered.push_back(static_cast<std::uint8_t>(bytes[i] - guess));
    }
    above.swap(bytes);
  }
  uLongf size = compressBound(static_cast<uLong>(filtered.size()));
  std::vector<std::uint8_t> data(size);
  if (compress2(data.data(), &size, filtered.data(), static_cast<uLong>(filtered.size()), 6) !=
      Z_OK)
    throw Error("PNG", "the image cannot be compressed", "free some memory");
  data.resize(size);

  constexpr std::uint8_t kColorTypes[] = {0, 0, 4, 2, 6};
  std::vector<std::uint8_t> header;
  append32(header, static_cast<std::uint32_t>(image.width));
  append32(header, static_cast<std::uint32_t>(image.height));
  header.insert(header.end(), {16, kColorTypes[image.channels], 0, 0, 0});
  std::vector<std::uint8_t> out = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  appendChunk(out, "IHDR", header);
  appendChunk(out, "IDAT", data);
  appendChunk(out, "IEND", {});
  return out;
}

}  // namespace verdure
