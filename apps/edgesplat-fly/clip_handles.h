// Handles of clip planes and boxes in the picture, dragged along their normals.
#pragma once

#include "apps/edgesplat-fly/app_state.h"
#include "apps/edgesplat-fly/pen.h"

/// Drags a handle. Returns whether a handle uses the mouse, which then must not move the eye.
bool clip_handles(AppState& state, const Input& input, bool over_picture);

void draw_clip_handles(AppState& state, const Pen& pen);
