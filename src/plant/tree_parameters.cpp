#include "plant/tree_parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <sstream>

#include "plant/leaf_shape.h"
#include "verdure/error.h"

namespace verdure {
namespace {

struct Range {
  float low, high;
  bool whole = false;
};

struct TreeEntry {
  const char* name;
  float TreeParameters::*member;
  Range range;
  const char* help;
};

struct LevelEntry {
  const char* name;  ///< without the number of the level
  float LevelParameters::*member;
  Range range;
  const char* help;
  int first_level;
};

using T = TreeParameters;
using L = LevelParameters;

const TreeEntry kTreeHead[] = {
    {"Shape",
     &T::shape,
     {0, 8, true},
     "general tree shape: 0 conical, 1 spherical, 2 "
     "hemispherical, 3 cylindrical, 4 tapered cylindrical, 5 flame, 6 inverse conical, 7 tend "
     "flame, 8 pruning envelope"},
    {"BaseSize", &T::base_size, {0, 0.95f}, "branchless part of the trunk, fraction"},
    {"Scale", &T::scale, {0.05f, 200}, "height of the tree, m"},
    {"ScaleV", &T::scale_v, {0, 100}, "variation of Scale, m"},
    {"ZScale", &T::z_scale, {0.05f, 20}, "vertical stretch of the stems, factor"},
    {"ZScaleV", &T::z_scale_v, {0, 10}, "variation of ZScale"},
    {"Levels", &T::levels, {1, 4, true}, "levels of stems, the trunk included; leaves come on top"},
    {"Ratio", &T::ratio, {0.0005f, 0.5f}, "trunk radius by its length"},
    {"RatioPower", &T::ratio_power, {0.1f, 10}, "how fast radii fall with the length of stems"},
    {"Lobes", &T::lobes, {0, 40, true}, "bulges around the trunk, count"},
    {"LobeDepth", &T::lobe_depth, {0, 0.9f}, "depth of the bulges, fraction of the radius"},
    {"Flare", &T::flare, {0, 10}, "widening of the trunk at the ground, fraction of the radius"},
    {"0Scale", &T::scale0, {0.05f, 20}, "scale of the trunk's radius"},
    {"0ScaleV", &T::scale0_v, {0, 10}, "variation of 0Scale"},
    {"0BaseSplits", &T::base_splits, {0, 30, true}, "clones of the trunk at its first segment"},
};

const LevelEntry kLevel[] = {
    {"DownAngle", &L::down_angle, {-180, 180}, "angle from the parent, degrees", 1},
    {"DownAngleV",
     &L::down_angle_v,
     {-180, 180},
     "variation, degrees; negative: changes along the parent",
     1},
    {"Rotate",
     &L::rotate,
     {-360, 360},
     "turn around the parent from stem to stem, degrees; negative: alternating sides",
     1},
    {"RotateV", &L::rotate_v, {-360, 360}, "variation, degrees", 1},
    {"Branches", &L::branches, {0, 2000}, "stems on a parent, at most", 1},
    {"Length", &L::length, {0, 20}, "length, fraction of the parent's", 0},
    {"LengthV", &L::length_v, {0, 10}, "variation of Length", 0},
    {"Taper",
     &L::taper,
     {0, 3},
     "0 cylinder, 1 cone, 2 rounded end, 3 row of spheres; between: mixtures",
     0},
    {"SegSplits", &L::seg_splits, {0, 10}, "clones at each segment, on average", 0},
    {"SplitAngle", &L::split_angle, {0, 180}, "angle of a split, degrees", 0},
    {"SplitAngleV", &L::split_angle_v, {0, 180}, "variation, degrees", 0},
    {"CurveRes", &L::curve_res, {1, 100, true}, "segments of a stem", 0},
    {"Curve", &L::curve, {-1440, 1440}, "bend from base to tip, degrees", 0},
    {"CurveBack",
     &L::curve_back,
     {-1440, 1440},
     "bend of the upper half, degrees; then Curve is that of the lower",
     0},
    {"CurveV", &L::curve_v, {-720, 1440}, "variation, degrees; negative: helix of this slope", 0},
};

const TreeEntry kTreeTail[] = {
    {"Leaves", &T::leaves, {-500, 1000}, "leaves on a stem; negative: as a fan at its tip"},
    {"LeafShape",
     &T::leaf_shape,
     {0, kLeafShapeCount - 1, true},
     "outline: 0 elliptic, 1 round, 2 "
     "lanceolate, 3 lobed, 4 palmate, 5 triangular, 6 small oval, 7 needles"},
    {"LeafScale", &T::leaf_scale, {0.002f, 5}, "length of a leaf with its stalk, m"},
    {"LeafScaleX", &T::leaf_scale_x, {0.01f, 10}, "width of a leaf by its length"},
    {"LeafBend", &T::leaf_bend, {0, 1}, "how far leaves turn to the light, fraction"},
    {"LeafByLength",
     &T::leaf_by_length,
     {0, 1},
     "0: every stem has its Leaves, as in the paper; 1: in proportion to its length"},
    {"LeafDistrib",
     &T::leaf_distrib,
     {0, 8, true},
     "leaves on a stem by its place on the parent: a Shape (the paper's is 4)"},
    {"LeafQuality",
     &T::leaf_quality,
     {0.01f, 10},
     "factor of the number of leaves; their area stays"},
    {"AttractionUp", &T::attraction_up, {-20, 20}, "upward growth of levels 2 and 3"},
    {"PruneRatio", &T::prune_ratio, {0, 1}, "effect of pruning, fraction"},
    {"PruneWidth", &T::prune_width, {0, 5}, "radius of the envelope, fraction of the height"},
    {"PruneWidthPeak",
     &T::prune_width_peak,
     {0.001f, 0.999f},
     "height of the widest place, fraction of the crown"},
    {"PrunePowerLow", &T::prune_power_low, {0.0001f, 10}, "curvature of the envelope below it"},
    {"PrunePowerHigh", &T::prune_power_high, {0.0001f, 10}, "curvature of the envelope above it"},
};

/// Calls visit(name, value, range, help) for each parameter in order.
template <class Parameters, class Visit>
void forEach(Parameters& p, const Visit& visit) {
  for (const TreeEntry& e : kTreeHead) visit(std::string(e.name), p.*e.member, e.range, e.help);
  for (int n = 0; n < 4; ++n)
    for (const LevelEntry& e : kLevel)
      if (n >= e.first_level)
        visit(std::to_string(n) + e.name, p.level[static_cast<std::size_t>(n)].*e.member, e.range,
              e.help);
  for (const TreeEntry& e : kTreeTail) visit(std::string(e.name), p.*e.member, e.range, e.help);
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// Levenshtein's distance, with 2 for a letter too many or too few and 3 for a wrong one: letters
/// are forgotten more often than replaced.
std::size_t editDistance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = 2 * j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = 2 * i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t above = row[j];
      row[j] = std::min({above + 2, row[j - 1] + 2, diagonal + (a[i - 1] == b[j - 1] ? 0 : 3)});
      diagonal = above;
    }
  }
  return row[b.size()];
}

}  // namespace

std::string closestWord(const std::string& word, const std::vector<std::string>& words) {
  std::string best;
  std::size_t best_distance = static_cast<std::size_t>(-1);
  for (const std::string& w : words) {
    const std::size_t distance = editDistance(lower(word), lower(w));
    if (distance < best_distance) {
      best_distance = distance;
      best = w;
    }
  }
  return best;
}

void setParameter(TreeParameters& parameters, const std::string& name, const std::string& value) {
  bool found = false;
  std::vector<std::string> names;
  forEach(parameters, [&](const std::string& n, float& slot, const Range& range, const char*) {
    names.push_back(n);
    if (n != name) return;
    found = true;
    float number = 0;
    const char* end = value.data() + value.size();
    const char* begin = value.data() + (value.size() > 1 && value[0] == '+' ? 1 : 0);
    const auto [stop, error] = std::from_chars(begin, end, number);
    const std::string limits = fmt::format(
        "give a {} from {} to {}", range.whole ? "whole number" : "number", range.low, range.high);
    if (error != std::errc() || stop != end || !std::isfinite(number))
      throw Error("parameter " + name, "'" + value + "' is not a number", limits);
    if (number < range.low || number > range.high || (range.whole && number != std::round(number)))
      throw Error("parameter " + name, value + " is out of range", limits);
    slot = number;
  });
  if (!found)
    throw Error("parameter " + name, "there is no such parameter",
                "the closest name is " + closestWord(name, names));
}

void setParameters(TreeParameters& parameters, const std::string& table) {
  std::istringstream words(table);
  std::string word;
  while (words >> word) {
    const std::size_t equals = word.find('=');
    if (equals == std::string::npos)
      throw Error("parameter " + word, "has no value", "write NAME=VALUE");
    setParameter(parameters, word.substr(0, equals), word.substr(equals + 1));
  }
}

std::vector<ParameterInfo> listParameters(const TreeParameters& parameters) {
  std::vector<ParameterInfo> list;
  forEach(parameters,
          [&](const std::string& name, const float& value, const Range&, const char* help) {
            list.push_back({name, fmt::format("{}", value), help});
          });
  return list;
}

}  // namespace verdure
