#ifndef VERDURE_SKY_FIT_KERNEL_H_
#define VERDURE_SKY_FIT_KERNEL_H_

#include <cstddef>

namespace verdure {

/// Outputs come in multiples of this.
inline constexpr std::size_t kFitLanes = 8;

/// out[k] = sum over i < rows and j < columns of
///   x[i] y[j] coefficients[(i * columns + j) * stride + k], for k < stride.
/// The highest terms, which are the smallest, are added first.
void sumPolynomials(const float* x, std::size_t rows, const float* y, std::size_t columns,
                    const float* coefficients, std::size_t stride, float* out);

}  // namespace verdure

#endif  // VERDURE_SKY_FIT_KERNEL_H_
