#ifndef VERDURE_APP_BAKE_PARAMETERS_H_
#define VERDURE_APP_BAKE_PARAMETERS_H_

#include <optional>
#include <string>

#include "verdure/density.h"
#include "verdure/optical_depth.h"

namespace verdure::app {

enum class BakeField { kMetaball, kOpticalDepth };

/// The parameters of the bake as the command line and scene files give them; `options` reads them.
struct BakeParameters {
  DensityOptions options;
  std::string field;            ///< metaball or optical-depth; empty: as fieldOr() finds
  std::string metaball_option;  ///< one that was given and that only the metaball field has
  std::string norm = "2";
  std::string normals;      ///< empty: the field's own
  std::optional<bool> fit;  ///< unset: the optical-depth field's is fitted, the metaballs' is not
  double max_memory_mib = 4096;

  /// The field that was named, else the one that the given options need, else `fallback`. Throws
  /// Error: an unknown field, an option that the named one has not.
  BakeField fieldOr(BakeField fallback) const;
  /// Throws Error for an unknown norm or kind of normals.
  DensityOptions checked() const;
  DepthOptions checkedDepth() const;
};

}  // namespace verdure::app

#endif  // VERDURE_APP_BAKE_PARAMETERS_H_
