#include <assimp/config.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "base/files.h"
#include "plant/gltf_scene.h"
#include "plant/load.h"

namespace verdure {
namespace {
namespace fs = std::filesystem;

glm::dmat4 toMatrix(const aiMatrix4x4& m) {
  // assimp's rows are GLM's columns.
  return glm::transpose(glm::dmat4(m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3,
                                   m.c4, m.d1, m.d2, m.d3, m.d4));
}

std::string oneLine(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 32) c = ' ';
  while (!text.empty() && (text.back() == ' ' || text.back() == '.')) text.pop_back();
  return text.size() > 200 ? text.substr(0, 200) + "..." : text;
}

class AssimpImport {
 public:
  explicit AssimpImport(const fs::path& path) : path_(path) {}

  RawPlant import() {
    readFile(path_);  // for its messages; assimp opens the file again, and those beside it
    importer_.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE,
                                 aiPrimitiveType_POINT | aiPrimitiveType_LINE);
    scene_ =
        importer_.ReadFile(path_.string(), aiProcess_Triangulate | aiProcess_SortByPType |
                                               aiProcess_JoinIdenticalVertices | aiProcess_FlipUVs);
    if (scene_ == nullptr || scene_->mRootNode == nullptr)
      fail("cannot be read (" + oneLine(importer_.GetErrorString()) + ")");
    for (unsigned i = 0; i < scene_->mNumMaterials; ++i) readMaterial(*scene_->mMaterials[i], i);
    if (raw_.plant.materials.empty()) raw_.plant.materials.emplace_back().name = "default";
    readNode(*scene_->mRootNode, rootTransform());
    if (raw_.parts.empty()) fail("has no triangles");
    return std::move(raw_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(path_.string(), what, "export the plant again, best as glTF");
  }

  /// FBX counts in centimetres unless it says otherwise, with axes that it names; assimp leaves
  /// both to its user.
  glm::dmat4 rootTransform() const {
    std::string type = path_.extension().string();
    std::transform(type.begin(), type.end(), type.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    const aiMetadata* data = scene_->mMetaData;
    if (type != ".fbx" || data == nullptr) return glm::dmat4(1.0);
    double unit = 1.0;
    float single = 0.0f;
    if (!data->Get("UnitScaleFactor", unit) && data->Get("UnitScaleFactor", single))
      unit = static_cast<double>(single);
    if (!(unit > 0.0)) unit = 1.0;
    glm::dmat4 world(0.0);
    world[3][3] = 1.0;
    const char* axes[3] = {"CoordAxis", "UpAxis", "FrontAxis"};  // our X, Y, Z
    for (int row = 0; row < 3; ++row) {
      int axis = row, sign = 1;
      data->Get(axes[row], axis);
      data->Get(std::string(axes[row]) + "Sign", sign);
      if (axis >= 0 && axis < 3) world[axis][row] = (sign < 0 ? -0.01 : 0.01) * unit;
    }
    if (std::abs(glm::determinant(world)) > 0.0) return world;
    return glm::scale(glm::dmat4(1.0), glm::dvec3(0.01 * unit));
  }

  /// The bytes of an image as a material names it: embedded, or beside the file under that path or
  /// its last part.
  std::vector<std::uint8_t> textureBytes(const aiString& name) const {
    if (const aiTexture* embedded = scene_->GetEmbeddedTexture(name.C_Str());
        embedded != nullptr && embedded->mHeight == 0) {
      const auto* begin = reinterpret_cast<const std::uint8_t*>(embedded->pcData);
      return {begin, begin + embedded->mWidth};
    }
    std::string text = name.C_Str();
    std::replace(text.begin(), text.end(), '\\', '/');
    const fs::path folder = path_.parent_path();
    for (const fs::path& candidate :
         {fs::path(text), fs::path(text).filename(), "textures" / fs::path(text).filename()}) {
      std::error_code status;
      if (fs::is_regular_file(folder / candidate, status)) return readFile(folder / candidate);
    }
    throw Error(text, "no such file");
  }

  Image readImage(const aiMaterial& material, aiTextureType type) {
    aiString name;
    if (material.GetTexture(type, 0, &name) != aiReturn_SUCCESS || name.length == 0) return {};
    try {
      return decodeImage(textureBytes(name), name.C_Str());
    } catch (const Error& e) {
      raw_.plant.notes.push_back(std::string("texture left out: ") + e.what());
      return {};
    }
  }

  int addTexture(const std::string& name, Image image) {
    if (image.empty()) return -1;
    Texture& texture = raw_.plant.textures.emplace_back();
    texture.name = name;
    texture.image = std::move(image);
    return static_cast<int>(raw_.plant.textures.size()) - 1;
  }

  void readMaterial(const aiMaterial& source, unsigned index) {
    Material m;
    aiString name;
    source.Get(AI_MATKEY_NAME, name);
    m.name = name.length > 0 ? name.C_Str() : fmt::format("material {}", index);
    aiColor3D color(1.0f, 1.0f, 1.0f);
    source.Get(AI_MATKEY_COLOR_DIFFUSE, color);
    float opacity = 1.0f;
    source.Get(AI_MATKEY_OPACITY, opacity);
    int two_sided = 0;
    source.Get(AI_MATKEY_TWOSIDED, two_sided);
    m.double_sided = two_sided != 0;

    Image image = readImage(source, aiTextureType_DIFFUSE);
    if (image.empty()) image = readImage(source, aiTextureType_BASE_COLOR);
    const Image mask = readImage(source, aiTextureType_OPACITY);
    if (!image.empty() && !mask.empty()) applyMask(image, mask);
    // These formats have no alpha mode: texels that are cut out say so.
    std::size_t clear = 0;
    for (std::size_t i = 3; i < image.rgba.size(); i += 4) clear += image.rgba[i] < 128;
    if (clear * 100 > image.rgba.size() / 4) {
      m.alpha_mode = AlphaMode::kMask;
      m.double_sided = true;
    }
    // Exporters write black or grey below a texture as often as white.
    m.base_color = image.empty() ? glm::vec4(color.r, color.g, color.b, 1.0f) : glm::vec4(1.0f);
    if (opacity > 0.0f && opacity < 1.0f && image.empty()) {
      m.base_color.a = opacity;
      m.alpha_mode = AlphaMode::kBlend;
    }
    m.base_color_texture = addTexture(m.name + " colour", std::move(image));
    m.normal_texture = addTexture(m.name + " normal", readImage(source, aiTextureType_NORMALS));
    raw_.plant.materials.push_back(std::move(m));
  }

  /// Takes alpha from an opacity map: its own alpha if it has one, else its red.
  static void applyMask(Image& image, const Image& mask) {
    bool has_alpha = false;
    for (std::size_t i = 3; i < mask.rgba.size() && !has_alpha; i += 4)
      has_alpha = mask.rgba[i] != 255;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const std::uint8_t* texel =
            mask.at(x * mask.width / image.width, y * mask.height / image.height);
        image.at(x, y)[3] = texel[has_alpha ? 3 : 0];
      }
  }

  void readNode(const aiNode& root, const glm::dmat4& root_parent) {
    std::vector<std::pair<const aiNode*, glm::dmat4>> stack = {{&root, root_parent}};
    while (!stack.empty()) {
      const auto [node, parent] = stack.back();
      stack.pop_back();
      const glm::dmat4 world = parent * toMatrix(node->mTransformation);
      for (unsigned i = 0; i < node->mNumMeshes; ++i)
        readMesh(*scene_->mMeshes[node->mMeshes[i]], *node, world);
      for (unsigned i = node->mNumChildren; i-- > 0;) stack.emplace_back(node->mChildren[i], world);
    }
  }

  void readMesh(const aiMesh& source, const aiNode& node, const glm::dmat4& world) {
    RawPart part;
    part.names.mesh = source.mName.C_Str();
    part.names.node = &node == scene_->mRootNode ? "" : node.mName.C_Str();
    const auto material = static_cast<std::uint32_t>(
        std::min<std::size_t>(source.mMaterialIndex, raw_.plant.materials.size() - 1));
    const std::string& material_name = raw_.plant.materials[material].name;
    std::string name = !part.names.mesh.empty() ? part.names.mesh : part.names.node;
    if (name.empty()) name = material_name;
    // One object of several materials arrives as several meshes of one name.
    const bool taken = std::any_of(raw_.parts.begin(), raw_.parts.end(),
                                   [&](const RawPart& p) { return p.names.mesh == name; });
    part.mesh.name = taken ? name + "/" + material_name : name;
    part.mesh.material = material;
    const glm::dmat3 to_normal = normalTransform(world);
    part.world.resize(source.mNumVertices);
    if (source.HasNormals()) part.mesh.normals.resize(source.mNumVertices);
    if (source.HasTextureCoords(0)) part.mesh.uvs.resize(source.mNumVertices);
    for (unsigned i = 0; i < source.mNumVertices; ++i) {
      const aiVector3D& p = source.mVertices[i];
      if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
        fail(fmt::format("position {} of mesh '{}' is not finite", i, name));
      part.world[i] = glm::dvec3(world * glm::dvec4(p.x, p.y, p.z, 1.0));
      if (source.HasNormals()) {
        const aiVector3D& n = source.mNormals[i];
        const glm::dvec3 normal = to_normal * glm::dvec3(n.x, n.y, n.z);
        const double length = glm::length(normal);
        part.mesh.normals[i] =
            length > 1e-30 && std::isfinite(length) ? glm::vec3(normal / length) : glm::vec3(0.0f);
      }
      if (source.HasTextureCoords(0)) {
        const aiVector3D& uv = source.mTextureCoords[0][i];
        part.mesh.uvs[i] =
            std::isfinite(uv.x) && std::isfinite(uv.y) ? glm::vec2(uv.x, uv.y) : glm::vec2(0.0f);
      }
    }
    const bool mirrored = glm::determinant(glm::dmat3(world)) < 0.0;
    for (unsigned f = 0; f < source.mNumFaces; ++f) {
      const aiFace& face = source.mFaces[f];
      if (face.mNumIndices != 3) continue;
      const std::uint32_t corner[3] = {face.mIndices[0], face.mIndices[mirrored ? 2 : 1],
                                       face.mIndices[mirrored ? 1 : 2]};
      for (const std::uint32_t v : corner) {
        if (v >= source.mNumVertices)
          fail(fmt::format("face {} of mesh '{}' names vertex {} of {}", f, name, v,
                           source.mNumVertices));
        part.mesh.indices.push_back(v);
      }
    }
    if (!part.mesh.indices.empty()) raw_.parts.push_back(std::move(part));
  }

  fs::path path_;
  Assimp::Importer importer_;
  const aiScene* scene_ = nullptr;
  RawPlant raw_;
};

}  // namespace

RawPlant importAssimp(const fs::path& path) {
  return AssimpImport(path).import();
}

}  // namespace verdure
