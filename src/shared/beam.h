#ifndef VERDURE_SHARED_BEAM_H_
#define VERDURE_SHARED_BEAM_H_

#include "portable.h"

// A branch bent as a tapered beam: Habel, "Real-time Rendering and Animation of Vegetation",
// dissertation, TU Wien 2009, 4.4 and 4.6.
//
// Three things are done otherwise. A round branch bends in one plane, so the amplitudes along r and
// s are one vector. Cross sections turn with the axis, as do the branches that leave it: (4.23)
// moves them without turning them, which shears a branch and keeps a twig upright on a bough that
// hangs. And a point stays on the curve, at its own distance from the root along it: (4.9) takes
// the tangent's stretch for that of the whole way, which makes a branch whose tip goes half its
// length aside 9 % too short; here it is 0.4 %.

SHARED_BEGIN

/// A branch at rest: where it starts, its axis t and two directions across it, r and s
/// (orthonormal), and its length, m.
struct BeamFrame {
  vec3 root;
  float span;  ///< length, m
  vec3 t;
  vec3 r;
  vec3 s;
};

/// (4.8): the deflection at x in [0, 1] of the length by the two coefficients of fitBeam(), for an
/// amplitude of 1.
SHARED_FUNCTION float beamDeflection(vec2 fit, float x) {
  return (fit.x + fit.y * x * x) * x * x;
}
/// Its derivative by x.
SHARED_FUNCTION float beamSlope(vec2 fit, float x) {
  return (2.0f * fit.x + 4.0f * fit.y * x * x) * x;
}

/// By how much the bent axis up to x is longer than x, in lengths; `amplitude` in lengths, too:
/// the integral of u'^2 / (1 + sqrt(1 + u'^2)), its denominator that of 0.6 u'^2 at the end.
SHARED_FUNCTION float beamExcess(vec2 fit, float x, float amplitude) {
  float x2 = x * x, slope = amplitude * beamSlope(fit, x);
  float squares = (1.33333333f * fit.x * fit.x +
                   (3.2f * fit.x * fit.y + 2.28571429f * fit.y * fit.y * x2) * x2) *
                  x2 * x;
  return amplitude * amplitude * squares / (1.0f + sqrt(1.0f + 0.6f * slope * slope));
}

/// Where along t the point is that lies x along the bent axis, by two of Newton's steps: within 1 %
/// of the length up to tips that go 0.5 of it aside.
SHARED_FUNCTION float beamFoot(vec2 fit, float x, float amplitude) {
  float slope = amplitude * beamSlope(fit, x);
  float foot = x - beamExcess(fit, x, amplitude) / sqrt(1.0f + slope * slope);
  slope = amplitude * beamSlope(fit, foot);
  return foot - (foot + beamExcess(fit, foot, amplitude) - x) / sqrt(1.0f + slope * slope);
}

/// Where a cross section of a bent branch is: it has moved by `offset` and turned about `pivot`,
/// its place on the axis at rest, from t towards `aside`.
struct BeamPose {
  vec3 pivot;
  vec3 offset;
  vec3 t;
  vec3 aside;  ///< unit, across t: where the branch bends to
  float cosine;
  float sine;
};

/// At x in [0, 1] of a branch whose deflections along r and s are amplitudes u(x), m.
SHARED_FUNCTION BeamPose poseOfBeam(BeamFrame frame, vec2 fit, float x, vec2 amplitudes) {
  float amplitude = sqrt(dot(amplitudes, amplitudes));
  BeamPose pose;
  pose.pivot = frame.root + frame.t * (x * frame.span);
  pose.t = frame.t;
  pose.aside = amplitude > 0.0f
                   ? (frame.r * amplitudes.x + frame.s * amplitudes.y) * (1.0f / amplitude)
                   : frame.r;
  amplitude /= frame.span;
  float foot = beamFoot(fit, x, amplitude);
  float slope = amplitude * beamSlope(fit, foot);
  pose.offset =
      frame.span * (pose.aside * (amplitude * beamDeflection(fit, foot)) + frame.t * (foot - x));
  pose.cosine = 1.0f / sqrt(1.0f + slope * slope);
  pose.sine = slope * pose.cosine;
  return pose;
}

/// How far a vector is moved by the turn; exactly 0 without one.
SHARED_FUNCTION vec3 turnedBy(BeamPose pose, vec3 v) {
  float along = dot(pose.t, v), across = dot(pose.aside, v);
  return pose.t * (along * (pose.cosine - 1.0f) - across * pose.sine) +
         pose.aside * (along * pose.sine + across * (pose.cosine - 1.0f));
}
/// A point of the section at rest, or of what leaves it; itself, to the bit, without a bend.
SHARED_FUNCTION vec3 posedPoint(BeamPose pose, vec3 point) {
  return point + (pose.offset + turnedBy(pose, point - pose.pivot));
}
/// A direction: a normal, or an axis of a branch that leaves it.
SHARED_FUNCTION vec3 posedVector(BeamPose pose, vec3 v) {
  return v + turnedBy(pose, v);
}

SHARED_END

#endif  // VERDURE_SHARED_BEAM_H_
