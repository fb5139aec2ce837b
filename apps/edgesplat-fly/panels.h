// The panels: each one file. They show the state, and change it through the session or through wishes.
#pragma once

#include "apps/edgesplat-fly/app_state.h"

void file_panel(AppState& state);
void view_panel(AppState& state);
void scene_panel(AppState& state);
void quality_panel(AppState& state);
void path_panel(AppState& state);
void measure_panel(AppState& state);
void slices_window(AppState& state);
void status_line(AppState& state, double top, double height);
void help_window(AppState& state);
/// Progress while something is read, and what went wrong.
void notices(AppState& state);
