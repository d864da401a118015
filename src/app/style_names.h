#ifndef VERDURE_APP_STYLE_NAMES_H_
#define VERDURE_APP_STYLE_NAMES_H_

#include <string>

#include "verdure/render.h"

namespace verdure::app {

/// photo, normals, edges, toon or watercolour (watercolor, too). Throws Error that names --style.
Style parseStyle(const std::string& name);
const char* nameOf(Style style);

/// raw, realigned or scaled. Throws Error that names --style-normals.
StyleNormals parseStyleNormals(const std::string& name);
const char* nameOf(StyleNormals normals);

/// Whether the picture needs what a bake finds: crown normals, ambient coefficients, or both.
bool needsBake(const View& view);

/// Whether the picture shows the leaves' own normals.
bool needsLeafNormals(const View& view);

}  // namespace verdure::app

#endif  // VERDURE_APP_STYLE_NAMES_H_
