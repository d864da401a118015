// Descriptor set 2 of plants that are drawn one by one.
#include "shared/grass_blades.h"
layout(set = 2, binding = 0, std430) readonly buffer Parts { GrassRibbonPart parts[]; };
