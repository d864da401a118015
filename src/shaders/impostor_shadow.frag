#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/frame.h"
#include "impostor_set.glsl"
#include "impostor.glsl"
#include "coverage.glsl"

void main() {
  ImpostorKind kind = kinds[job.kind];
  if (coveredInNearest(kind) <= pixelThreshold(scrambled(seat.x))) discard;
}
