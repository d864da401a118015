#include "leaf/texel_kernel.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

namespace verdure {
namespace {

constexpr int kNodes = 8;
/// Gauss-Legendre on [-1, 1], the positive half.
constexpr double kNode[] = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
                            0.9602898564975363};
constexpr double kWeight[] = {0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
                              0.1012285362903763};
constexpr double kNode3[] = {-0.7745966692414834, 0.0, 0.7745966692414834};
constexpr double kWeight3[] = {5.0 / 9.0, 8.0 / 9.0, 5.0 / 9.0};

}  // namespace

double texelShare(const Multipole& multipole, double texel, int dx, int dy, double thickness) {
  dx = std::abs(dx);
  dy = std::abs(dy);
  if (std::max(dx, dy) > 4) {
    double sum = 0.0;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        sum += kWeight3[i] * kWeight3[j] *
               multipole.transmittance(
                   texel * std::hypot(dx + 0.5 * kNode3[i], dy + 0.5 * kNode3[j]), thickness);
    return sum * texel * texel / 4.0;
  }
  // Near the middle T may be a spike far narrower than the texel. It is the divergence of
  // -beyond(r) / (2 pi r^2) (x, y), whose flux through the texel's edges is smooth.
  const auto edge = [&](double across, double from) {
    double sum = 0.0;
    for (int k = 0; k < kNodes; ++k) {
      const double node = k % 2 == 0 ? kNode[k / 2] : -kNode[k / 2];
      const double along = from + 0.5 * texel * (1.0 + node);
      const double r2 = across * across + along * along;
      sum += kWeight[k / 2] * across / r2 * multipole.beyond(std::sqrt(r2), thickness);
    }
    return sum * 0.5 * texel / (2.0 * std::numbers::pi);
  };
  const double left = texel * (dx - 0.5), right = texel * (dx + 0.5);
  const double low = texel * (dy - 0.5), high = texel * (dy + 0.5);
  const double share = edge(left, low) - edge(right, low) + edge(low, left) - edge(high, left);
  return dx == 0 && dy == 0 ? share + multipole.total(thickness) : share;
}

ThicknessGrid::ThicknessGrid(const Multipole& multipole, double least, double most)
    : free_path_(multipole.meanFreePath()), start_(std::log(least - free_path_)), step_(0.0) {
  constexpr double kStep = 0.015;  // linear interpolation is then within 1.2e-4 of T
  const double range = std::log(most - free_path_) - start_;
  size_ = 1 + static_cast<int>(std::ceil(range / kStep - 1e-9));
  if (size_ > 1) step_ = range / (size_ - 1);
}

double ThicknessGrid::thickness(int index) const {
  return free_path_ + std::exp(start_ + step_ * index);
}

float ThicknessGrid::place(float thickness_mm) const {
  if (size_ == 1) return 0.0f;
  const double above = std::max(double{thickness_mm} - free_path_, 1e-9);
  const double place = (std::log(above) - start_) / step_;
  return static_cast<float>(std::clamp(place, 0.0, static_cast<double>(size_ - 1)));
}

double kernelRadius(const Multipole& multipole, double least, double most) {
  const double threshold = std::min(1e-6, 1e-3 * multipole.transmittance(0.0, least));
  const double step = 0.02 / multipole.decay();
  double radius = step;
  for (const double d : {least, most})
    for (double r = step; r < 60.0 / multipole.decay(); r += step)
      if (std::abs(multipole.transmittance(r, d)) > threshold) radius = std::max(radius, r + step);
  return radius;
}

}  // namespace verdure
