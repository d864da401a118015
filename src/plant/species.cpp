#include "plant/species.h"

#include "verdure/error.h"

namespace verdure {
namespace {

const char* const kPaper =
    "Weber and Penn, Creation and Rendering of Realistic Trees, SIGGRAPH 1995, appendix";
const char* const kOwn = "verdure, by the parameters of Weber and Penn 1995";

// Tables by the paper's names. The paper's four species start from its published table, whole, and
// a second table gives what this library changes. The reasons are the same for all: the published
// leaf counts and sizes were chosen for flat leaves seen from afar (the willow alone has over a
// million), LeafShape numbers other leaves here, which LeafScaleX should not stretch, the heights
// vary too much to be of use (the oak's from 0 to 20 m), and stems need more segments to look
// smooth from near. Leaves are larger than life, up to twice, so that fewer fill the crown.

Species quakingAspen() {
  Species s;
  s.info = {"quaking-aspen", "Quaking aspen (Populus tremuloides)", kPaper};
  setParameters(
      s.parameters,
      "Shape=7 BaseSize=0.4 Scale=13 ScaleV=3 ZScale=1 ZScaleV=0 Levels=3 "
      "Ratio=0.015 RatioPower=1.2 Lobes=5 LobeDepth=0.07 Flare=0.6 "
      "0Scale=1 0ScaleV=0 0Length=1 0LengthV=0 0Taper=1 0BaseSplits=0 "
      "0SegSplits=0 0SplitAngle=0 0SplitAngleV=0 "
      "0CurveRes=3 0Curve=0 0CurveBack=0 0CurveV=20 "
      "1DownAngle=60 1DownAngleV=-50 1Rotate=140 1RotateV=0 1Branches=50 "
      "1Length=0.3 1LengthV=0 1Taper=1 1CurveRes=5 1Curve=-40 1CurveBack=0 1CurveV=50 "
      "2DownAngle=45 2DownAngleV=10 2Rotate=140 2RotateV=0 2Branches=30 "
      "2Length=0.6 2LengthV=0 2Taper=1 2CurveRes=3 2Curve=-40 2CurveBack=0 2CurveV=75 "
      "3DownAngle=45 3DownAngleV=10 3Rotate=77 3RotateV=0 3Branches=10 "
      "3Length=0 3LengthV=0 3Taper=1 3CurveRes=1 3Curve=0 3CurveBack=0 3CurveV=0 "
      "Leaves=25 LeafShape=0 LeafScale=0.17 LeafScaleX=1 AttractionUp=0.5 "
      "PruneRatio=0 PruneWidth=0.5 PruneWidthPeak=0.5 PrunePowerLow=0.5 PrunePowerHigh=0.5");
  // More and smaller leaves; the crown begins where the paper's picture shows it.
  setParameters(s.parameters,
                "BaseSize=0.3 ScaleV=1.5 0CurveRes=10 1CurveRes=7 2CurveRes=4 "
                "Leaves=42 LeafByLength=1 LeafShape=1 LeafScale=0.185 LeafScaleX=0.57");
  s.bark = {BarkKind::kLenticels,
            {0.80f, 0.79f, 0.70f},
            {0.17f, 0.15f, 0.13f},
            {0.73f, 0.71f, 0.61f},
            0.8f,
            0.9f};
  s.blade = {14, 25};
  s.twig_radius = 0.012f;
  s.twig_tint = {0.30f, 0.22f, 0.15f};
  return s;
}

Species blackTupelo() {
  Species s;
  s.info = {"black-tupelo", "Black tupelo (Nyssa sylvatica)", kPaper};
  setParameters(
      s.parameters,
      "Shape=4 BaseSize=0.2 Scale=23 ScaleV=5 ZScale=1 ZScaleV=0 Levels=4 "
      "Ratio=0.015 RatioPower=1.3 Lobes=3 LobeDepth=0.1 Flare=1 "
      "0Scale=1 0ScaleV=0 0Length=1 0LengthV=0 0Taper=1.1 0BaseSplits=0 "
      "0SegSplits=0 0SplitAngle=0 0SplitAngleV=0 "
      "0CurveRes=10 0Curve=0 0CurveBack=0 0CurveV=40 "
      "1DownAngle=60 1DownAngleV=-40 1Rotate=140 1RotateV=0 1Branches=50 "
      "1Length=0.3 1LengthV=0.05 1Taper=1 1CurveRes=10 1Curve=0 1CurveBack=0 1CurveV=90 "
      "2DownAngle=30 2DownAngleV=10 2Rotate=140 2RotateV=0 2Branches=25 "
      "2Length=0.6 2LengthV=0.1 2Taper=1 2CurveRes=10 2Curve=-10 2CurveBack=0 2CurveV=150 "
      "3DownAngle=45 3DownAngleV=10 3Rotate=140 3RotateV=0 3Branches=12 "
      "3Length=0.4 3LengthV=0 3Taper=1 3CurveRes=1 3Curve=0 3CurveBack=0 3CurveV=0 "
      "Leaves=6 LeafShape=0 LeafScale=0.3 LeafScaleX=0.5 AttractionUp=0.5 "
      "PruneRatio=0 PruneWidth=0.5 PruneWidthPeak=0.5 PrunePowerLow=0.5 PrunePowerHigh=0.5");
  // A middle-aged tree, whose crown the leaves can fill.
  setParameters(s.parameters,
                "Scale=18 ScaleV=2 2Branches=18 2CurveRes=6 3Branches=10 "
                "Leaves=9 LeafByLength=1 LeafScale=0.22 LeafScaleX=0.41");
  s.bark = {BarkKind::kBlocks,
            {0.46f, 0.41f, 0.36f},
            {0.15f, 0.13f, 0.11f},
            {0.56f, 0.53f, 0.47f},
            2.0f,
            0.5f};
  s.blade = {18, 40};
  return s;
}

Species weepingWillow() {
  Species s;
  s.info = {"weeping-willow", "Weeping willow (Salix babylonica)", kPaper};
  setParameters(
      s.parameters,
      "Shape=3 BaseSize=0.05 Scale=15 ScaleV=5 ZScale=1 ZScaleV=0 Levels=4 "
      "Ratio=0.03 RatioPower=2 Lobes=9 LobeDepth=0.03 Flare=0.75 "
      "0Scale=1 0ScaleV=0 0Length=0.8 0LengthV=0 0Taper=1 0BaseSplits=2 "
      "0SegSplits=0.1 0SplitAngle=3 0SplitAngleV=0 "
      "0CurveRes=8 0Curve=0 0CurveBack=20 0CurveV=120 "
      "1DownAngle=20 1DownAngleV=10 1Rotate=-120 1RotateV=30 1Branches=25 "
      "1Length=0.5 1LengthV=0.1 1Taper=1 1SegSplits=0.2 1SplitAngle=30 1SplitAngleV=10 "
      "1CurveRes=16 1Curve=40 1CurveBack=80 1CurveV=90 "
      "2DownAngle=30 2DownAngleV=10 2Rotate=-120 2RotateV=30 2Branches=10 "
      "2Length=1.5 2LengthV=0 2Taper=1 2SegSplits=0.2 2SplitAngle=45 2SplitAngleV=20 "
      "2CurveRes=12 2Curve=0 2CurveBack=0 2CurveV=0 "
      "3DownAngle=20 3DownAngleV=10 3Rotate=140 3RotateV=0 3Branches=300 "
      "3Length=0.1 3LengthV=0 3Taper=1 3CurveRes=1 3Curve=0 3CurveBack=0 3CurveV=0 "
      "Leaves=15 LeafShape=0 LeafScale=0.12 LeafScaleX=0.2 AttractionUp=-3 "
      "PruneRatio=1 PruneWidth=0.4 PruneWidthPeak=0.6 PrunePowerLow=0.001 PrunePowerHigh=0.5");
  // Few long whips (level 3) instead of thousands of short ones, and trunks that part visibly.
  setParameters(s.parameters,
                "Scale=14 ScaleV=1.5 Ratio=0.025 RatioPower=1.8 0Length=0.72 "
                "0SegSplits=0 0SplitAngle=22 1Branches=12 1SegSplits=0.05 1CurveRes=12 "
                "2Branches=9 2Length=0.75 2SegSplits=0.05 2CurveRes=8 2CurveV=60 "
                "3DownAngle=40 3Branches=6 3Length=0.7 3LengthV=0.25 3CurveRes=4 3CurveV=40 "
                "Leaves=21 LeafByLength=1 LeafShape=2 LeafScale=0.245 LeafScaleX=0.16 LeafBend=0.1 "
                "AttractionUp=-2");
  s.bark = {BarkKind::kFurrows,
            {0.47f, 0.42f, 0.34f},
            {0.16f, 0.13f, 0.10f},
            {0.52f, 0.52f, 0.42f},
            2.2f,
            0.7f};
  s.blade = {16, 35};
  s.twig_radius = 0.008f;
  s.twig_tint = {0.95f, 1.0f, 0.45f};
  return s;
}

Species blackOak() {
  Species s;
  s.info = {"black-oak", "California black oak (Quercus kelloggii)", kPaper};
  setParameters(
      s.parameters,
      "Shape=2 BaseSize=0.05 Scale=10 ScaleV=10 ZScale=1 ZScaleV=0 Levels=3 "
      "Ratio=0.018 RatioPower=1.3 Lobes=5 LobeDepth=0.1 Flare=1.2 "
      "0Scale=1 0ScaleV=0 0Length=1 0LengthV=0 0Taper=0.95 0BaseSplits=2 "
      "0SegSplits=0.4 0SplitAngle=10 0SplitAngleV=0 "
      "0CurveRes=8 0Curve=0 0CurveBack=0 0CurveV=90 "
      "1DownAngle=30 1DownAngleV=-30 1Rotate=80 1RotateV=0 1Branches=40 "
      "1Length=0.8 1LengthV=0.1 1Taper=1 1SegSplits=0.2 1SplitAngle=10 1SplitAngleV=10 "
      "1CurveRes=10 1Curve=40 1CurveBack=-70 1CurveV=150 "
      "2DownAngle=45 2DownAngleV=10 2Rotate=140 2RotateV=0 2Branches=120 "
      "2Length=0.2 2LengthV=0.05 2Taper=1 2SegSplits=0.1 2SplitAngle=10 2SplitAngleV=10 "
      "2CurveRes=3 2Curve=0 2CurveBack=0 2CurveV=-30 "
      "3DownAngle=45 3DownAngleV=10 3Rotate=140 3RotateV=0 3Branches=0 "
      "3Length=0.4 3LengthV=0 3Taper=1 3CurveRes=1 3Curve=0 3CurveBack=0 3CurveV=0 "
      "Leaves=25 LeafShape=0 LeafScale=0.12 LeafScaleX=0.66 AttractionUp=0.8 "
      "PruneRatio=0 PruneWidth=0.5 PruneWidthPeak=0.5 PrunePowerLow=0.5 PrunePowerHigh=0.5");
  // Splits double all that grows above them: here the base splits alone, with shorter boughs that
  // do not sweep the ground.
  setParameters(
      s.parameters,
      "BaseSize=0.2 Scale=11 ScaleV=1.5 0SegSplits=0 0SplitAngle=20 "
      "1Branches=15 1Length=0.55 1SegSplits=0.1 1Curve=28 1CurveBack=-60 1CurveV=90 "
      "2Branches=44 2Length=0.28 2CurveRes=4 2CurveV=60 "
      "Leaves=21 LeafByLength=1 LeafShape=3 LeafScale=0.187 LeafScaleX=0.7 AttractionUp=0.6");
  s.bark = {BarkKind::kFurrows,
            {0.40f, 0.36f, 0.32f},
            {0.11f, 0.09f, 0.08f},
            {0.47f, 0.48f, 0.42f},
            2.6f,
            0.6f};
  s.blade = {12, 30};
  return s;
}

Species japaneseMaple() {
  Species s;
  s.info = {"japanese-maple", "Japanese maple (Acer palmatum)", kOwn};
  setParameters(s.parameters,
                "Shape=2 BaseSize=0.15 Scale=5 ScaleV=0.5 Levels=4 Ratio=0.022 RatioPower=1.3 "
                "Lobes=4 LobeDepth=0.06 Flare=0.5 "
                "0Length=0.8 0Taper=1 0BaseSplits=3 0SplitAngle=38 0SplitAngleV=6 0CurveRes=8 "
                "0Curve=0 0CurveV=90 "
                "1DownAngle=50 1DownAngleV=12 1Rotate=140 1RotateV=20 1Branches=11 1Length=0.5 "
                "1LengthV=0.08 1Taper=1 1SegSplits=0.15 1SplitAngle=35 1SplitAngleV=8 1CurveRes=8 "
                "1Curve=35 1CurveV=120 "
                "2DownAngle=50 2DownAngleV=12 2Rotate=-150 2RotateV=25 2Branches=13 2Length=0.45 "
                "2LengthV=0.08 2Taper=1 2CurveRes=6 2Curve=-10 2CurveV=90 "
                "3DownAngle=48 3DownAngleV=12 3Rotate=-150 3RotateV=25 3Branches=6 3Length=0.4 "
                "3LengthV=0.05 3Taper=1 3CurveRes=3 3CurveV=60 "
                "Leaves=18 LeafByLength=1 LeafShape=4 LeafScale=0.11 LeafScaleX=1 LeafBend=0.75 "
                "AttractionUp=-0.15 PruneRatio=1 PruneWidth=0.52 PruneWidthPeak=0.35 "
                "PrunePowerLow=0.3 PrunePowerHigh=0.6");
  s.bark = {BarkKind::kSmooth,
            {0.46f, 0.43f, 0.38f},
            {0.29f, 0.26f, 0.23f},
            {0.50f, 0.50f, 0.43f},
            0.9f,
            0.35f};
  s.blade = {8, 40};
  s.twig_radius = 0.006f;
  s.twig_tint = {0.9f, 0.35f, 0.3f};
  return s;
}

Species scotsPine() {
  Species s;
  s.info = {"scots-pine", "Scots pine (Pinus sylvestris)", kOwn};
  // A leaf is a shoot of 0.17 m with its needles.
  setParameters(s.parameters,
                "Shape=1 BaseSize=0.42 Scale=14 ScaleV=1.5 Levels=4 Ratio=0.014 RatioPower=1.25 "
                "Lobes=5 LobeDepth=0.04 Flare=0.5 "
                "0Length=1 0Taper=1 0CurveRes=12 0CurveV=45 "
                "1DownAngle=78 1DownAngleV=-32 1Rotate=140 1RotateV=20 1Branches=36 1Length=0.27 "
                "1LengthV=0.07 1Taper=1 1SegSplits=0.06 1SplitAngle=30 1SplitAngleV=10 1CurveRes=8 "
                "1Curve=-25 1CurveV=130 "
                "2DownAngle=52 2DownAngleV=14 2Rotate=140 2RotateV=25 2Branches=16 2Length=0.42 "
                "2LengthV=0.08 2Taper=1 2CurveRes=5 2Curve=-30 2CurveV=90 "
                "3DownAngle=42 3DownAngleV=12 3Rotate=140 3RotateV=20 3Branches=6 3Length=0.42 "
                "3LengthV=0.08 3Taper=1 3CurveRes=3 3Curve=-30 3CurveV=40 "
                "Leaves=9 LeafByLength=0.7 LeafShape=7 LeafScale=0.17 LeafScaleX=0.67 LeafBend=0 "
                "AttractionUp=0.9");
  s.bark = {BarkKind::kPlates,
            {0.60f, 0.37f, 0.23f},
            {0.19f, 0.11f, 0.08f},
            {0.66f, 0.49f, 0.36f},
            1.8f,
            0.7f};
  s.alpha_cutoff = 0.4f;
  return s;
}

Species silverBirch() {
  Species s;
  s.info = {"silver-birch", "Silver birch (Betula pendula)", kOwn};
  setParameters(
      s.parameters,
      "Shape=4 BaseSize=0.22 Scale=14 ScaleV=1.5 Levels=4 Ratio=0.0115 RatioPower=1.35 "
      "Lobes=5 LobeDepth=0.03 Flare=0.5 "
      "0Length=1 0Taper=1 0CurveRes=12 0CurveV=45 "
      "1DownAngle=48 1DownAngleV=-18 1Rotate=140 1RotateV=20 1Branches=34 1Length=0.32 "
      "1LengthV=0.05 1Taper=1 1CurveRes=9 1Curve=30 1CurveV=70 "
      "2DownAngle=42 2DownAngleV=12 2Rotate=140 2RotateV=30 2Branches=18 2Length=0.42 "
      "2LengthV=0.1 2Taper=1 2CurveRes=7 2Curve=20 2CurveV=60 "
      "3DownAngle=58 3DownAngleV=18 3Rotate=140 3RotateV=20 3Branches=8 3Length=0.5 "
      "3LengthV=0.08 3Taper=1 3CurveRes=4 3CurveV=70 "
      "Leaves=17 LeafByLength=0.7 LeafShape=5 LeafScale=0.143 LeafScaleX=0.59 LeafBend=0.45 "
      "AttractionUp=-0.6");
  s.bark = {BarkKind::kPaper,
            {0.90f, 0.89f, 0.86f},
            {0.12f, 0.11f, 0.10f},
            {0.78f, 0.73f, 0.66f},
            0.8f,
            0.8f};
  s.blade = {16, 35};
  s.twig_radius = 0.014f;
  s.twig_tint = {0.16f, 0.085f, 0.06f};
  return s;
}

Species hedge() {
  Species s;
  s.info = {"hedge", "Hedge shrub, clipped (Ligustrum)", kOwn};
  setParameters(s.parameters,
                "Shape=3 BaseSize=0.04 Scale=1.7 ScaleV=0.1 Levels=4 Ratio=0.012 RatioPower=1.1 "
                "Flare=0.2 "
                "0Length=0.85 0Taper=1 0BaseSplits=10 0SplitAngle=42 0SplitAngleV=12 0CurveRes=24 "
                "0CurveV=90 "
                "1DownAngle=48 1DownAngleV=14 1Rotate=140 1RotateV=30 1Branches=11 1Length=0.5 "
                "1LengthV=0.1 1Taper=1 1CurveRes=6 1Curve=-30 1CurveV=80 "
                "2DownAngle=50 2DownAngleV=14 2Rotate=140 2RotateV=30 2Branches=9 2Length=0.45 "
                "2LengthV=0.1 2Taper=1 2CurveRes=4 2Curve=-20 2CurveV=60 "
                "3DownAngle=50 3DownAngleV=10 3Rotate=140 3RotateV=20 3Branches=5 3Length=0.45 "
                "3LengthV=0.05 3Taper=1 3CurveRes=2 3CurveV=30 "
                "Leaves=15 LeafShape=6 LeafScale=0.05 LeafScaleX=0.45 LeafBend=0.3 "
                "AttractionUp=0.8 "
                "PruneRatio=1 PruneWidth=0.48 PruneWidthPeak=0.5 PrunePowerLow=0.12 "
                "PrunePowerHigh=0.22");
  s.bark = {BarkKind::kSmooth,
            {0.43f, 0.38f, 0.31f},
            {0.24f, 0.20f, 0.16f},
            {0.47f, 0.45f, 0.38f},
            0.9f,
            0.12f};
  s.blade = {22, 20};
  return s;
}

}  // namespace

const std::vector<Species>& allSpecies() {
  static const std::vector<Species> list{quakingAspen(), blackTupelo(),   weepingWillow(),
                                         blackOak(),     japaneseMaple(), scotsPine(),
                                         silverBirch(),  hedge()};
  return list;
}

const Species& findSpecies(const std::string& name) {
  std::vector<std::string> names;
  for (const Species& species : allSpecies()) {
    if (species.info.name == name) return species;
    names.push_back(species.info.name);
  }
  throw Error("species " + name, "there is no such species",
              "the closest name is " + closestWord(name, names));
}

}  // namespace verdure
