#ifndef VERDURE_PLANT_GLTF_ACCESSOR_H_
#define VERDURE_PLANT_GLTF_ACCESSOR_H_

#include "plant/gltf_document.h"

namespace verdure {

inline constexpr int kByte = 5120, kUnsignedByte = 5121, kShort = 5122, kUnsignedShort = 5123,
                     kUnsignedInt = 5125, kFloat = 5126;
inline constexpr int kArrayBuffer = 34962, kElementArrayBuffer = 34963;

/// Bytes of one component, 0 for an unknown type.
std::size_t componentSize(int component_type);
/// 3 for "VEC3" and so on, 0 for an unknown type.
std::size_t componentCount(const std::string& type);

/// An accessor after all checks: every element lies within `data`.
struct AccessorData {
  std::size_t count = 0;
  std::size_t components = 0;
  int component_type = 0;
  bool normalized = false;
  const std::uint8_t* data = nullptr;
  std::size_t stride = 0;
  std::vector<std::uint8_t> owned;  ///< holds the data of sparse and of empty accessors
};

/// Opens an accessor. Throws Error if it points outside its buffer view, has an unknown type, or
/// claims more elements than there are bytes: nothing is allocated before that is known.
AccessorData openAccessor(const GltfDocument& document, std::size_t accessor);

/// All elements as floats, `components` each; normalised integers become [-1, 1] or [0, 1]
/// (glTF 2.0, section 3.11). Throws Error if the accessor has another number of components.
std::vector<float> readFloats(const GltfDocument& document, std::size_t accessor,
                              std::size_t components, const std::string& who);

/// The elements of a scalar accessor of unsigned integers.
std::vector<std::uint32_t> readIndices(const GltfDocument& document, std::size_t accessor,
                                       const std::string& who);

/// Every element of an unsigned integer accessor, `components` each (JOINTS_n).
std::vector<std::uint32_t> readUnsigned(const GltfDocument& document, std::size_t accessor,
                                        std::size_t components, const std::string& who);

}  // namespace verdure

#endif  // VERDURE_PLANT_GLTF_ACCESSOR_H_
