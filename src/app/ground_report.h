#ifndef VERDURE_APP_GROUND_REPORT_H_
#define VERDURE_APP_GROUND_REPORT_H_

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "app/fidelity.h"
#include "app/page.h"
#include "base/progress.h"

namespace verdure::app {

/// How far one candidate's irradiance on the ground is from the path tracer's. All are shares and,
/// but for `open`, over the shadow: the pixels where the path tracer's irradiance is below 90 % of
/// open ground's and not 0, as it is inside the trunk.
struct GroundError {
  double of_mean = 0.0;   ///< mean of |E - E_ref| over mean of E_ref
  double of_pixel = 0.0;  ///< mean of |E - E_ref| / E_ref
  double rms = 0.0;       ///< root of the mean of (E - E_ref)^2 over mean of E_ref, free of noise
  double bias = 0.0;      ///< mean of E - E_ref over mean of E_ref
  double open = 0.0;      ///< mean of |E - E_ref| over open ground's E where E_ref is above 99 %
};

/// One plant, sun and light.
struct GroundPicture {
  std::string label;                ///< plant, sun
  bool sun_alone = false;           ///< under a black sky; else whole daylight
  double patch_m = 0.0;             ///< side of the square over which irradiance is averaged
  double shadow_m2 = 0.0;           ///< area that is measured
  double shadow_light = 0.0;        ///< mean of E_ref there, of open ground's
  double noise = 0.0;               ///< of E_ref there: what of_mean would be of the truth itself
  double open_noise = 0.0;          ///< the same of GroundError::open
  double open_light = 0.0;          ///< the renderer's open ground over the path tracer's, less 1
  std::vector<GroundError> errors;  ///< of groundCandidates()
};

/// Those of kCandidates that light the ground in a way of their own.
std::vector<const Candidate*> groundCandidates();

/// Looks from above, through the plant, at the ground in the reach of its shadow; adds the
/// pictures to the page. `pixels`: of each picture; `samples`: paths a pixel, twice as many for the
/// sun alone.
std::vector<GroundPicture> measureGround(const Subject& subject, int pixels, int samples,
                                         Renderer& renderer, Page& page, Progress& progress);

void addGroundTables(Page& page, const std::vector<GroundPicture>& pictures);
nlohmann::ordered_json groundJson(const std::vector<GroundPicture>& pictures);

}  // namespace verdure::app

#endif  // VERDURE_APP_GROUND_REPORT_H_
