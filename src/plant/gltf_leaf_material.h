#ifndef VERDURE_PLANT_GLTF_LEAF_MATERIAL_H_
#define VERDURE_PLANT_GLTF_LEAF_MATERIAL_H_

#include <functional>

#include "plant/gltf_document.h"
#include "verdure/plant.h"

// Leaves with maps of both sides in glTF. Core glTF knows the front's colour and normals, and
// KHR_materials_diffuse_transmission the light through it, scattered evenly; the rest lies in the
// material's extras.verdure.leaf: backColorTexture, backNormalTexture, frontTranslucencyTexture,
// backTranslucencyTexture, frontLightTexture, backLightTexture (each { index, texCoord,
// extensions.KHR_texture_transform } as in core glTF; the last two also { scale, offset }: a
// coefficient is offset + scale * texel), frontRoughness, backRoughness, refractiveIndex.

namespace verdure {

/// Writes `leaf` into a material's JSON, with extensions that other programs know.
/// `texture_of`: index into the document's textures. `transmitted`: share of the light that gets
/// through the leaf, on the mean.
void writeLeafMaterial(const LeafTextures& leaf, float transmitted,
                       const std::function<int(int)>& texture_of, Json& material);

/// What a material's extras say of its leaf, nullopt if nothing. `texture_of`: reads a texture's
/// use and gives its index into Plant::textures, -1 if it cannot be read or has UVs of its own.
/// Throws Error for members of wrong types and numbers out of range.
std::optional<LeafTextures> readLeafMaterial(const GltfDocument& document, const Json& material,
                                             const std::string& who,
                                             const std::function<int(const Json&)>& texture_of);

inline constexpr const char* kDiffuseTransmission = "KHR_materials_diffuse_transmission";

/// Writes that extension alone, for leaves without maps of their own.
void writeDiffuseTransmission(const DiffuseTransmission& stated,
                              const std::function<int(int)>& texture_of, Json& material);

/// What it says; nullopt if nothing, or if a texture of it gives -1. Throws as readLeafMaterial().
std::optional<DiffuseTransmission> readDiffuseTransmission(
    const GltfDocument& document, const Json& material, const std::string& who,
    const std::function<int(const Json&)>& texture_of);

/// Writes KHR_materials_ior and KHR_materials_specular, where they say something.
void writeClearSurface(const ClearSurface& surface, Json& material);

/// What they say; textures of them are left out. Throws as readLeafMaterial().
ClearSurface readClearSurface(const GltfDocument& document, const Json& material,
                              const std::string& who);

}  // namespace verdure

#endif  // VERDURE_PLANT_GLTF_LEAF_MATERIAL_H_
