#include <cmath>

#include "leaf/venation.h"

namespace verdure {

void setVeinWidths(std::vector<VeinNode>& nodes, float foot_radius, float exponent) {
  for (VeinNode& node : nodes) node.tips = 0;
  for (std::size_t i = nodes.size(); i-- > 0;) {
    VeinNode& node = nodes[i];
    if (node.tips == 0) node.tips = 1;  // an end: all children come after it
    if (node.parent >= 0) nodes[static_cast<std::size_t>(node.parent)].tips += node.tips;
  }
  const auto all = static_cast<float>(nodes.front().tips);
  for (VeinNode& node : nodes)
    node.radius = foot_radius * std::pow(static_cast<float>(node.tips) / all, 1 / exponent);
}

}  // namespace verdure
