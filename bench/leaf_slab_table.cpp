// The table of docs/leaves.md: the multipole beside random walks.
#include <fmt/format.h>

#include "leaf/multipole.h"
#include "slab_walk.h"

int main() {
  using namespace verdure;
  using namespace verdure::test;
  const LeafOptics optics;
  constexpr int kWalks = 400000;
  struct Row {
    double index, reflection;
    SlabBeam beam;
    const char* what;
  };
  for (const Row& row : {Row{1.0, 0.0, SlabBeam::kStraight, "index 1, straight; rho_d 0"},
                         Row{1.0, 0.0, SlabBeam::kDiffuse, "index 1, diffuse; rho_d 0"},
                         Row{1.33, insideReflection(1.33), SlabBeam::kStraight,
                             "index 1.33, straight; rho_d of that index, 0.472"},
                         Row{1.33, insideReflection(1.33), SlabBeam::kDiffuse,
                             "index 1.33, diffuse; rho_d of that index, 0.472"},
                         Row{1.33, 0.1, SlabBeam::kDiffuse, "index 1.33, diffuse; rho_d 0.1"}}) {
    fmt::print(
        "{}\n  mm: through (walk, multipole, ratio); within 0.1, 0.25, 0.5 mm (walk / "
        "multipole)\n",
        row.what);
    const Multipole multipole(optics, row.reflection);
    for (const double d : {0.125, 0.15, 0.2, 0.3, 0.5, 1.0}) {
      const SlabLight walk = walkThroughSlab(optics, d, row.index, row.beam, kWalks, 1);
      const double total = multipole.total(d);
      const double entered = 1.0 - walk.mirrored;
      fmt::print("  {:5.3f}: {:.4f} {:.4f} {:.3f};", d, walk.through / entered, total,
                 total / (walk.through / entered));
      for (const double r : {0.1, 0.25, 0.5})
        fmt::print("  {:.3f} / {:.3f}", walk.within(r), 1.0 - multipole.beyond(r, d) / total);
      fmt::print("\n");
    }
  }
}
