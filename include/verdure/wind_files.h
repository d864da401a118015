#ifndef VERDURE_WIND_FILES_H_
#define VERDURE_WIND_FILES_H_

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "verdure/motion.h"

/// Wind data for other programs; docs/wind-export.md says what each channel holds.
namespace verdure {

struct WindTarget {
  std::string name;  ///< as exportWind() takes it
  std::string what;  ///< one line
};
/// All that exportWind() can write for.
const std::vector<WindTarget>& windTargets();

struct WindFiles {
  std::vector<std::pair<std::filesystem::path, std::size_t>> files;  ///< and their bytes
  std::size_t branches = 0, leaves = 0;
  std::vector<std::string> attributes;  ///< names of those that were written
  std::vector<std::string> notes;       ///< one line each: what does not fit the target in full
};

/// Writes a plant as .glb or .gltf with what `target` needs to move it, and files beside it: branch
/// records as NAME.wind.json, textures for Pivot Painter 2. Of a plant that was loaded from glTF
/// nothing changes but those attributes and asset.extras. All files appear, or none. Throws Error:
/// unknown target, a path of another kind, more branches than the target can number.
WindFiles exportWind(const Plant& plant, const PlantMotion& motion, const std::string& target,
                     const std::filesystem::path& path);

struct ClipOptions {
  Wind wind;
  double seconds = 4.0;  ///< of the loop, [0.5, 60]; rounded to whole frames
  double fps = 24.0;     ///< [5, 120]
  int joints = 256;      ///< at most, [8, 4096]; many engines take no more than 256
};

struct ClipFiles : WindFiles {
  std::size_t joints = 0, frames = 0;
  std::size_t bent_branches = 0;  ///< with joints of their own; the others ride on those
  /// Against movePlant() between frames, outside of the cross-fade, m: of wood; of leaves, whose
  /// flutter the clip has not; and how far vertices are from rest, for comparison.
  double wood_rms = 0.0, leaf_rms = 0.0, largest = 0.0, motion_rms = 0.0;
};

/// Writes a plant as .glb or .gltf with a skin and an animation that loops: movePlant() from 0
/// seconds on, without the leaves' flutter. In the last quarter, branches fade into where they were
/// before 0, so that the end is the beginning in place and velocity. Throws Error: numbers out of
/// range, a file with a skin or instances of its own.
ClipFiles exportClip(const Plant& plant, const PlantMotion& motion, const ClipOptions& options,
                     const std::filesystem::path& path);

}  // namespace verdure

#endif  // VERDURE_WIND_FILES_H_
