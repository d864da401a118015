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

/// Maps of numbers: `channels` values for each texel side by side, rows from the top.
struct Image16 {
  int width = 0;
  int height = 0;
  int channels = 0;                   ///< 1 grey, 2 grey and alpha, 3 RGB, 4 RGBA
  std::vector<std::uint16_t> values;  ///< width * height * channels
};

/// [0, 1] to a byte, rounded; what lies outside is clamped.
inline std::uint8_t toByte(float value) {
  return static_cast<std::uint8_t>(glm::clamp(value, 0.0f, 1.0f) * 255.0f + 0.5f);
}

/// Decodes PNG or JPEG. Throws Error naming `where`.
Image decodeImage(std::span<const std::uint8_t> file, const std::string& where);

/// Reads a PNG or JPEG file. Throws Error.
Image readImage(const std::filesystem::path& path);

/// Decodes PNG of 8 or 16 bits, or JPEG, with the channels that the file has; a byte v becomes 257
/// v, so that 65535 is white. Throws Error naming `where`.
Image16 decodeImage16(std::span<const std::uint8_t> file, const std::string& where);

/// Encodes as PNG of 16 bits. Throws Error for 2 GiB or more.
std::vector<std::uint8_t> encodePng(const Image16& image);

/// Encodes as PNG (RGB when every alpha is 255, else RGBA). Throws Error for 2 GiB or more.
std::vector<std::uint8_t> encodePng(const Image& image);

/// Writes a PNG atomically (temporary file, then rename). Throws Error.
void writePng(const Image& image, const std::filesystem::path& path);

/// Reads an OpenEXR (.exr: R, G, B or Y of the first part's display window; half, float or uint;
/// black outside the data window) or a Radiance picture (.hdr, .pic: RGBE, flat or run-length
/// coded; its EXPOSURE is undone). Alpha is ignored. Negative values down to a hundredth of the
/// image's mean are noise and become 0. Throws Error for files that are truncated, malformed or of
/// another kind (layers, deep or subsampled pixels, colours of other primaries than sRGB's), and
/// names the pixel for values that are NaN, infinite or below that.
HdrImage readHdrImage(const std::filesystem::path& path);

/// The same from a file's bytes; `where` names it and its kind (.exr, .hdr, .pic).
HdrImage decodeHdrImage(std::span<const std::uint8_t> file, const std::string& where);

/// Reads an OpenEXR file as readHdrImage does, whose values are no light and may be negative.
HdrImage readExrMap(const std::filesystem::path& path);

enum class ExrDepth { kFloat, kHalf };

/// Writes an OpenEXR file of 32-bit floats (what is measured against a reference must not end at
/// the 11 bits of a half) or of halves (maps for shaders), ZIP compressed: lossless. Atomic as
/// writePng. Throws Error, also for an image without pixels or of pixels that are not finite or, in
/// halves, beyond 65504.
void writeExr(const HdrImage& image, const std::filesystem::path& path,
              ExrDepth depth = ExrDepth::kFloat);

/// Encodes halves that are given by their bits, RGBA and rows from the top, as OpenEXR, ZIP
/// compressed. Bits are kept whatever number they are: textures of data use them as integers.
std::vector<std::uint8_t> encodeExrBits(int width, int height,
                                        const std::vector<std::uint16_t>& rgba);

}  // namespace verdure

#endif  // VERDURE_IMAGE_H_
