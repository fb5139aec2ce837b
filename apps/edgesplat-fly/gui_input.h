// Passes user input to Dear ImGui.
#pragma once

#include "apps/edgesplat-fly/input.h"

/// Call once, after the context was created.
void prepare_gui_input();
/// Call before every ImGui::NewFrame.
void feed_gui(const Input& input);
