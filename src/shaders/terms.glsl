// The specialisation constants: the terms of illumination model (1) and what a draw needs. A term
// that is off costs nothing. Numbered as in src/render/terms.h.
layout(constant_id = 0) const bool kAmbient = true;
layout(constant_id = 1) const bool kDiffuse = true;
layout(constant_id = 2) const bool kSpecular = true;
layout(constant_id = 3) const bool kShadow = true;
layout(constant_id = 4) const bool kTextures = true;
layout(constant_id = 5) const int kAmbientSource = 0;
layout(constant_id = 6) const bool kFormulaSky = false;
layout(constant_id = 7) const bool kBackground = false;  // takes the sky's place
layout(constant_id = 8) const bool kTransmission = false;
layout(constant_id = 9) const bool kFlipNormal = false;
layout(constant_id = 10) const bool kAlphaTest = false;
layout(constant_id = 11) const bool kNormalMap = false;
layout(constant_id = 12) const bool kGloss = false;
layout(constant_id = 13) const int kShadowSource = 0;
layout(constant_id = 14) const bool kFoliage = false;
layout(constant_id = 15) const bool kScattering = false;
layout(constant_id = 16) const bool kThicknessMap = false;
layout(constant_id = 17) const int kLeafModel = 0;
layout(constant_id = 18) const bool kStatedTransmission = false;  // DiffuseTransmission
layout(constant_id = 19) const bool kMoving = false;  // in wind
layout(constant_id = 20) const bool kForest = false;  // of a forest: fades, has a tint and haze
// AmbientSource of verdure/render.h.
const int kConstant = 0, kSky = 1, kBaked = 2, kTransfer = 3, kLeafVisibility = 4;
// ShadowSource.
const int kShadowMap = 0, kDepthPaper = 1, kDepthLayers = 2, kDepthOrdered = 3;
// LeafModel.
const int kLeafColor = 0, kLeafDiffuse = 1, kLeafMaps = 2;
