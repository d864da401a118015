#ifndef VERDURE_MOTION_SPECTRUM_H_
#define VERDURE_MOTION_SPECTRUM_H_

#include <cmath>
#include <complex>
#include <cstddef>
#include <functional>
#include <glm/gtc/constants.hpp>
#include <vector>

namespace verdure {

/// Mean periodogram of signals under Hann's window, at bins 0 to `bins` - 1 of 1 / (count * step)
/// each.
class Spectrum {
 public:
  Spectrum(int count, int bins) : power(static_cast<std::size_t>(bins)), count_(count) {
    for (int i = 0; i < count; ++i) {
      const double turn = 2.0 * glm::pi<double>() * i / count;
      window_.push_back(0.5 - 0.5 * std::cos(turn));
      turns_.push_back(std::polar(1.0, turn));
    }
  }
  void add(const std::function<double(int i)>& signal) {
    std::vector<double> values;
    for (int i = 0; i < count_; ++i)
      values.push_back(signal(i) * window_[static_cast<std::size_t>(i)]);
    for (std::size_t bin = 0; bin < power.size(); ++bin) {
      std::complex<double> sum = 0.0;
      for (std::size_t i = 0; i < values.size(); ++i)
        sum += values[i] * turns_[i * bin % values.size()];
      power[bin] += std::norm(sum);
    }
  }
  /// Sum of the differences to another spectrum, both of sum 1, from bin 1 on.
  double errorTo(const std::function<double(std::size_t bin)>& truth) const {
    double sum = 0.0, true_sum = 0.0, error = 0.0;
    for (std::size_t bin = 1; bin < power.size(); ++bin) {
      sum += power[bin];
      true_sum += truth(bin);
    }
    for (std::size_t bin = 1; bin < power.size(); ++bin)
      error += std::abs(power[bin] / sum - truth(bin) / true_sum);
    return error;
  }
  std::vector<double> power;

 private:
  int count_;
  std::vector<double> window_;
  std::vector<std::complex<double>> turns_;
};

}  // namespace verdure

#endif  // VERDURE_MOTION_SPECTRUM_H_
