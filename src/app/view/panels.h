#ifndef VERDURE_APP_VIEW_PANELS_H_
#define VERDURE_APP_VIEW_PANELS_H_

#include <string>

#include "app/view/changes.h"
#include "app/view/view_session.h"

/// The parameters of a scene as panels: each edits the session's settings and tells it what that
/// changes.
namespace verdure::app {

/// What panels keep between frames and no scene file holds.
struct PanelState {
  std::size_t plant = 0;  ///< of the scene's, the one whose parameters are shown
  double hour = 12.0;     ///< of the day that is shown
  int branch = 0;         ///< of the plant's MotionTree
};

/// All of them, in the current ImGui window.
void drawPanels(ViewSession& session, PanelState& state);

// Parts of it.
Change plantPanel(ViewSession& session, PanelState& state);
Change bakePanel(ViewSession& session, const PanelState& state);
Change lightPanel(ViewSession& session);
Change skyPanel(SceneSettings& settings, PanelState& state);
Change exposurePanel(SceneSettings& settings, const ViewSession& session);
Change windPanel(ViewSession& session);
Change motionPanel(ViewSession& session, PanelState& state);
Change groundPanel(SceneSettings& settings);
void cameraPanel(ViewSession& session);
void timesPanel(const ViewSession& session);

}  // namespace verdure::app

#endif  // VERDURE_APP_VIEW_PANELS_H_
