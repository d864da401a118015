#ifndef VERDURE_APP_PLOT_H_
#define VERDURE_APP_PLOT_H_

#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace verdure::app {

/// Curves over two axes, as an SVG picture.
class Plot {
 public:
  struct Axis {
    double low = 0.0, high = 1.0;
    std::string label;
    bool log = false;  ///< decades
  };
  Plot(Axis x, Axis y, int width = 560, int height = 380);

  /// A curve, with its name in the key unless that is empty. What is off the axes is cut off.
  void curve(const std::string& name, const std::vector<glm::dvec2>& points, bool dashed = false);
  std::string svg() const;

 private:
  double across(const Axis& axis, double value) const;
  glm::dvec2 place(const glm::dvec2& point) const;

  Axis x_, y_;
  int width_, height_;
  std::string body_, key_;
  int curves_ = 0, keys_ = 0;
};

}  // namespace verdure::app

#endif  // VERDURE_APP_PLOT_H_
