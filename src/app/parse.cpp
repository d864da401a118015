#include "app/parse.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "verdure/error.h"

namespace verdure::app {

std::vector<float> parseNumbers(const std::string& option, const std::string& text,
                                std::size_t count) {
  std::vector<float> numbers;
  const char *at = text.data(), *const end = text.data() + text.size();
  for (;;) {
    float value = 0.0f;
    const auto [next, problem] = std::from_chars(at, end, value);
    if (problem != std::errc() || !std::isfinite(value) || (next != end && *next != ','))
      throw Error(option,
                  fmt::format("'{}' is no {}", text, count == 1 ? "number" : "list of numbers"),
                  count == 1 ? "write one like 2.5" : "separate them by commas");
    numbers.push_back(value);
    if (next == end) break;
    at = next + 1;
  }
  if (count != 0 && numbers.size() != count)
    throw Error(option, fmt::format("'{}' has {} numbers", text, numbers.size()),
                fmt::format("write {}", count));
  return numbers;
}

std::pair<int, int> parseSize(const std::string& text) {
  const std::size_t x = text.find('x');
  int width = 0, height = 0;
  const auto read = [](const std::string& part, int& out) {
    const auto [end, problem] = std::from_chars(part.data(), part.data() + part.size(), out);
    return problem == std::errc() && end == part.data() + part.size();
  };
  if (x == std::string::npos || !read(text.substr(0, x), width) ||
      !read(text.substr(x + 1), height))
    throw Error("--size", fmt::format("'{}' is no size", text), "write 960x720");
  if (width <= 0 || height <= 0)
    throw Error("--size", fmt::format("'{}' has no pixels", text), "write 960x720");
  return {width, height};
}

}  // namespace verdure::app
