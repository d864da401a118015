#ifndef VERDURE_REFERENCE_H_
#define VERDURE_REFERENCE_H_

#include <cstdint>
#include <functional>
#include <vector>

#include "verdure/image.h"
#include "verdure/scene.h"
#include "verdure/sky.h"

/// The truth that pictures are measured against: a path tracer on the CPU.
namespace verdure {

/// How light that reaches a surface is looked for; all find the same picture.
enum class LightSearch {
  kBoth,     ///< towards the lights and as the surface scatters, weighted by how apt each is
  kLights,   ///< only towards the sky (as its luminance is distributed) and the sun
  kSurface,  ///< only as the surface scatters
};

struct ReferenceOptions {
  int width = 640;
  int height = 360;
  Camera camera;
  int samples = 64;      ///< paths for each pixel at most, >= 1
  double seconds = 0.0;  ///< stop after this time, 0 = never; at least one round is traced
  /// Stop when the picture's noise (ReferencePicture::noise) is at most this, 0 = never.
  double noise = 0.0;
  int bounces =
      32;  ///< surfaces that light may scatter at on its way, >= 1; 1 = direct light alone
  std::uint32_t seed = 1;
  bool normal_maps = true;
  bool gloss = true;      ///< highlights of leaves and wood
  bool leaf_maps = true;  ///< leaves by Material::leaf where they have it, else by their colour
  LightSearch search = LightSearch::kBoth;
  /// Called from the calling thread after each round with the share done in [0, 1].
  std::function<void(double share)> progress;
};

struct ReferencePicture {
  HdrImage image;  ///< kcd/m^2; each pixel the plain average over its area
  std::vector<float>
      standard_error;  ///< of each pixel's luminance, kcd/m^2, estimated; 0 for 1 sample
  int samples = 0;     ///< paths for each pixel
  double noise = 0.0;  ///< root of the mean squared standard error over the mean luminance
  double seconds = 0.0;
};

/// Traces paths (Kajiya, "The Rendering Equation", SIGGRAPH 1986) through the scene as the renderer
/// has it: alpha cut, normals and normal maps of the meshes, the ground with its texture and, on
/// what the eye sees of it, haze. Plants' baked light and transfer vectors play no part.
///
/// Wood and ground reflect diffusely, leaves on both sides, and transmit diffusely
/// (shared/leaf.h). Leaves and wood have the gloss of a clear rough surface over it (Cook and
/// Torrance 1982), which takes from the light below what it reflects. Leaves with maps of their own
/// have each side's albedo, normals and gloss, and pass light on as (3.23) of Habel 2009
/// (shared/leaf_basis.h), the maps' three coefficients; their gloss takes what it mirrors there,
/// too, and where albedo and light through the leaf sum to more than 1, less comes through. Shading
/// normals may point away from the triangle's side: the part of a lobe that would go through the
/// surface is mirrored back, so that as much light leaves as arrives. The sun is seen, and its disk
/// shines, only above the horizon; the last half degree of the sky, and what an eye without ground
/// sees below it, look as the sky does there (shared::domeDirection()), as in the renderer.
///
/// A picture depends on the scene, the options and the number of samples, not on threads or time.
/// Throws Error for options out of range and what RayScene refuses.
ReferencePicture renderReference(const Scene& scene, const Daylight& lights,
                                 const ReferenceOptions& options);

}  // namespace verdure

#endif  // VERDURE_REFERENCE_H_
