// Pictures of a plant from around, and where it stands.
#include "shared/forest.h"
#include "shared/octahedron.h"
layout(set = 1, binding = 0) uniform sampler2DArray impostor_color;  // premultiplied
layout(set = 1, binding = 1) uniform sampler2DArray impostor_normal;
layout(set = 1, binding = 2) uniform sampler2DArray impostor_light;
layout(push_constant, std430) uniform JobBlock { ImpostorJob job; };
layout(set = 1, binding = 6, std430) readonly buffer Kinds { ImpostorKind kinds[]; };
