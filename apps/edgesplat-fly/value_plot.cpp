#include "apps/edgesplat-fly/value_plot.h"

#include <algorithm>
#include <cmath>

#include "apps/edgesplat-fly/pen.h"
#include "apps/edgesplat-fly/widgets.h"
#include "engine/scene/transfer_function.h"

namespace {

constexpr ImU32 kPlotGround = IM_COL32(20, 20, 24, 255), kStrip = IM_COL32(44, 44, 52, 255);
constexpr ImU32 kBars = IM_COL32(120, 130, 150, 150), kTick = IM_COL32(255, 255, 255, 170);
constexpr double kHeight = 9, kStripHeight = 0.9, kColumn = 2;  // em, em, pixels

ImVec2 at(double x, double y) {
    return to_im({x, y});
}

/// `number` rounded to a multiple of a power of ten, which is at most `step`.
double rounded(double number, double step) {
    const double power = std::pow(10.0, std::floor(std::log10(step)));
    const double steps = std::round(number / power);
    // Dividing by a whole number gives the double nearest to the decimal number.
    return power < 1 ? steps / std::round(1 / power) : steps * power;
}

void paint_histogram(const ValuePlot& plot, const ValueStatistics& statistics) {
    const auto& histogram = statistics.histogram;
    if (histogram.counts.empty()) return;
    const auto most = static_cast<double>(*std::ranges::max_element(histogram.counts));
    if (!(most > 0)) return;
    const double bins = static_cast<double>(histogram.counts.size());
    const double width = (histogram.high - histogram.low) / bins;
    for (std::size_t i = 0; i < histogram.counts.size(); ++i) {
        if (histogram.counts[i] == 0) continue;
        const double share = std::log1p(static_cast<double>(histogram.counts[i])) / std::log1p(most);
        const double left = plot.x_of(histogram.low + static_cast<double>(i) * width);
        const double right = plot.x_of(histogram.low + static_cast<double>(i + 1) * width);
        if (right < plot.corner.x || left > plot.corner.x + plot.size.x) continue;
        plot.list->AddRectFilled(at(left, plot.bottom() - 0.95 * share * (plot.size.y - plot.strip)),
                                 at(std::max(right, left + 1), plot.bottom()), kBars);
    }
    for (const auto& suggestion : statistics.suggestions) {
        const double x = plot.x_of(suggestion.value), foot = plot.corner.y + plot.size.y;
        plot.list->AddLine(at(x, foot), at(x, foot - 0.4 * plot.strip * (1 + suggestion.strength)), kTick, 2);
    }
}

}  // namespace

double ValuePlot::value_at(double x) const {
    const double step = (high - low) / size.x;
    return rounded(low + (x - corner.x) * step, step);
}

double ValuePlot::extinction_at(double y) const {
    const double share = (bottom() - y) / (size.y - strip), step = 1 / (size.y - strip);
    const double extinction = scale.extinction(share);
    return share <= 0 ? 0 : rounded(extinction, std::max(scale.extinction(share + step) - extinction, 1e-9));
}

ValuePlot value_plot(AppState& state, const char* name) {
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    ValuePlot plot;
    plot.list = ImGui::GetWindowDrawList();
    plot.corner = {static_cast<double>(corner.x), static_cast<double>(corner.y)};
    plot.size = {static_cast<double>(ImGui::GetContentRegionAvail().x), kHeight * state.em};
    plot.strip = kStripHeight * state.em;
    plot.low = state.editing.plot.low;
    plot.high = state.editing.plot.high;
    plot.scale = edgesplat::viewer::ExtinctionScale::of(state.session.volume().geometry);
    ImGui::InvisibleButton(name, to_im(plot.size),
                           ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight);
    note(state, name);
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    plot.mouse = {static_cast<double>(mouse.x), static_cast<double>(mouse.y)};
    plot.hovered = ImGui::IsItemHovered();
    plot.held = ImGui::IsItemActive() && ImGui::IsMouseDown(ImGuiMouseButton_Left);
    plot.pressed = plot.hovered && ImGui::IsMouseClicked(ImGuiMouseButton_Left);
    plot.twice = plot.hovered && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left);
    plot.right = plot.hovered && ImGui::IsMouseClicked(ImGuiMouseButton_Right);
    const ImVec2 end = to_im(plot.corner + plot.size);
    plot.list->AddRectFilled(corner, end, kPlotGround);
    plot.list->AddRectFilled(at(plot.corner.x, plot.bottom()), end, kStrip);
    if (const auto* statistics = state.editing.counter.of(state.session.opened().volume, state.wait))
        paint_histogram(plot, *statistics);
    return plot;
}

void paint_transfer(const ValuePlot& plot, const edgesplat::viewer::TransferPoints& points) {
    if (points.empty()) return;
    const double right = plot.corner.x + plot.size.x;
    const auto place = [&](double x) {
        return edgesplat::transfer_at(points, plot.low + (x - plot.corner.x) / plot.size.x * (plot.high - plot.low));
    };
    for (double x = plot.corner.x; x < right; x += kColumn) {
        const edgesplat::TransferPoint middle = place(x + kColumn / 2);
        const double end = std::min(x + kColumn, right);
        plot.list->AddRectFilled(at(x, plot.y_of(middle.extinction)), at(end, plot.bottom()),
                                 painted(middle.color, 0.65));
        plot.list->AddLine(at(x, plot.y_of(place(x).extinction)), at(end, plot.y_of(place(end).extinction)), kInk,
                           1.5F);
    }
}

void paint_point(const ValuePlot& plot, const edgesplat::TransferPoint& point, bool chosen, double em) {
    const ImVec2 middle = at(plot.x_of(point.value), plot.y_of(point.extinction));
    const auto radius = static_cast<float>((chosen ? 0.4 : 0.3) * em);
    plot.list->AddCircleFilled(middle, radius + 1.5F, chosen ? kInk : kShade);
    plot.list->AddCircleFilled(middle, radius, painted(point.color));
    if (!chosen) plot.list->AddCircle(middle, radius, kInk);
}

void paint_iso(const ValuePlot& plot, double value, const glm::dvec3& color, bool bright) {
    const double x = plot.x_of(value), half = 0.45 * plot.strip, top = plot.bottom();
    if (x < plot.corner.x - half || x > plot.corner.x + plot.size.x + half) return;
    const float width = bright ? 2.5F : 1.5F;
    plot.list->AddLine(at(x, plot.corner.y), at(x, top), kShade, width + 2);
    plot.list->AddLine(at(x, plot.corner.y), at(x, top), painted(color), width);
    const ImVec2 a = at(x, top), b = at(x + half, top + plot.strip - 1), c = at(x - half, top + plot.strip - 1);
    plot.list->AddTriangleFilled(a, b, c, painted(color));
    plot.list->AddTriangle(a, b, c, bright ? kInk : kShade, 1.5F);
}
