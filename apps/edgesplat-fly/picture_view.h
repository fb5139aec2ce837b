// Draws the picture and its overlays: wipe divider, picks, ruler, scale bar, orientation, guided path.
#pragma once

#include "apps/edgesplat-fly/app_state.h"

/// Copies the drawer's newest picture to the canvas and to `state.shown`. Returns whether there was one.
bool take_pictures(AppState& state);

/// Places the pictures in state.area, lowest first.
void place_pictures(AppState& state);

/// Draws lines and labels over the pictures, in Dear ImGui's background list.
void draw_over_picture(AppState& state);
