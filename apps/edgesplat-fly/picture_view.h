// The picture itself, and what is drawn over it: the wipe's divider, picks, ruler, scale bar, orientation, guided path.
#pragma once

#include "apps/edgesplat-fly/app_state.h"

/// Takes what the drawer has finished and brings it to the canvas. Whether there was something: it is in
/// `state.shown`.
bool take_pictures(AppState& state);

/// Places the pictures in state.area, lowest first.
void place_pictures(AppState& state);

/// Lines and signs over them, through Dear ImGui's background list.
void draw_over_picture(AppState& state);
