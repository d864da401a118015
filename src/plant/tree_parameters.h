#ifndef VERDURE_PLANT_TREE_PARAMETERS_H_
#define VERDURE_PLANT_TREE_PARAMETERS_H_

#include <array>
#include <string>
#include <vector>

#include "verdure/grow.h"

namespace verdure {

/// Parameters of one level of stems, in the units of Weber and Penn 1995 (degrees, metres). Whole
/// numbers are kept as floats: all parameters are read, checked and printed in one way.
struct LevelParameters {
  float down_angle = 0, down_angle_v = 0;
  float rotate = 0, rotate_v = 0;
  float branches = 0;
  float length = 1, length_v = 0;
  float taper = 1;
  float seg_splits = 0, split_angle = 0, split_angle_v = 0;
  float curve_res = 1, curve = 0, curve_back = 0, curve_v = 0;
};

struct TreeParameters {
  float shape = 0;
  float base_size = 0.25f;
  float scale = 10, scale_v = 0;
  float z_scale = 1, z_scale_v = 0;
  float levels = 3;
  float ratio = 0.015f, ratio_power = 1.2f;
  float lobes = 0, lobe_depth = 0;
  float flare = 0;
  float scale0 = 1, scale0_v = 0;
  float base_splits = 0;
  std::array<LevelParameters, 4> level;
  float leaves = 0, leaf_shape = 0;
  float leaf_scale = 0.1f, leaf_scale_x = 1;
  float leaf_bend = 0.3f, leaf_distrib = 4, leaf_quality = 1;
  float leaf_by_length = 0;  ///< not of the paper: see weber_penn.cpp, leavesOf
  float attraction_up = 0;
  float prune_ratio = 0, prune_width = 0.5f, prune_width_peak = 0.5f;
  float prune_power_low = 0.5f, prune_power_high = 0.5f;

  const LevelParameters& at(int n) const { return level[static_cast<std::size_t>(n < 3 ? n : 3)]; }
};

/// Sets the parameter `name` (the paper's, such as "1CurveV") from text. Throws Error naming the
/// parameter and the closest valid name, or the range.
void setParameter(TreeParameters& parameters, const std::string& name, const std::string& value);

/// Applies a table such as "Shape=7 BaseSize=0.4 1CurveV=50".
void setParameters(TreeParameters& parameters, const std::string& table);

/// All parameters with their values, in the order of the paper's tables.
std::vector<ParameterInfo> listParameters(const TreeParameters& parameters);

/// The word of `words` that is the fewest edits away from `word` (case does not count).
std::string closestWord(const std::string& word, const std::vector<std::string>& words);

}  // namespace verdure

#endif  // VERDURE_PLANT_TREE_PARAMETERS_H_
