#ifndef VERDURE_PLANT_GLTF_EXPORT_H_
#define VERDURE_PLANT_GLTF_EXPORT_H_

#include "plant/gltf_document.h"
#include "verdure/plant_io.h"

namespace verdure {

/// The plant's own document with the light written into it.
GltfDocument relitDocument(const Plant& plant, const CrownLight& light,
                           const ExportOptions& options);

/// A new document for a grown plant or one of another format.
GltfDocument newDocument(const Plant& plant, const CrownLight* light, const ExportOptions& options);

/// `values` as the bytes of a buffer.
template <class T>
std::vector<std::uint8_t> bytesOf(const std::vector<T>& values) {
  const auto* begin = reinterpret_cast<const std::uint8_t*>(values.data());
  return {begin, begin + values.size() * sizeof(T)};
}

/// COLOR_1 of an ambient coefficient: RGB = k, A = 1, 8 bits each.
std::vector<std::uint8_t> ambientColors(const std::vector<float>& ambient);

}  // namespace verdure

#endif  // VERDURE_PLANT_GLTF_EXPORT_H_
