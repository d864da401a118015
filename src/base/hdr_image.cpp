#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <half.h>
#pragma GCC diagnostic pop

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/check.h"
#include "base/files.h"
#include "base/radiance_file.h"
#include "verdure/image.h"

namespace verdure {
namespace {

class MemoryInput final : public Imf::IStream {
 public:
  MemoryInput(std::span<const std::uint8_t> file, const std::string& name)
      : Imf::IStream(name.c_str()), file_(file) {}
  bool read(char out[], int count) override {
    const auto n = static_cast<std::uint64_t>(count);
    if (count < 0 || at_ > file_.size() || n > file_.size() - at_)
      throw std::runtime_error("the file is cut off");
    std::memcpy(out, file_.data() + at_, n);
    at_ += n;
    return at_ < file_.size();
  }
  std::uint64_t tellg() override { return at_; }
  void seekg(std::uint64_t to) override { at_ = to; }

 private:
  std::span<const std::uint8_t> file_;
  std::uint64_t at_ = 0;
};

class MemoryOutput final : public Imf::OStream {
 public:
  MemoryOutput() : Imf::OStream("memory") {}
  void write(const char data[], int count) override {
    const auto n = static_cast<std::size_t>(count);
    if (at_ + n > bytes.size()) bytes.resize(at_ + n);
    std::memcpy(bytes.data() + at_, data, n);
    at_ += n;
  }
  std::uint64_t tellp() override { return at_; }
  void seekp(std::uint64_t to) override { at_ = to; }

  std::vector<std::uint8_t> bytes;

 private:
  std::size_t at_ = 0;
};

struct Window {
  std::int64_t x = 0, y = 0, width = 0, height = 0;
  explicit Window(const Imath::Box2i& box)
      : x(box.min.x),
        y(box.min.y),
        width(std::int64_t{box.max.x} - box.min.x + 1),
        height(std::int64_t{box.max.y} - box.min.y + 1) {}
};

/// A size that lies is told before memory is taken: no coder of the format packs 2^14 pixels into a
/// byte.
void checkSize(const Window& window, std::size_t bytes) {
  constexpr std::int64_t kMostPixels = std::int64_t{1} << 28;
  if (window.width <= 0 || window.height <= 0) throw std::runtime_error("it has no pixels");
  if (window.width > kMostPixels || window.height > kMostPixels ||
      window.width * window.height > (std::int64_t{1} << 14) * static_cast<std::int64_t>(bytes) ||
      window.width * window.height > kMostPixels)
    throw std::runtime_error("its size does not fit the file, or is over 2^28 pixels");
}

/// Values for R, G, B of a pixel, or one for all where the image is grey.
std::vector<std::string> channelNames(const Imf::ChannelList& channels) {
  std::vector<std::string> names = {"R", "G", "B"};
  if (channels.findChannel("R") == nullptr && channels.findChannel("Y") != nullptr) {
    if (channels.findChannel("RY") != nullptr)
      throw std::runtime_error("its colours are luminance and chroma, not RGB");
    names = {"Y"};
  }
  for (const std::string& name : names) {
    const Imf::Channel* channel = channels.findChannel(name);
    if (channel == nullptr) throw std::runtime_error("it has no channel " + name);
    if (channel->xSampling != 1 || channel->ySampling != 1)
      throw std::runtime_error("its channel " + name + " is subsampled");
  }
  return names;
}

/// sRGB's primaries and D65, as the file says or by default.
void checkPrimaries(const Imf::Header& header) {
  if (!Imf::hasChromaticities(header)) return;
  const Imf::Chromaticities& file = Imf::chromaticities(header);
  const Imf::Chromaticities srgb;
  const auto differs = [](const Imath::V2f& a, const Imath::V2f& b) {
    return !((a - b).length() < 0.005f);
  };
  if (differs(file.red, srgb.red) || differs(file.green, srgb.green) ||
      differs(file.blue, srgb.blue) || differs(file.white, srgb.white))
    throw std::runtime_error("its colours have other primaries than sRGB's");
}

HdrImage decodeScanLines(std::span<const std::uint8_t> bytes, const std::string& where) {
  MemoryInput stream(bytes, where);
  Imf::InputFile file(stream);
  const Imf::Header& header = file.header();
  checkPrimaries(header);
  const Window data(header.dataWindow()), display(header.displayWindow());
  checkSize(data, bytes.size());
  checkSize(display, bytes.size());
  const std::vector<std::string> names = channelNames(header.channels());
  if (!file.isComplete()) throw std::runtime_error("the file is cut off");

  HdrImage read(static_cast<int>(data.width), static_cast<int>(data.height));
  Imf::FrameBuffer buffer;
  for (std::size_t c = 0; c < names.size(); ++c)
    buffer.insert(names[c], Imf::Slice::Make(Imf::FLOAT, &read.rgb[0][static_cast<int>(c)],
                                             header.dataWindow(), sizeof(glm::vec3),
                                             sizeof(glm::vec3) * static_cast<size_t>(data.width)));
  file.setFrameBuffer(buffer);
  file.readPixels(header.dataWindow().min.y, header.dataWindow().max.y);
  if (names.size() == 1)
    for (glm::vec3& p : read.rgb) p = glm::vec3(p.x);
  if (header.dataWindow() == header.displayWindow()) return read;

  HdrImage shown(static_cast<int>(display.width), static_cast<int>(display.height));
  for (int y = 0; y < shown.height; ++y)
    for (int x = 0; x < shown.width; ++x) {
      const std::int64_t from_x = display.x + x - data.x, from_y = display.y + y - data.y;
      if (from_x >= 0 && from_x < data.width && from_y >= 0 && from_y < data.height)
        shown.at(x, y) = read.at(static_cast<int>(from_x), static_cast<int>(from_y));
    }
  return shown;
}

HdrImage decodeExr(std::span<const std::uint8_t> file, const std::string& where) {
  try {
    return decodeScanLines(file, where);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& e) {
    throw Error(where, std::string("is no OpenEXR image that can be read (") + e.what() + ")",
                "export it again as RGB scan lines");
  }
}

/// Index of the first pixel that is not finite, or the number of pixels.
std::size_t firstNotFinite(const HdrImage& image) {
  const auto bad = std::find_if(image.rgb.begin(), image.rgb.end(), [](const glm::vec3& p) {
    return !(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
  });
  return static_cast<std::size_t>(bad - image.rgb.begin());
}

Error badPixel(const HdrImage& image, std::size_t index, const std::string& where,
               const std::string& what) {
  const auto width = static_cast<std::size_t>(image.width);
  return {
      where,
      "pixel " + std::to_string(index % width) + ", " + std::to_string(index / width) + " " + what,
      "mend or export it again"};
}

/// Throws for values that cannot be light; small negative ones become 0.
void checkLight(HdrImage& image, const std::string& where) {
  const std::size_t bad = firstNotFinite(image);
  if (bad != image.rgb.size()) throw badPixel(image, bad, where, "is NaN or infinite");
  double sum = 0.0;
  for (const glm::vec3& p : image.rgb) sum += double{p.x} + double{p.y} + double{p.z};
  const double least = -0.01 * std::max(sum, 0.0) / (3.0 * static_cast<double>(image.rgb.size()));
  for (std::size_t i = 0; i < image.rgb.size(); ++i) {
    glm::vec3& p = image.rgb[i];
    if (std::min({p.x, p.y, p.z}) < least) throw badPixel(image, i, where, "is negative");
    p = glm::max(p, 0.0f);
  }
}

}  // namespace

HdrImage decodeHdrImage(std::span<const std::uint8_t> file, const std::string& where) {
  const std::string kind = std::filesystem::path(where).extension().string();
  HdrImage image;
  if (kind == ".hdr" || kind == ".pic") {
    image = decodeRadiance(file, where);
  } else if (kind == ".exr") {
    image = decodeExr(file, where);
  } else {
    throw Error(where, "is no kind of HDR image that can be read", "use .exr, .hdr or .pic");
  }
  checkLight(image, where);
  return image;
}

HdrImage readHdrImage(const std::filesystem::path& path) {
  return decodeHdrImage(readFile(path), path.string());
}

HdrImage readExrMap(const std::filesystem::path& path) {
  HdrImage image = decodeExr(readFile(path), path.string());
  const std::size_t bad = firstNotFinite(image);
  if (bad != image.rgb.size()) throw badPixel(image, bad, path.string(), "is NaN or infinite");
  return image;
}

void writeExr(const HdrImage& image, const std::filesystem::path& path, ExrDepth depth) {
  if (image.empty()) throw Error(path.string(), "the image has no pixels", "give a size above 0");
  const std::size_t bad = firstNotFinite(image);
  if (bad != image.rgb.size()) throw badPixel(image, bad, path.string(), "is NaN or infinite");
  std::vector<half> halves;
  if (depth == ExrDepth::kHalf) {
    halves.reserve(3 * image.rgb.size());
    for (std::size_t i = 0; i < image.rgb.size(); ++i)
      for (int c = 0; c < 3; ++c) {
        const float value = image.rgb[i][c];
        if (std::abs(value) > 65504.0f)
          throw badPixel(image, i, path.string(), "is too large for a half");
        halves.emplace_back(value);
      }
  }
  Imf::Header header(image.width, image.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  Imf::FrameBuffer buffer;
  const bool is_half = depth == ExrDepth::kHalf;
  const Imf::PixelType type = is_half ? Imf::HALF : Imf::FLOAT;
  const std::size_t bytes = is_half ? sizeof(half) : sizeof(float);
  // The library's buffers are not const; a file that is written is not changed.
  char* channel = is_half ? reinterpret_cast<char*>(halves.data())
                          : reinterpret_cast<char*>(const_cast<float*>(&image.rgb[0].x));
  for (const char* name : {"R", "G", "B"}) {
    header.channels().insert(name, Imf::Channel(type));
    buffer.insert(name, Imf::Slice(type, channel, 3 * bytes,
                                   3 * bytes * static_cast<std::size_t>(image.width)));
    channel += bytes;
  }
  MemoryOutput stream;
  {
    Imf::OutputFile file(stream, header);  // completes the file when it goes
    file.setFrameBuffer(buffer);
    file.writePixels(image.height);
  }
  writeFile(path, stream.bytes);
}

std::vector<std::uint8_t> encodeExrBits(int width, int height,
                                        const std::vector<std::uint16_t>& rgba) {
  VERDURE_CHECK_EQ(rgba.size(),
                   4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  Imf::Header header(width, height);
  header.compression() = Imf::ZIP_COMPRESSION;
  Imf::FrameBuffer buffer;
  // The library's buffers are not const; a file that is written is not changed.
  char* channel = reinterpret_cast<char*>(const_cast<std::uint16_t*>(rgba.data()));
  for (const char* name : {"R", "G", "B", "A"}) {
    header.channels().insert(name, Imf::Channel(Imf::HALF));
    buffer.insert(name, Imf::Slice(Imf::HALF, channel, 4 * sizeof(std::uint16_t),
                                   4 * sizeof(std::uint16_t) * static_cast<std::size_t>(width)));
    channel += sizeof(std::uint16_t);
  }
  MemoryOutput stream;
  {
    Imf::OutputFile file(stream, header);  // completes the file when it goes
    file.setFrameBuffer(buffer);
    file.writePixels(height);
  }
  return std::move(stream.bytes);
}

}  // namespace verdure
