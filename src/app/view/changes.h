#ifndef VERDURE_APP_VIEW_CHANGES_H_
#define VERDURE_APP_VIEW_CHANGES_H_

namespace verdure::app {

/// What must be done when a setting becomes another: the later ones include that it is drawn again.
enum class Change {
  kNothing,
  kPicture,  ///< draw again
  kMotion,   ///< find again how a plant answers wind
  kBake,     ///< bake a plant's light again
  kScene,    ///< load the scene again
};

inline Change& operator|=(Change& change, Change other) {
  if (other > change) change = other;
  return change;
}

}  // namespace verdure::app

#endif  // VERDURE_APP_VIEW_CHANGES_H_
