#include "base/radiance_file.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <string_view>

#include "verdure/error.h"

namespace verdure {
namespace {

using Rgbe = std::array<std::uint8_t, 4>;

class Reader {
 public:
  Reader(std::span<const std::uint8_t> file, const std::string& where)
      : rest_(file), where_(where) {}

  Error error(const std::string& what) const {
    return {where_, what, "export it again as a Radiance picture or OpenEXR"};
  }

  HdrImage picture() {
    const float scale = header();
    const auto [width, height] = resolution();
    // A run of 127 pixels takes 8 bytes at least: a size that lies is told before memory is taken.
    if (static_cast<std::size_t>(width) * static_cast<std::size_t>(height) > 64 * rest_.size())
      throw error("the file is cut off");
    HdrImage image(width, height);
    std::vector<Rgbe> row(static_cast<std::size_t>(width));
    for (int y = 0; y < height; ++y) {
      readRow(row);
      for (int x = 0; x < width; ++x) {
        const Rgbe& p = row[static_cast<std::size_t>(x)];
        const float unit = p[3] == 0 ? 0.0f : scale * std::ldexp(1.0f, p[3] - (128 + 8));
        image.at(x, y) = unit * glm::vec3(p[0], p[1], p[2]);
      }
    }
    return image;
  }

 private:
  std::uint8_t byte() {
    if (rest_.empty()) throw error("the file is cut off");
    const std::uint8_t b = rest_.front();
    rest_ = rest_.subspan(1);
    return b;
  }

  std::string_view line() {
    const std::string_view text(reinterpret_cast<const char*>(rest_.data()), rest_.size());
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos) throw error("its header has no end");
    rest_ = rest_.subspan(end + 1);
    return text.substr(0, end);
  }

  /// Returns what undoes the exposures that were applied to the pixels.
  float header() {
    if (!line().starts_with("#?")) throw error("is no Radiance picture");
    bool known_format = false;
    double exposure = 1.0;
    for (std::string_view l = line(); !l.empty() && l != "\r"; l = line()) {
      if (l.starts_with("FORMAT=")) known_format = l.find("32-bit_rle_rgbe") != l.npos;
      if (l.starts_with("EXPOSURE=")) {
        l.remove_prefix(std::strlen("EXPOSURE="));
        while (l.starts_with(' ')) l.remove_prefix(1);
        double value = 0.0;
        std::from_chars(l.data(), l.data() + l.size(), value);
        if (!(value > 0.0 && std::isfinite(value)))
          throw error("its EXPOSURE is no number above 0");
        exposure *= value;
      }
    }
    if (!known_format) throw error("its FORMAT is not 32-bit_rle_rgbe");
    return static_cast<float>(1.0 / exposure);
  }

  std::pair<int, int> resolution() {
    const std::string_view l = line();
    int width = 0, height = 0;
    const auto number = [](std::string_view text, int& out) {
      const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), out);
      return problem == std::errc() ? end : nullptr;
    };
    const std::size_t x = l.find(" +X ");
    if (!l.starts_with("-Y ") || x == l.npos || number(l.substr(3), height) == nullptr ||
        number(l.substr(x + 4), width) == nullptr)
      throw error("its rows do not run from the top and from the left (-Y height +X width)");
    if (width <= 0 || height <= 0) throw error("has no pixels");
    return {width, height};
  }

  void readRow(std::vector<Rgbe>& row) {
    const std::size_t width = row.size();
    const bool coded = width >= 8 && width < 32768 && rest_.size() >= 4 && rest_[0] == 2 &&
                       rest_[1] == 2 && rest_[2] < 128;
    if (!coded) return readFlatRow(row);
    rest_ = rest_.subspan(2);
    const std::size_t high = byte(), low = byte();
    if (high * 256 + low != width) throw error("a row has another width than the picture");
    for (std::size_t channel = 0; channel < 4; ++channel)
      for (std::size_t x = 0; x < width;) {
        std::size_t count = byte();
        const bool run = count > 128;
        if (run) count -= 128;
        if (count == 0 || count > width - x) throw error("a row's run goes past its end");
        const std::uint8_t value = run ? byte() : std::uint8_t{0};
        for (; count > 0; --count) row[x++][channel] = run ? value : byte();
      }
  }

  /// Pixels as they are; (1, 1, 1, n) repeats the one before n times, several in sequence count in
  /// base 256.
  void readFlatRow(std::vector<Rgbe>& row) {
    std::size_t shift = 0;
    for (std::size_t x = 0; x < row.size();) {
      Rgbe p;
      for (std::uint8_t& b : p) b = byte();
      if (p[0] != 1 || p[1] != 1 || p[2] != 1) {
        row[x++] = p;
        shift = 0;
        continue;
      }
      const std::size_t count = shift < 32 ? std::size_t{p[3]} << shift : row.size() + 1;
      if (x == 0 || count > row.size() - x) throw error("a row's run goes past its end");
      for (std::size_t i = 0; i < count; ++i, ++x) row[x] = row[x - 1];
      shift += 8;
    }
  }

  std::span<const std::uint8_t> rest_;
  const std::string& where_;
};

}  // namespace

HdrImage decodeRadiance(std::span<const std::uint8_t> file, const std::string& where) {
  return Reader(file, where).picture();
}

}  // namespace verdure
