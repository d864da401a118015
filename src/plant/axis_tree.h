#ifndef VERDURE_PLANT_AXIS_TREE_H_
#define VERDURE_PLANT_AXIS_TREE_H_

#include <functional>

#include "verdure/plant.h"

namespace verdure {

/// A branch beside a point.
struct AxisHit {
  std::uint32_t branch = kNone;
  float distance = 0.0f;  ///< to its axis, m
  float radius = 0.0f;    ///< of the branch there
  float along = 0.0f;     ///< m from its base along the axis
  /// From its surface; within it, still a little less for what is nearer to the axis.
  float gap() const { return std::max(distance - radius, 0.0f) + 1e-3f * distance; }
};

/// The segments of branches' axes in a tree of boxes.
class AxisTree {
 public:
  explicit AxisTree(const std::vector<Branch>& branches);

  /// The branch with the least gap() among those that `accept` takes (null: all); the lower number
  /// among equals. branch = kNone if there is none.
  AxisHit nearest(const glm::vec3& point,
                  const std::function<bool(std::uint32_t branch)>& accept = nullptr) const;
  /// Every branch whose gap() is at most `reach`, once, by number.
  std::vector<AxisHit> within(const glm::vec3& point, float reach) const;

 private:
  struct Segment {
    glm::vec3 a{0.0f}, b{0.0f};
    float radius_a = 0.0f, radius_b = 0.0f, start = 0.0f;
    std::uint32_t branch = 0;
  };
  struct Node {
    glm::vec3 low{0.0f}, high{0.0f};
    float radius = 0.0f;
    std::uint32_t begin = 0, end = 0;  ///< segments
    std::uint32_t right = 0;           ///< the left child follows its parent; 0: a leaf
  };
  void build(std::uint32_t begin, std::uint32_t end);
  float bound(const Node& node, const glm::vec3& point) const;
  static AxisHit hit(const Segment& segment, const glm::vec3& point);

  std::vector<Segment> segments_;
  std::vector<Node> nodes_;
};

}  // namespace verdure

#endif  // VERDURE_PLANT_AXIS_TREE_H_
