// Lines and text over the picture.
#pragma once

#include <imgui.h>

#include <string>

#include "apps/edgesplat-fly/app_state.h"

inline constexpr ImU32 kInk = IM_COL32(255, 255, 255, 230), kShade = IM_COL32(0, 0, 0, 160);

inline ImVec2 to_im(const glm::dvec2& p) {
    return {static_cast<float>(p.x), static_cast<float>(p.y)};
}

/// Draws in pixels of the picture, below all panels. Everything has a dark outline, so that it is visible on any
/// background.
struct Pen {
    ImDrawList* list;
    glm::dvec2 corner;
    double em;

    void line(const glm::dvec2& a, const glm::dvec2& b, ImU32 color, double width = 1.5) const {
        list->AddLine(to_im(corner + a), to_im(corner + b), kShade, static_cast<float>(width + 2));
        list->AddLine(to_im(corner + a), to_im(corner + b), color, static_cast<float>(width));
    }
    void dot(const glm::dvec2& at, double radius, ImU32 color) const {
        list->AddCircleFilled(to_im(corner + at), static_cast<float>(radius + 1.5), kShade);
        list->AddCircleFilled(to_im(corner + at), static_cast<float>(radius), color);
    }
    void text(const glm::dvec2& at, const std::string& words, ImU32 color = kInk) const {
        const ImVec2 p = to_im(corner + at);
        list->AddText({p.x + 1, p.y + 1}, kShade, words.c_str());
        list->AddText(p, color, words.c_str());
    }
};

/// A line between world points; not drawn if an end is behind the eye or far outside the picture.
void world_line(const AppState& state, const Pen& pen, const glm::dvec3& a, const glm::dvec3& b, ImU32 color,
                double width = 1.5);
