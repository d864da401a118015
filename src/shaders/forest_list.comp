#version 460
#extension GL_GOOGLE_include_directive : require
#include "forest_set.glsl"
// Writes each tree to where it is drawn from, in the order of places whatever threads do.
shared uvec2 classes[128];

uint rankOf(uint c) {
  uint rank = 0u;
  for (uint i = 0u; i < gl_LocalInvocationID.x; ++i)
    rank += (classes[i].x == c ? 1u : 0u) + (classes[i].y == c ? 1u : 0u);
  return rank;
}

void put(ForestView view, uint number, uint index, uint c, uint fade) {
  uint cluster = gl_WorkGroupID.x;
  uvec2 range = ranges[number * job.class_count + c];
  uint at = counts[(number * job.class_count + c) * job.cluster_count + cluster] + rankOf(c);
  if (at >= range.y) return;
  at += range.x;
  ForestPlace place = places[index];
  ForestKindData kind = kinds[place.kind];
  if (view.motion == 0u && c == kind.first_class + kind.meshes) {
    fars[view.first_far + at] = index;
    return;
  }
  float turn_c = place.scale * cos(place.angle), turn_s = place.scale * sin(place.angle);
  Seat seat;
  seat.rows[0] = vec4(turn_c, 0.0, turn_s, place.x);
  seat.rows[1] = vec4(0.0, place.scale, 0.0, place.y);
  seat.rows[2] = vec4(-turn_s, 0.0, turn_c, place.z);
  uint slot = view.motion != 0u ? at - range.x : kind.moves != 0u ? slots[index] : 0u;
  seat.motion = uvec4(kind.beam_base + slot * kind.beams, kind.leaf_base + slot * kind.leaves,
                      place.phase, (place.tint & 0xffffffu) | (fade << 24));
  seats[view.first_seat + at] = seat;
  if (view.motion != 0u) slots[index] = slot;
}

void main() {
  uint number = job.first_view + gl_WorkGroupID.y, index = gl_GlobalInvocationID.x;
  ForestView view = views[number];
  if (!seesCluster(view)) return;
  Chosen chosen = chosenIn(view, index);
  classes[gl_LocalInvocationID.x] = uvec2(chosen.first, chosen.second);
  barrier();
  uint share = uint(round(chosen.share * float(kForestWhole)));
  if (chosen.first != kForestNone)
    put(view, number, index, chosen.first, chosen.second == kForestNone ? kForestWhole : min(share, kForestWhole - 1u));
  if (chosen.second != kForestNone)
    put(view, number, index, chosen.second, min(share, kForestWhole - 1u) | kForestRest);
}
