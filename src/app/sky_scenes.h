#ifndef VERDURE_APP_SKY_SCENES_H_
#define VERDURE_APP_SKY_SCENES_H_

#include "app/page.h"
#include "base/progress.h"
#include "verdure/render.h"

namespace verdure::app {

/// Figures 5.6 and 5.7 of Habel 2009: a grown tree, lit by transfer vectors under Preetham's sky.
void addSkyScenes(Page& page, Progress& progress, Renderer& renderer);

}  // namespace verdure::app

#endif  // VERDURE_APP_SKY_SCENES_H_
