#ifndef VERDURE_BENCH_FIELD_BENCH_VTK_H_
#define VERDURE_BENCH_FIELD_BENCH_VTK_H_

#include <cstddef>
#include <span>
#include <vector>

#include "verdure/field.h"

namespace verdure {

/// Adds every generator's kernel to the lattice points it reaches, parallel over slabs of z.
void splatDense(std::span<const Generator> generators, const Lattice& lattice,
                std::vector<float>& sums);

#ifdef VERDURE_BENCH_VTK
/// vtkFlyingEdges3D with normals; returns the number of vertices.
std::size_t flyingEdges(const Lattice& lattice, std::vector<float>& sums, float tau);
#endif

}  // namespace verdure

#endif  // VERDURE_BENCH_FIELD_BENCH_VTK_H_
