// Dear ImGui's side of what a person did.
#pragma once

#include "apps/edgesplat-fly/input.h"

/// Once, after the context is made.
void prepare_gui_input();
/// Before every ImGui::NewFrame.
void feed_gui(const Input& input);
