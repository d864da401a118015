#ifndef VERDURE_SHARED_SWAY_H_
#define VERDURE_SHARED_SWAY_H_

#include "beam.h"
#include "motion.h"
#include "portable.h"

// A plant at a moment of the wind: Habel, "Real-time Rendering and Animation of Vegetation",
// dissertation, TU Wien 2009, 4.5 to 4.7. Two steps: how far each branch and each leaf is bent
// (once for each place where the plant stands), and where that takes a vertex. CPU and all passes
// of the renderer run the same lines.

SHARED_BEGIN

/// A tip goes at most this share of its branch's length aside, a gale or not: real trees give way.
const float kMostTip = 0.45f;
/// Half-angle's tangent of the farthest that a leaf turns about each of its axes: 63 degrees.
const float kMostLeafTurn = 0.6f;

// What a vertex hangs on, in two words: a beam and its place on it as a float's bits; or a leaf.
const uint kHangsOnNothing = 0xffffffffu;
const uint kHangsOnLeaf = 0x80000000u;  ///< or the leaf's index

/// A branch at rest, and what carries it: indices and places of its parent, its parent's parent and
/// so on; ends at kHangsOnNothing.
struct MotionBeam {
  vec3 root;
  float length;
  vec3 t;
  float c2;  ///< of (4.8)
  vec3 r;
  float c4;
  uvec4 carriers;
  vec4 places;
};
SHARED_SIZE(MotionBeam, 80);

/// What moves a branch. For wind of 1 m/s: its tip's mean deflection where the wind blows to, and
/// the root mean square of its swinging along r and along s, in lengths; both grow as the speed's
/// square.
struct MotionDrive {
  MotionTrajectory trajectory;
  uint texels;  ///< first of its motion texture
  uint size;    ///< width of that, + 65536 height
  float mean;
  float swing;
};
SHARED_SIZE(MotionDrive, 32);

/// A leaf at rest: where it is attached, unit axis and normal, and how it answers wind of 1 m/s:
/// root mean square of its bending and twisting, and how far it leans out of a wind that blows on
/// its face; tangents of half the angle, which grow as the speed's square.
struct MotionLeaf {
  vec3 stalk;
  float place;  ///< on its beam
  vec3 axis;
  uint beam;
  vec3 normal;
  float flutter;
  float lean;
  float twist;
  uvec2 padding;
};
SHARED_SIZE(MotionLeaf, 64);

/// The wind over one kind of plant at a moment, see momentOf().
struct MotionMoment {
  vec4 toward;      ///< unit, where it blows to; w = mean speed, m/s
  vec4 gust_phase;  ///< cycles of the four waves that gusts are made of, in [0, 1)
  vec4 gust_wave;   ///< their cycles a metre downwind
  vec4 scroll;      ///< how far the wind of leaves has come, [0, 1): planes xy and yz
  vec4 drift;       ///< the same, plane xz; z = gusts; w = fraction of the second
  vec4 planes;      ///< their shares (4.27), squares sum to 1; w = 1 / extent of the texture, 1/m
};
SHARED_SIZE(MotionMoment, 96);

/// Speed of the wind at a place in the world, m/s: gusts go with the wind from tree to tree.
SHARED_FUNCTION float gustySpeed(MotionMoment moment, vec3 origin) {
  float way = dot(vec3(moment.toward), origin);
  vec4 cycles = moment.gust_phase - moment.gust_wave * way;
  cycles = 6.2831853f * (cycles - floor(cycles + vec4(0.5f)));
  float waves = sin(cycles.x) + sin(cycles.y) + sin(cycles.z) + sin(cycles.w);
  return moment.toward.w * (1.0f + 0.25f * moment.drift.z * waves);
}

/// Where a branch of the `place`-th plant of its kind reads its texture; `phase` keeps plants out
/// of unison.
SHARED_FUNCTION vec2 branchUv(MotionDrive drive, uvec2 phase, uint whole, float fraction) {
  MotionTrajectory trajectory = drive.trajectory;
  trajectory.offset = trajectory.offset + phase;
  return motionUv(trajectory, whole, fraction);
}

/// (4.12), (4.13), (4.21), (4.22): amplitudes of a branch along r and s for poseOfBeam(), m, in
/// wind of `speed` that blows `toward`, in the plant's coordinates.
SHARED_FUNCTION vec2 branchAmplitudes(MotionBeam beam, MotionDrive drive, vec3 toward, float speed,
                                      vec2 noise) {
  float push = speed * speed;
  vec3 s = cross(beam.t, beam.r);
  vec2 tip = push * (drive.swing * noise + drive.mean * vec2(dot(beam.r, toward), dot(s, toward)));
  tip = tip * (1.0f / sqrt(1.0f + dot(tip, tip) * (1.0f / (kMostTip * kMostTip))));
  return tip * (beam.length / (beam.c2 + beam.c4));
}

/// Where a leaf reads the texture of wind on the planes xy, yz and xz of the world.
SHARED_FUNCTION vec2 windUv(MotionMoment moment, vec3 stalk, int plane) {
  vec3 p = stalk * moment.planes.w;
  if (plane == 0) return vec2(p.x - moment.scroll.x, p.y - moment.scroll.y);
  if (plane == 1) return vec2(p.y - moment.scroll.z + 0.33f, p.z - moment.scroll.w);
  return vec2(p.x - moment.drift.x, p.z - moment.drift.y + 0.33f);
}

/// 4.7: how a leaf is bent and twisted: tangents of half the angles.
SHARED_FUNCTION vec2 leafTurns(MotionLeaf leaf, vec3 toward, float speed, vec2 noise) {
  float push = speed * speed;
  vec2 turns = push * vec2(leaf.flutter * noise.x + leaf.lean * dot(leaf.normal, toward),
                           leaf.twist * noise.y);
  vec2 squares = turns * turns * (1.0f / (kMostLeafTurn * kMostLeafTurn));
  return vec2(turns.x / sqrt(1.0f + squares.x), turns.y / sqrt(1.0f + squares.y));
}

/// A turn about `pivot` from t towards `aside` by an angle, of whose half it takes the tangent.
SHARED_FUNCTION BeamPose poseOfTurn(vec3 pivot, vec3 t, vec3 aside, float half_tangent) {
  float square = half_tangent * half_tangent;
  BeamPose pose;
  pose.pivot = pivot;
  pose.offset = vec3(0.0f, 0.0f, 0.0f);
  pose.t = t;
  pose.aside = aside;
  pose.cosine = (1.0f - square) / (1.0f + square);
  pose.sine = 2.0f * half_tangent / (1.0f + square);
  return pose;
}

/// A vertex as it moves.
struct MovedVertex {
  vec3 position;
  vec3 normal;
};

SHARED_FUNCTION MovedVertex posedVertex(BeamPose pose, MovedVertex vertex) {
  MovedVertex moved;
  moved.position = posedPoint(pose, vertex.position);
  moved.normal = posedVector(pose, vertex.normal);
  return moved;
}

/// A leaf as a stiff plate, twisted about its axis, then bent at its stalk: it cannot tear.
SHARED_FUNCTION MovedVertex turnedLeaf(MotionLeaf leaf, vec2 turns, MovedVertex vertex) {
  vec3 across = cross(leaf.axis, leaf.normal);
  MovedVertex twisted = posedVertex(poseOfTurn(leaf.stalk, leaf.normal, across, turns.y), vertex);
  return posedVertex(poseOfTurn(leaf.stalk, leaf.axis, leaf.normal, turns.x), twisted);
}

/// What hangs at `place` of one bent branch; its carriers are next.
SHARED_FUNCTION MovedVertex bentByBeam(MotionBeam beam, float place, vec2 amplitudes,
                                       MovedVertex vertex) {
  BeamFrame frame;
  frame.root = beam.root;
  frame.length = beam.length;
  frame.t = beam.t;
  frame.r = beam.r;
  frame.s = cross(beam.t, beam.r);
  return posedVertex(poseOfBeam(frame, vec2(beam.c2, beam.c4), place, amplitudes), vertex);
}

SHARED_END

#endif  // VERDURE_SHARED_SWAY_H_
