#ifndef VERDURE_TRANSFER_H_
#define VERDURE_TRANSFER_H_

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "verdure/occlusion.h"
#include "verdure/plant.h"

/// Precomputed radiance transfer: Sloan, Kautz, Snyder, "Precomputed Radiance Transfer for
/// Real-Time Rendering in Dynamic, Low-Frequency Lighting Environments", SIGGRAPH 2002; Habel 2009,
/// chapter 5. Harmonics as in src/shared/sh.h.
namespace verdure {

/// Vectors of one mesh (or the ground), half floats. Vector v of channel c (0 = red) has its
/// coefficient i at [(v * coefficients + i) * 3 + c]. Its dot product with the harmonics' weights
/// of the sky's luminance (kcd/m^2) is irradiance / pi (kcd/m^2): a white diffuse surface's
/// luminance.
struct TransferVectors {
  /// Side of the vertex normal: all light of the sky, direct and after any number of bounces;
  /// bands^2 coefficients.
  std::vector<std::uint16_t> front, back;  ///< back: leaves only (what shines through); else empty
  /// The bounced part alone, bounce_bands^2 coefficients: with the weights of the sun as a light,
  /// the indirect light of the sun, whose direct light is drawn with shadow maps.
  std::vector<std::uint16_t> front_bounced, back_bounced;
};

/// The ground around the plant: a grid of vectors on y = height, x and z growing with the column
/// and the row; beyond it the ground is open.
struct GroundTransfer {
  int size = 0;             ///< points along each side; 0 = none
  glm::vec2 corner{0.0f};   ///< x, z of the first point, m
  float step = 0.0f;        ///< m
  float height = 0.0f;      ///< y, m
  TransferVectors vectors;  ///< front only
};

struct PlantTransfer {
  int bands = 0;                        ///< of front and back, 2 to 7
  int bounce_bands = 0;                 ///< of the bounced parts, at most 3; 0 = none
  std::vector<TransferVectors> meshes;  ///< parallel to Plant::meshes
  GroundTransfer ground;
};

struct TransferOptions {
  RayOptions rays;       ///< with a ground height the ground reflects and receives; it is wanted
  int bands = 5;         ///< 2 to 7
  int bounce_bands = 3;  ///< 0 to 3, at most `bands`
  int ground_size = 64;  ///< points along the ground's grid, 0 or 2 to 1024
};

/// Traces light to both sides of every leaf and the outside of wood, as occlusion.h has it: rays
/// that leave the scene in direction d add Y_i(d) to coefficient i, others the light that the
/// surface they meet passes on (docs/transfer.md). Deterministic for any number of threads. Throws
/// Error: options out of range; a scene, what its surfaces pass on, or a result over
/// RayOptions::max_memory_bytes; cancelled.
PlantTransfer bakeTransfer(const Plant& plant, const TransferOptions& options = {});

/// The file beside a plant's file that holds its transfer: "oak.glb" has "oak.transfer".
std::filesystem::path transferPath(const std::filesystem::path& plant_file);

/// Writes transferPath(plant_file) (docs/transfer.md has the layout), atomically. Throws Error.
void saveTransfer(const PlantTransfer& transfer, const Plant& plant,
                  const std::filesystem::path& plant_file);

/// Reads transferPath(plant_file); nothing if there is no such file. Throws Error if it is damaged,
/// of another version, or of another plant.
std::optional<PlantTransfer> loadTransfer(const std::filesystem::path& plant_file,
                                          const Plant& plant);

}  // namespace verdure

#endif  // VERDURE_TRANSFER_H_
