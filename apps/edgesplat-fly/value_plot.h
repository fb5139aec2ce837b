// A plot over the volume's values: histogram, transfer function and iso-values.
#pragma once

#include <imgui.h>

#include "apps/edgesplat-fly/app_state.h"
#include "engine/viewer/transfer_edit.h"

/// Values increase to the right, extinctions upwards. A strip at the bottom contains the handles of iso-values.
struct ValuePlot {
    ImDrawList* list = nullptr;
    glm::dvec2 corner{0}, size{1};  ///< pixels of the window
    double strip = 0;               ///< height of the strip, pixels
    double low = 0, high = 1;       ///< values at the sides
    edgesplat::viewer::ExtinctionScale scale;
    glm::dvec2 mouse{0};
    // State of the mouse in this frame.
    bool hovered = false, held = false, pressed = false, twice = false, right = false;

    double x_of(double value) const { return corner.x + (value - low) / (high - low) * size.x; }
    double bottom() const { return corner.y + size.y - strip; }
    double y_of(double extinction) const { return bottom() - scale.share(extinction) * (size.y - strip); }
    /// Rounded in steps of at most a pixel, so that the numbers of a saved scene are short.
    double value_at(double x) const;
    double extinction_at(double y) const;
};

/// Creates the widget, called `name` in scripts. Paints its background and, once computed, the histogram.
ValuePlot value_plot(AppState& state, const char* name);

/// Paints the extinction of a transfer function as a curve, with its colours below.
void paint_transfer(const ValuePlot& plot, const edgesplat::viewer::TransferPoints& points);
/// Paints a point of it as a dot.
void paint_point(const ValuePlot& plot, const edgesplat::TransferPoint& point, bool chosen, double em);
/// Paints an iso-value as a line with a handle in the strip.
void paint_iso(const ValuePlot& plot, double value, const glm::dvec3& color, bool bright);
