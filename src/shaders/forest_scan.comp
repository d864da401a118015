#version 460
#extension GL_GOOGLE_include_directive : require
#include "forest_set.glsl"
// Where the trees of each class begin, and those of each cluster among them; what is drawn.
shared uint sums[128];

/// Exclusive sum over the group's values; `total` of all.
uint scanned(uint value, out uint total) {
  uint local = gl_LocalInvocationID.x;
  sums[local] = value;
  barrier();
  for (uint step = 1u; step < 128u; step *= 2u) {
    uint below = local >= step ? sums[local - step] : 0u;
    barrier();
    sums[local] += below;
    barrier();
  }
  total = sums[127];
  uint before = sums[local] - value;
  barrier();
  return before;
}

void main() {
  uint number = job.first_view + gl_WorkGroupID.x, local = gl_LocalInvocationID.x;
  bool motion = views[number].motion != 0u;
  uint most_seats = views[number].seats, most_fars = views[number].fars;
  uint each = (job.cluster_count + 127u) / 128u;
  uint begin = min(local * each, job.cluster_count), end = min(begin + each, job.cluster_count);
  uint next_seat = 0u, next_far = 0u, kind = 0u;
  for (uint c = 0u; c < job.class_count; ++c) {
    uint row = (number * job.class_count + c) * job.cluster_count, sum = 0u, total;
    for (uint i = begin; i < end; ++i) sum += counts[row + i];
    uint before = scanned(sum, total);
    for (uint i = begin; i < end; ++i) {
      uint count = counts[row + i];
      counts[row + i] = before;
      before += count;
    }
    while (kind + 1u < job.kind_count && kinds[kind + 1u].first_class <= c) ++kind;
    bool far = !motion && c == kinds[kind].first_class + kinds[kind].meshes;
    // There is room for all that may come; what would not fit is left out, not written elsewhere.
    uint first = motion ? min(c, job.kind_count - 1u) * job.motion_seats : far ? next_far : next_seat;
    uint room = motion ? job.motion_seats : (far ? most_fars : most_seats) - first;
    total = min(total, room);
    if (far) next_far += total;
    else next_seat += total;
    if (local == 0u) ranges[number * job.class_count + c] = uvec2(first, total);
  }
  memoryBarrierBuffer();
  barrier();
  if (motion) {
    for (uint k = local; k < job.kind_count; k += 128u) {
      uint at = job.first_motion_command + 6u * k, count = ranges[number * job.class_count + k].y;
      commands[at] = (kinds[k].beams + 63u) / 64u;
      commands[at + 3u] = (kinds[k].leaves + 63u) / 64u;
      commands[at + 1u] = commands[at + 4u] = count;
      commands[at + 2u] = commands[at + 5u] = 1u;
    }
    return;
  }
  for (uint d = local; d < job.draw_count; d += 128u) {
    uvec2 range = ranges[number * job.class_count + draw_classes[d]];
    uint at = (number * job.draw_count + d) * 5u;
    commands[at + 1u] = range.y;
    commands[at + 4u] = range.x;
  }
  for (uint k = local; k < job.kind_count; k += 128u) {
    uint c = kinds[k].first_class + kinds[k].meshes;
    uint at = job.first_far_command + (number * job.kind_count + k) * 4u;
    commands[at + 1u] =
        kinds[k].has_impostor != 0u ? ranges[number * job.class_count + c].y : 0u;
  }
}
