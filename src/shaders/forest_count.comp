#version 460
#extension GL_GOOGLE_include_directive : require
#include "forest_set.glsl"
// How many trees of a cluster each class has.
shared uint members[kMostForestClasses];

void main() {
  uint number = job.first_view + gl_WorkGroupID.y, local = gl_LocalInvocationID.x;
  ForestView view = views[number];
  uint row = (number * job.class_count + local) * job.cluster_count + gl_WorkGroupID.x;
  if (!seesCluster(view)) {
    if (local < job.class_count) counts[row] = 0u;
    return;
  }
  if (local < job.class_count) members[local] = 0u;
  barrier();
  Chosen chosen = chosenIn(view, gl_GlobalInvocationID.x);
  if (chosen.first != kForestNone) atomicAdd(members[chosen.first], 1u);
  if (chosen.second != kForestNone) atomicAdd(members[chosen.second], 1u);
  barrier();
  if (local < job.class_count) counts[row] = members[local];
}
