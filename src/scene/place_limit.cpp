#include "scene/place_limit.h"

#include <fmt/format.h>
#include <unistd.h>

#include "verdure/error.h"
#include "verdure/placement.h"
#include "verdure/scatter.h"

namespace verdure {

void checkPlaceCount(double count, const std::string& where) {
  constexpr const char* kAdvice = "make the area smaller or the plants sparser";
  if (!(count <= static_cast<double>(kMostScattered)))
    throw Error(where,
                fmt::format("{:.3g} places of plants are more than the {} that scenes may have",
                            count, kMostScattered),
                kAdvice);
  const double memory =
      static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
  // Placed plants are held twice for a moment, and drawn from as much again.
  const double needed = 4.0 * count * sizeof(Placement);
  if (memory > 0.0 && needed > 0.5 * memory)
    throw Error(where,
                fmt::format("{:.3g} places of plants need {:.1f} GiB, and this machine has {:.1f} "
                            "in all",
                            count, needed * 0x1p-30, memory * 0x1p-30),
                kAdvice);
}

}  // namespace verdure
