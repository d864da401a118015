// What the passes share that choose a forest's trees; one of three steps each.
#include "shared/forest.h"
#include "shared/horizon.h"
layout(local_size_x = 128) in;  // kForestGroup
layout(set = 0, binding = 0, std430) readonly buffer Places { ForestPlace places[]; };
layout(set = 0, binding = 1, std430) readonly buffer Clusters { vec4 clusters[]; };  // spheres
layout(set = 0, binding = 2, std430) readonly buffer Kinds { ForestKindData kinds[]; };
layout(set = 0, binding = 3, std430) readonly buffer Views { ForestView views[]; };
layout(set = 0, binding = 4, std430) buffer Counts { uint counts[]; };  // [view][class][cluster]
layout(set = 0, binding = 5, std430) buffer Ranges { uvec2 ranges[]; };  // [view][class]: first, count
layout(set = 0, binding = 6, std430) buffer Commands { uint commands[]; };
layout(set = 0, binding = 7, std430) readonly buffer DrawClasses { uint draw_classes[]; };
struct Seat {
  vec4 rows[3];  // of world_from_plant
  uvec4 motion;  // instance.glsl
};
layout(set = 0, binding = 8, std430) buffer Seats { Seat seats[]; };
layout(set = 0, binding = 9, std430) buffer Fars { uint fars[]; };    // places of impostors
layout(set = 0, binding = 10, std430) buffer Slots { uint slots[]; };  // of each place: its motion
layout(set = 0, binding = 11, std430) readonly buffer Horizon { float horizon[]; };
layout(set = 0, binding = 12, std430) readonly buffer Tiles { float tiles[]; };  // depth_tiles.comp
layout(push_constant, std430) uniform JobBlock {
  uint first_view;
  uint place_count;
  uint cluster_count;
  uint class_count;
  uint draw_count;
  uint kind_count;
  uint first_far_command;  // word
  uint first_motion_command;
  uint motion_seats;       // of each kind
} job;

struct Chosen {
  uint first, second;  // classes, kForestNone
  float share;         // of the first
};

/// By what has been drawn.
bool isBehind(ForestView view, vec3 middle, float half_height, float half_width) {
  DepthTiles at = depthTilesOf(view, middle, half_height, half_width);
  uint width = depthTiles(view.width), first = 0u;
  if (max(at.end_x - at.first_x, at.end_y - at.first_y) > 8u) {  // by blocks
    first = width * depthTiles(view.height);
    width /= 8u;
    at.first_x /= 8u;
    at.first_y /= 8u;
    at.end_x = (at.end_x + 7u) / 8u;
    at.end_y = (at.end_y + 7u) / 8u;
  }
  for (uint y = at.first_y; y < at.end_y; ++y)
    for (uint x = at.first_x; x < at.end_x; ++x)
      if (at.depth >= tiles[first + y * width + x]) return false;
  return at.depth < 1.0;
}

bool seesCluster(ForestView view) {
  vec4 sphere = clusters[gl_WorkGroupID.x];
  return seesSphere(view, sphere.xyz, sphere.w) &&
         (view.shades == 0u || shadesPicture(view, views[0], sphere.xyz, sphere.w)) &&
         (view.hides == 0u || !isBehind(view, sphere.xyz, sphere.w, sphere.w));
}

/// By the ground.
bool isHidden(vec3 from_eye, float radius) {
  HorizonLookup lookup = horizonLookup(from_eye, radius);
  if (lookup.count == 0u || lookup.count > 64u) return false;
  for (uint i = 0u; i < lookup.count; ++i) {
    uint turn = (lookup.first + i) % kHorizonTurns;
    if (horizon[turn * kHorizonRings + lookup.ring] <= lookup.tangent) return false;
  }
  return true;
}

Chosen chosenIn(ForestView view, uint index) {
  Chosen chosen = Chosen(kForestNone, kForestNone, 1.0);
  if (index >= job.place_count) return chosen;
  ForestPlace place = places[index];
  ForestKindData kind = kinds[place.kind];
  vec3 middle = forestMiddle(place, kind.sphere);
  if (!seesSphere(view, middle, kind.sphere.w * place.scale)) return chosen;
  if (view.shades != 0u && !shadesPicture(view, views[0], middle, kind.sphere.w * place.scale))
    return chosen;
  if (view.horizon != 0u && isHidden(middle - view.eye.xyz, kind.sphere.w * place.scale))
    return chosen;
  if (view.hides != 0u &&
      isBehind(view, middle, kind.half_height * place.scale, kind.half_width * place.scale))
    return chosen;
  float size = 1.0 / place.scale;
  ForestLevel choice = forestLevel(kind.reach, kind.meshes, kind.has_impostor,
                                   distance(middle, view.eye.xyz) * size, view.eye.w * size);
  if (view.motion != 0u) {
    if (kind.moves != 0u && choice.level < kind.meshes) chosen.first = place.kind;
    return chosen;
  }
  if (view.part != kForestAll && (view.part == kForestFront) != (choice.next < kind.meshes)) return chosen;
  bool gives_way = choice.next != choice.level;
  if (view.fades == 0u && gives_way && choice.share < 0.5) choice.level = choice.next;
  chosen.first = kind.first_class + choice.level;
  if (view.fades != 0u && gives_way) {
    chosen.second = kind.first_class + choice.next;
    chosen.share = choice.share;
  }
  return chosen;
}
