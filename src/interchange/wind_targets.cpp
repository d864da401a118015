#include "interchange/wind_targets.h"

#include "verdure/error.h"
#include "verdure/wind_files.h"

namespace verdure {

const std::vector<WindTargetTable>& windTargetTables() {
  using enum WindQuantity;
  static const std::vector<WindTargetTable> kTables = {
      {"attributes",
       "verdure's own attributes, and branch records beside the file",
       {{"_STEM_ID", false, {kStem}},
        {"_BRANCH", false, {kBranch}},
        {"_PLACES", false, {kPlace0, kPlace1, kPlace2, kPlace3}},
        {"_HIERARCHY_DEPTH", false, {kLevel}},
        {"_PIVOT_POSITION", false, {kPivotX, kPivotY, kPivotZ}},
        {"_BRANCH_EXTENT", false, {kLength}},
        {"_LEAF_ANCHOR", false, {kAnchorX, kAnchorY, kAnchorZ}, true},
        {"_LEAF_PHASE", false, {kLeafPhase}, true}}},
      {kPivotPainter,
       "Unreal Engine's Pivot Painter 2: two textures and a set of UVs",
       {{"TEXCOORD", false, {kElementU, kElementV}}}},
      {"vertex-colour:crysis",
       "Crysis, CryEngine, and what follows GPU Gems 3, chapter 16",
       {{"COLOR_1", true, {kLeafEdge, kLeafPhase, kBranchBend, kOpenness}}}},
      {"vertex-colour:o3de",
       "O3DE's vegetation bending",
       {{"COLOR_1", true, {kLeafEdge, kBranchPhase, kBranchBend, kOne}}}},
      {"vertex-colour:red-eclipse",
       "Red Eclipse's mdlvegetation",
       {{"COLOR_1", true, {kLeafEdge, kLeafPhase, kBranchBend, kOne}}}},
      {"vertex-colour:sbox",
       "s&box's foliage shader",
       {{"COLOR_1", true, {kLeafEdge, kBranchBend, kLeafPhase, kOne}}}},
      {"vertex-colour:dagor",
       "Dagor Engine's rendinst_tree_colored (daNetGame)",
       {{"COLOR_1", true, {kLeafEdge, kLeafPhase, kZero, kOne}}}},
      {"vertex-colour:gdtree3d",
       "gdTree3D (Godot)",
       {{"COLOR_1", true, {kStillness, kSway, kZero, kOne}}}},
      {"vertex-colour:unity",
       "Unity's Tree Creator and what follows its AnimateVertex()",
       {{"COLOR_1", true, {kBranchPhase, kLeafEdge, kZero, kOpenness}},
        {"TEXCOORD", false, {kTreeBend, kBranchBend}}}},
      {"speedtree8",
       "Unity's SpeedTree 8 shaders: four vectors for an import script",
       {{"_SPEEDTREE8_TEXCOORD0", false, {kU, kV, kBranchBend, kSwayDirection}},
        {"_SPEEDTREE8_TEXCOORD1", false, {kZero, kZero, kAnchorX, kAnchorY}},
        {"_SPEEDTREE8_TEXCOORD2", false, {kX, kY, kZ, kAnchorZ}},
        {"_SPEEDTREE8_TEXCOORD3", false, {kLeafEdge, kLeafAxis, kLeafNormal, kSpeedTreeGeometry}},
        {"_SPEEDTREE8_COLOR", true, {kOpenness, kOpenness, kOpenness, kOne}}}},
  };
  return kTables;
}

const WindTargetTable& windTargetTable(const std::string& name) {
  std::string names;
  for (const WindTargetTable& table : windTargetTables()) {
    if (table.name == name) return table;
    names += (names.empty() ? "" : ", ") + table.name;
  }
  throw Error("wind target '" + name + "'", "is unknown", "use one of " + names);
}

const std::vector<WindTarget>& windTargets() {
  static const std::vector<WindTarget> kTargets = [] {
    std::vector<WindTarget> targets;
    for (const WindTargetTable& table : windTargetTables())
      targets.push_back({table.name, table.what});
    return targets;
  }();
  return kTargets;
}

}  // namespace verdure
