// A plot over the volume's values: their histogram, and what is set up over them.
#pragma once

#include <imgui.h>

#include "apps/edgesplat-fly/app_state.h"
#include "engine/viewer/transfer_edit.h"

/// Values go across, extinctions up; at the bottom a strip for the handles of iso-values.
struct ValuePlot {
    ImDrawList* list = nullptr;
    glm::dvec2 corner{0}, size{1};  ///< pixels of the window
    double strip = 0;               ///< its height
    double low = 0, high = 1;       ///< values at the sides
    edgesplat::viewer::ExtinctionScale scale;
    glm::dvec2 mouse{0};
    // What the mouse does with it in this frame.
    bool hovered = false, held = false, pressed = false, twice = false, right = false;

    double x_of(double value) const { return corner.x + (value - low) / (high - low) * size.x; }
    double bottom() const { return corner.y + size.y - strip; }
    double y_of(double extinction) const { return bottom() - scale.share(extinction) * (size.y - strip); }
    /// In steps of a pixel or less, so that the numbers of a saved scene are short.
    double value_at(double x) const;
    double extinction_at(double y) const;
};

/// Makes the widget, `name` for scripts, and paints its ground and the histogram once there is one.
ValuePlot value_plot(AppState& state, const char* name);

/// Extinction and colour of a transfer function under its curve.
void paint_transfer(const ValuePlot& plot, const edgesplat::viewer::TransferPoints& points);
/// A dot on it.
void paint_point(const ValuePlot& plot, const edgesplat::TransferPoint& point, bool chosen, double em);
/// A line with a handle in the strip.
void paint_iso(const ValuePlot& plot, double value, const glm::dvec3& color, bool bright);
