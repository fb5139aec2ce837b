// Clip planes and boxes in the picture: dots that are dragged along their normals.
#pragma once

#include "apps/edgesplat-fly/app_state.h"
#include "apps/edgesplat-fly/pen.h"

/// Carries out a drag of a handle. Whether a handle has the mouse: then it is not for the eye.
bool clip_handles(AppState& state, const Input& input, bool over_picture);

void draw_clip_handles(AppState& state, const Pen& pen);
