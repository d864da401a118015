#ifndef VERDURE_PLANT_AXIS_FIT_H_
#define VERDURE_PLANT_AXIS_FIT_H_

#include <utility>
#include <vector>

#include "verdure/plant.h"

namespace verdure {

float axisLength(const std::vector<BranchPoint>& axis);

/// Where a point is along an axis, m from its base, and how far away from it.
std::pair<float, float> placeOnAxis(const std::vector<BranchPoint>& axis, const glm::vec3& point);

/// The point of an axis `along` metres from its base.
glm::vec3 pointOnAxis(const std::vector<BranchPoint>& axis, float along);

/// The radius of an axis there.
float radiusOnAxis(const std::vector<BranchPoint>& axis, float along);

/// Sets the radii of an axis from its bark: (place along it, distance from it) of each of its
/// points, in any order. Rings give their median, what lies between them is on straight lines.
void fitRadii(std::vector<std::pair<float, float>> samples, std::vector<BranchPoint>& axis);

/// Leaves out points without which axis and radius stay within 4 % of the radius.
void simplifyAxis(std::vector<BranchPoint>& axis);

}  // namespace verdure

#endif  // VERDURE_PLANT_AXIS_FIT_H_
