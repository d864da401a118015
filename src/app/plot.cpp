#include "app/plot.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "app/page.h"

namespace verdure::app {
namespace {

constexpr int kLeftMargin = 64, kRightMargin = 16, kTopMargin = 16, kBottomMargin = 46;
constexpr std::array<const char*, 6> kColors{"#1b7837", "#762a83", "#d95f02",
                                             "#2166ac", "#999999", "#b2182b"};

/// A step of 1, 2 or 5 times a power of ten that makes about five of the range.
double roundStep(double range) {
  const double power = std::pow(10.0, std::floor(std::log10(range / 5.0)));
  const double share = range / 5.0 / power;
  return power * (share < 1.5 ? 1.0 : share < 3.5 ? 2.0 : share < 7.5 ? 5.0 : 10.0);
}

}  // namespace

Plot::Plot(Axis x, Axis y, int width, int height)
    : x_(std::move(x)), y_(std::move(y)), width_(width), height_(height) {
  const auto ticks = [&](const Axis& axis, const auto& draw) {
    if (axis.log) {
      for (double t = std::pow(10.0, std::ceil(std::log10(axis.low) - 1e-9));
           t <= axis.high * 1.0001; t *= 10.0)
        draw(t);
    } else {
      const double step = roundStep(axis.high - axis.low);
      for (double t = std::ceil(axis.low / step - 1e-9) * step; t <= axis.high + 1e-9; t += step)
        draw(std::abs(t) < 1e-12 ? 0.0 : t);
    }
  };
  ticks(x_, [&](double t) {
    const double at = place({t, y_.low}).x;
    body_ += fmt::format(
        "<path d='M{0:.1f} {1}V{2}' stroke='#ddd'/><text x='{0:.1f}' y='{3}' font-size='12' "
        "text-anchor='middle'>{4:g}</text>",
        at, kTopMargin, height_ - kBottomMargin, height_ - kBottomMargin + 18, t);
  });
  ticks(y_, [&](double t) {
    const double at = place({x_.low, t}).y;
    body_ += fmt::format(
        "<path d='M{0} {1:.1f}H{2}' stroke='#ddd'/><text x='{3}' y='{4:.1f}' font-size='12' "
        "text-anchor='end'>{5:g}</text>",
        kLeftMargin, at, width_ - kRightMargin, kLeftMargin - 6, at + 4, t);
  });
  body_ += fmt::format("<text x='{}' y='{}' font-size='13' text-anchor='middle'>{}</text>",
                       (kLeftMargin + width_ - kRightMargin) / 2, height_ - 8, x_.label);
  body_ += fmt::format(
      "<text transform='translate(14 {}) rotate(-90)' font-size='13' "
      "text-anchor='middle'>{}</text>",
      (kTopMargin + height_ - kBottomMargin) / 2, y_.label);
}

double Plot::across(const Axis& axis, double value) const {
  return axis.log ? std::log(value / axis.low) / std::log(axis.high / axis.low)
                  : (value - axis.low) / (axis.high - axis.low);
}

glm::dvec2 Plot::place(const glm::dvec2& point) const {
  return {kLeftMargin + across(x_, point.x) * (width_ - kLeftMargin - kRightMargin),
          height_ - kBottomMargin - across(y_, point.y) * (height_ - kTopMargin - kBottomMargin)};
}

void Plot::curve(const std::string& name, const std::vector<glm::dvec2>& points, bool dashed) {
  const char* color = kColors[static_cast<std::size_t>(curves_) % kColors.size()];
  std::string path;
  bool pen_down = false;
  for (const glm::dvec2& point : points) {
    const auto inside = [](const Axis& axis, double v) {
      const double slack = axis.log ? 0.0 : 1e-9 * (axis.high - axis.low);
      return v >= axis.low - slack && v <= axis.high + slack;
    };
    if (!inside(x_, point.x) || !inside(y_, point.y)) {
      pen_down = false;
      continue;
    }
    const glm::dvec2 at = place(point);
    path += fmt::format("{}{:.1f} {:.1f}", pen_down ? "L" : "M", at.x, at.y);
    pen_down = true;
  }
  const char* dashes = dashed ? " stroke-dasharray='6 4'" : "";
  body_ += fmt::format("<path d='{}' fill='none' stroke='{}' stroke-width='1.8'{}/>", path, color,
                       dashes);
  ++curves_;
  if (name.empty()) return;
  const int y = kTopMargin + 18 * (++keys_);
  key_ += fmt::format(
      "<path d='M{0} {1}h26' stroke='{2}' stroke-width='2'{3}/><text x='{4}' y='{5}' "
      "font-size='12'>{6}</text>",
      kLeftMargin + 12, y - 4, color, dashes, kLeftMargin + 44, y, name);
}

std::string Plot::svg() const {
  return svgOpen(width_, height_) + body_ + key_ + "</svg>\n";
}

}  // namespace verdure::app
