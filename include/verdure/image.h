#ifndef VERDURE_IMAGE_H_
#define VERDURE_IMAGE_H_

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

namespace verdure {

/// 8-bit RGBA image, rows from the top. Whether the colours are sRGB or linear is the user's to
/// know (base colour: sRGB; normal maps: linear).
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgba;  ///< width * height * 4

  Image() = default;
  Image(int w, int h)
      : width(w), height(h), rgba(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) * 4) {}

  bool empty() const { return rgba.empty(); }
  std::uint8_t* at(int x, int y) {
    return rgba.data() + (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                          static_cast<std::size_t>(x)) *
                             4;
  }
  const std::uint8_t* at(int x, int y) const { return const_cast<Image*>(this)->at(x, y); }
};

/// Linear RGB in floats, rows from the top, not bound to 1.
struct HdrImage {
  int width = 0;
  int height = 0;
  std::vector<glm::vec3> rgb;  ///< width * height

  HdrImage() = default;
  HdrImage(int w, int h)
      : width(w), height(h), rgb(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}

  bool empty() const { return rgb.empty(); }
  glm::vec3& at(int x, int y) {
    return rgb[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
               static_cast<std::size_t>(x)];
  }
  const glm::vec3& at(int x, int y) const { return const_cast<HdrImage*>(this)->at(x, y); }
};

/// Decodes PNG or JPEG. Throws Error naming `where`.
Image decodeImage(std::span<const std::uint8_t> file, const std::string& where);

/// Reads a PNG or JPEG file. Throws Error.
Image readImage(const std::filesystem::path& path);

/// Encodes as PNG (RGB when every alpha is 255, else RGBA). Throws Error for 2 GiB or more.
std::vector<std::uint8_t> encodePng(const Image& image);

/// Writes a PNG atomically (temporary file, then rename). Throws Error.
void writePng(const Image& image, const std::filesystem::path& path);

}  // namespace verdure

#endif  // VERDURE_IMAGE_H_
