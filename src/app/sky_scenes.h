#ifndef VERDURE_APP_SKY_SCENES_H_
#define VERDURE_APP_SKY_SCENES_H_

#include "app/commands.h"
#include "app/page.h"
#include "base/progress.h"
#include "verdure/render.h"

namespace verdure::app {

/// Figures 5.6 and 5.7 of Habel 2009: a grown tree of the command's species, lit by transfer
/// vectors under Preetham's sky.
void addSkyScenes(const FiguresCommand& command, Page& page, Progress& progress,
                  Renderer& renderer);

}  // namespace verdure::app

#endif  // VERDURE_APP_SKY_SCENES_H_
