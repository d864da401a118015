#ifndef VERDURE_APP_VIEW_CHANGES_H_
#define VERDURE_APP_VIEW_CHANGES_H_

namespace verdure::app {

/// What must be done when a setting becomes another: each includes those before it.
enum class Change {
  kNothing,
  kPicture,  ///< draw again
  kBake,     ///< bake the plants' light again
  kScene,    ///< load the scene again
};

inline Change& operator|=(Change& change, Change other) {
  if (other > change) change = other;
  return change;
}

}  // namespace verdure::app

#endif  // VERDURE_APP_VIEW_CHANGES_H_
