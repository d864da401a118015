#ifndef VERDURE_TESTS_SHARED_FUNCTIONS_H_
#define VERDURE_TESTS_SHARED_FUNCTIONS_H_

#include "shared/color.h"
#include "shared/cook_torrance.h"
#include "shared/density.h"
#include "shared/grass_blades.h"
#include "shared/illumination.h"
#include "shared/leaf_basis.h"
#include "shared/leaf_visibility.h"
#include "shared/sh.h"
#include "shared/sky.h"
#include "shared/sky_formula.h"
#include "shared/style.h"
#include "shared/sway.h"
#include "shared/tone.h"

// Every shared function of the renderer, called with eight numbers in [0, 1]: compiled as C++ and
// as GLSL, so that one test compares both.

SHARED_BEGIN

struct SharedResults {
  vec4 density;    // metaball, ambientCoefficient, length of encodeNormal, k of decodeNormal
  vec4 normal;     // direction of decodeNormal, hazeShare
  vec4 light;      // illumination, specularFactor
  vec4 sky;        // domeDirection, diffuseFactor
  vec4 transfer;   // srgbFromLinear, linearFromSrgb, ground's mean
  vec4 formula;    // skyLuminance
  vec4 harmonics;  // shIrradiance
  vec4 tone;       // toneMapped, ditheredLevel / 256
  vec4 dome;       // domeCoordinates, reinhard, luminanceOf
  vec4 white;      // automaticWhite / 10, luminanceBin / 512, luminanceInBin / 16
  vec4 leaf;       // visibilityShares, unpackVisibility of packVisibility
  vec4 basis;      // leafTranslucence, leafTransport
  vec4 through;    // leafBasis, leafDiffuseTranslucence
  vec4 gloss;      // shIrradianceAlong, cookTorrance
  vec4 direction;  // leafDirection, z of leafEvenDirection
  vec4 bent;       // bentByBeam of a position, x of its normal
  vec4 turned;     // turnedLeaf of a position, x of its normal
  vec4 driven;     // branchAmplitudes, leafTurns
  vec4 windy;      // gustySpeed / 10, motionUv, windUv's x
  vec4 grass;      // grassBend, plantsStanding, grassHeight
  vec4 shell;      // shellHeight, 1 / (1 + shellCrossing) both ways, slicePlace
  vec4 ribbon;     // ribbonPoint / 8 (Vulkan's sines may be off by 2^-11 each), ribbonWidth
  vec4 facing;     // squares of ribbonNormal / 32, wangPlace
  vec4 upright;    // meanFacing, sunThroughGrass
  vec4 terrain;    // drawnPlace / 100, bilinearHeight, rowFarthestFirst / 16
  vec4 strokes;    // firstDifference, secondDifference, profileStrength, creaseStrength
  vec4 tones;      // evenTone, lightness, blurredDepthTest, placeNoise
  vec4 layers;     // throughPigment, pigmentAtBorder times granulated
};
SHARED_SIZE(SharedResults, 448);

SHARED_FUNCTION SharedResults evaluateShared(vec4 a, vec4 b) {
  vec3 n = normalize(vec3(a.x - 0.5f, a.y - 0.5f, a.z - 0.45f));
  vec3 l = normalize(vec3(b.x - 0.5f, b.y - 0.5f, b.z - 0.45f));
  vec3 v = normalize(vec3(a.w - 0.5f, b.w - 0.5f, 0.6f));
  float k = ambientCoefficient(6.0f * a.x - 1.0f, 0.5f + 3.0f * a.y, 0.9f * a.z, 0.3f + 3.0f * a.w);
  vec3 encoded = encodeNormal(n, k);
  vec4 decoded = decodeNormal(encoded);
  float diffuse = diffuseFactor(n, l);
  float specular = specularFactor(n, l, v, 1.0f + 20.0f * b.x);
  vec3 color = vec3(a.w, b.w, b.z);
  vec3 lit = illumination(vec3(0.4f, 0.5f, 0.6f) * k, vec3(1.7f, 1.6f, 1.4f), vec3(b.y),
                          color * diffuse, 0.06f, specular);
  vec3 dome = domeDirection(l);
  vec3 mean = groundMeanColor();
  SharedResults r;
  r.density = vec4(metaball(1.2f * a.x), k, length(encoded), decoded.w);
  r.normal = vec4(decoded.x, decoded.y, decoded.z, hazeShare(300.0f * a.x, 20.0f + 50.0f * a.y));
  r.light = vec4(lit, specular);
  r.sky = vec4(dome, diffuse);
  r.transfer = vec4(srgbFromLinear(a.x), linearFromSrgb(a.x), mean.x, mean.y + mean.z);
  SkyFormula formula;
  formula.sun = vec4(n.x, n.y, n.z, 0.0f);
  formula.a = vec4(-1.1f + a.x, -0.3f, -0.3f, 0.0f);
  formula.b = vec4(-0.2f - b.x, -0.2f, -0.3f, 0.0f);
  formula.c = vec4(10.0f * b.y, 0.21f, 0.19f, 0.0f);
  formula.d = vec4(-3.0f + b.z, -1.1f, -1.8f, 0.0f);
  formula.e = vec4(0.5f * a.w, 0.03f, 0.01f, 0.0f);
  formula.one = vec4(1.0f, 1.0f, 1.0f, 0.0f);
  formula.scale = vec4(0.03f, 0.27f, 0.28f, 0.0f);
  r.formula = vec4(skyLuminance(l, formula), 0.0f);
  vec4 weights[9];
  for (int i = 0; i < 9; ++i) {
    weights[i] = a * (1.0f - 0.21f * float(i)) + b * (0.17f * float(i) - 0.6f);
  }
  r.harmonics = vec4(shIrradiance(n, weights), 0.0f);
  vec3 bright = vec3(4.0f * a.x * a.x, 9.0f * a.y * a.y, 4.0f * a.z * a.z);
  vec2 at = domeCoordinates(dome);
  r.tone = vec4(toneMapped(bright, 1.0f + 4.0f * b.w),
                ditheredLevel(floor(256.0f * b.x) / 255.0f, b.y) / 256.0f);
  r.dome = vec4(at.x, at.y, reinhard(9.0f * a.y, 0.5f + b.w), luminanceOf(bright));
  r.white = vec4(automaticWhite(8.0f * a.x) / 10.0f,
                 float(luminanceBin(exp2(floor(40.0f * a.y) - 20.0f + 0.0625f))) / 512.0f,
                 luminanceInBin(200 + int(88.0f * b.x), b.y) / 16.0f, 0.0f);
  vec2 shares = visibilityShares(vec2(a.x, b.x), a.y < b.y, 0.1f + 4.0f * a.z);
  vec2 packed_seen = unpackVisibility(float(packVisibility(vec2(a.w, 1.2f * b.w))));
  r.leaf = vec4(shares.x, shares.y, packed_seen.x, packed_seen.y);
  vec3 behind = vec3(l.x, l.y, -abs(l.z));
  vec3 coefficients = 2.0f * n + vec3(0.6f);
  vec3 basis = leafBasis(vec3(l.x, l.y, abs(l.z)));
  r.basis = vec4(leafTranslucence(vec3(1.5f, 1.2f, 0.9f), color, coefficients, behind),
                 leafTransport(coefficients, behind));
  r.gloss = vec4(shIrradianceAlong(n, n + 0.5f * l, weights),
                 cookTorrance(n, l, v, 0.1f + 0.4f * a.x, 1.2f + 0.5f * b.y));
  r.direction = vec4(leafDirection(coefficients), leafEvenDirection(coefficients).z);
  r.through = vec4(basis, leafDiffuseTranslucence(vec3(2.0f), color, a.x, behind).y);

  MotionBeam beam;
  beam.root = vec3(a.x, a.y, a.z);
  beam.span = 0.5f + a.w;
  beam.t = n;
  beam.r = normalize(cross(n, vec3(0.3f, 0.5f, 0.8f)));
  beam.c2 = 0.3f;
  beam.c4 = -0.1f + 0.1f * b.x;
  MotionDrive drive;
  drive.trajectory.offset = uvec2(uint(a.x * 4.0e9f), uint(a.y * 4.0e9f));
  drive.trajectory.velocity = uvec2(uint(a.z * 4.0e7f), uint(a.w * 1.0e6f));
  drive.mean = 0.002f * b.y;
  drive.swing = 0.001f * b.z;
  MovedVertex vertex;
  vertex.position = vec3(b.x, b.y, b.z);
  vertex.normal = l;
  vec2 amplitudes = branchAmplitudes(beam, drive, l, 12.0f * b.w, vec2(a.x - 0.5f, b.x - 0.5f));
  MovedVertex bent = bentByBeam(beam, b.w, amplitudes, vertex);
  r.bent = vec4(bent.position, bent.normal.x);
  MotionLeaf leaf;
  leaf.stalk = vec3(a.x, a.y, a.z);
  leaf.axis = n;
  leaf.normal = beam.r;
  leaf.flutter = 0.01f * b.x;
  leaf.lean = 0.01f * b.y;
  leaf.twist = 0.01f * b.z;
  vec2 turns = leafTurns(leaf, l, 12.0f * a.w, vec2(b.x - 0.5f, b.y - 0.5f));
  MovedVertex turned = turnedLeaf(leaf, turns, vertex);
  r.turned = vec4(turned.position, turned.normal.x);
  r.driven = vec4(amplitudes.x, amplitudes.y, turns.x, turns.y);
  MotionMoment moment;
  moment.toward = vec4(l, 10.0f * a.x);
  moment.gust_phase = a;
  moment.gust_wave = 0.1f * b;
  moment.scroll = b;
  moment.drift = vec4(b.x, b.y, a.y, a.z);
  moment.planes = vec4(0.5f, 0.5f, 0.7f, 0.1f);
  vec2 way = branchUv(drive, uvec2(7u, 11u), uint(1.0e5f * b.w), b.z);
  r.windy = vec4(0.1f * gustySpeed(moment, 30.0f * n), way.x, way.y,
                 windUv(moment, vertex.position, int(2.99f * a.w)).x);

  vec2 grass_bend = grassBend(moment, 30.0f * n, vec2(a.x, b.x) * 2.0f - vec2(1.0f));
  r.grass = vec4(grass_bend.x, grass_bend.y, plantsStanding(a.y, b.y, 0.05f + 0.9f * a.z),
                 grassHeight(a.w));
  ShellPath path = shellPath(0.4f, 0.2f + 0.3f * a.x, 0.5f * b.x, 1.0f + a.y);
  r.shell = vec4(shellHeight(path, b.y), 1.0f / (1.0f + shellCrossing(path, 0.1f, false)),
                 1.0f / (1.0f + shellCrossing(path, 0.45f, true)),
                 slicePlace(int(90.0f * a.z), uint(4.0e9f * a.w), 0.6f, 1u) / 100.0f);
  GrassRibbonPart part;
  part.size = vec4(0.1f + a.x, 0.3f, 0.01f, 0.05f);
  part.turn = vec4(0.3f * a.y, 0.1f, 1.2f * b.y, 0.4f);
  part.root = vec4(0.05f, 0.1f, 0.02f, 0.15f);
  part.tip = vec4(0.1f, 0.2f, 0.04f, 0.6f);
  part.kind = uvec4(uint(2.99f * a.w), 1u, 3u, 1u);
  GrassRibbonPart stalk = part;
  stalk.kind = uvec4(kRibbonStalk, 0u, 1u, 0u);
  GrassRibbon ribbon = ribbonOf(part, stalk, vec3(b.x, 0.0f, b.z), uint(4.0e9f * b.w), 1u);
  r.ribbon =
      vec4(ribbonPoint(ribbon, a.z) * 0.125f, 100.0f * ribbonWidth(ribbon.profile, 0.01f, a.z));
  vec3 facing = ribbonNormal(ribbon, a.z, 2.0f * b.y - 1.0f, v);  // edge-on, either side may face
  r.facing = vec4(facing * facing * 0.03125f,
                  wangPlace(uint(1.0e6f * a.x), uint(1.0e6f * a.y), b.z, kBorderOfGround));
  r.upright = vec4(meanFacing(v, l, a.x),
                   sunThroughGrass(a.y, l, vec4(0.8f, 0.6f, -0.6f, 0.8f), vec2(0.05f, 0.08f)));
  TerrainNode node;
  node.corner = vec2(-32.0f, 16.0f);
  node.cell_m = 2.0f;
  node.morph_begin_m = 40.0f;
  node.morph_end_m = 70.0f;
  vec2 drawn = drawnPlace(node, uvec2(uint(15.99f * a.x), uint(15.99f * a.y)),
                          vec3(60.0f * b.x, 3.0f, 60.0f * b.z), vec2(0.0f, 9.0f));
  TerrainCell cell = terrainCell(100.0f * vec2(b.y, b.w), vec2(20.0f), vec2(3.0f), uvec2(17u, 9u));
  r.terrain = vec4(drawn.x / 100.0f, drawn.y / 100.0f, bilinearHeight(a, cell.share),
                   float(rowFarthestFirst(uint(15.99f * a.z), 16u, 20.0f * b.x - 2.0f)) / 16.0f);
  float depths[9];
  for (int i = 0; i < 9; ++i) {
    depths[i] = 0.3f + 0.05f * a.x * float(i % 3) + (i > 5 ? 0.1f * a.y : 0.0f) + 0.02f * b[i % 4];
  }
  float first = firstDifference(depths), second = secondDifference(depths);
  r.strokes = vec4(first, second, profileStrength(first, second, depths[4]),
                   creaseStrength(first, second, depths[4], 0.01f));
  r.tones = vec4(evenTone(a.x, 0.02f + 0.1f * a.y, vec2(0.4f, 0.7f), vec3(0.3f, 0.6f, 1.0f)),
                 lightness(a.z, 0.5f + b.x), blurredDepthTest(0.2f + a.w, 0.2f + b.w, 0.3f),
                 placeNoise(30.0f * n, 0.05f + 4.0f * b.y));
  r.layers = vec4(throughPigment(color, 2.0f * b.x),
                  pigmentAtBorder(4.0f * a.x, 2.0f) * granulated(b.y, 0.6f));
  return r;
}

SHARED_END

#endif  // VERDURE_TESTS_SHARED_FUNCTIONS_H_
