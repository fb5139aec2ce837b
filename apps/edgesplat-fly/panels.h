// The panels, one file each. They show the state and change it through the session or pending_requests.
#pragma once

#include <functional>

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
/// Shows the progress of reading, and errors.
void notices(AppState& state);

// Parts of the scene panel; they need an open session.
void histogram_panel(AppState& state);
/// The choice between materials and a transfer function.
void color_source(AppState& state);
void transfer_panel(AppState& state);
void materials_panel(AppState& state);
void lights_panel(AppState& state);
void effects_panel(AppState& state);
void clip_panel(AppState& state);
/// The scene's volumes: which are shown, and the matter of those beside the first.
void volumes_panel(AppState& state);
/// The labels of a segmentation; `Opened::samples` must exist.
void labels_panel(AppState& state);
/// A list of the presets of one kind.
void presets_choice(AppState& state, const char* label, edgesplat::PresetKind kind,
                    const std::function<void(const edgesplat::ScenePreset&)>& take);
