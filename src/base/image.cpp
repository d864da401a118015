#include "verdure/image.h"

#include "base/files.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wunused-but-set-variable"
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_NO_STDIO
#include <stb_image.h>
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#include <stb_image_write.h>
#pragma GCC diagnostic pop

#include <algorithm>
#include <cstring>
#include <limits>

namespace verdure {

Image decodeImage(std::span<const std::uint8_t> file, const std::string& where) {
  if (file.size() > std::size_t{std::numeric_limits<int>::max()})
    throw Error(where, "image file over 2 GiB", "use a smaller image");
  int width = 0, height = 0, channels = 0;
  std::uint8_t* pixels = stbi_load_from_memory(file.data(), static_cast<int>(file.size()), &width,
                                               &height, &channels, 4);
  if (pixels == nullptr)
    throw Error(where, std::string("image cannot be decoded (") + stbi_failure_reason() + ")",
                "use PNG or JPEG");
  Image image(width, height);
  std::memcpy(image.rgba.data(), pixels, image.rgba.size());
  stbi_image_free(pixels);
  return image;
}

Image readImage(const std::filesystem::path& path) {
  return decodeImage(readFile(path), path.string());
}

Image16 decodeImage16(std::span<const std::uint8_t> file, const std::string& where) {
  if (file.size() > std::size_t{std::numeric_limits<int>::max()})
    throw Error(where, "image file over 2 GiB", "use a smaller image");
  Image16 image;
  std::uint16_t* values = stbi_load_16_from_memory(file.data(), static_cast<int>(file.size()),
                                                   &image.width, &image.height, &image.channels, 0);
  if (values == nullptr)
    throw Error(where, std::string("image cannot be decoded (") + stbi_failure_reason() + ")",
                "use PNG or JPEG");
  image.values.assign(values, values + static_cast<std::size_t>(image.width) *
                                           static_cast<std::size_t>(image.height) *
                                           static_cast<std::size_t>(image.channels));
  stbi_image_free(values);
  return image;
}

std::vector<std::uint8_t> encodePng(const Image& image) {
  // The encoder counts bytes in int.
  if (image.rgba.size() >= std::size_t{std::numeric_limits<int>::max()})
    throw Error("PNG", "the image has 2 GiB or more", "make it smaller");
  const std::size_t pixels = image.rgba.size() / 4;
  bool opaque = true;
  for (std::size_t i = 0; i < pixels && opaque; ++i) opaque = image.rgba[4 * i + 3] == 255;
  std::vector<std::uint8_t> rgb;
  if (opaque) {
    rgb.resize(pixels * 3);
    for (std::size_t i = 0; i < pixels; ++i) std::memcpy(&rgb[3 * i], &image.rgba[4 * i], 3);
  }
  const int channels = opaque ? 3 : 4;
  std::vector<std::uint8_t> bytes;
  const int written = stbi_write_png_to_func(
      [](void* out, void* data, int size) {
        auto& sink = *static_cast<std::vector<std::uint8_t>*>(out);
        const auto* begin = static_cast<const std::uint8_t*>(data);
        sink.insert(sink.end(), begin, begin + size);
      },
      &bytes, image.width, image.height, channels, opaque ? rgb.data() : image.rgba.data(),
      image.width * channels);
  if (written == 0) throw Error("PNG", "the image cannot be encoded", "make it smaller");
  return bytes;
}

void writePng(const Image& image, const std::filesystem::path& path) {
  if (image.empty()) throw Error(path.string(), "the image has no pixels", "give a size above 0");
  writeFile(path, encodePng(image));
}

}  // namespace verdure
