#include "apps/edgesplat-fly/picture_view.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "apps/edgesplat-fly/clip_handles.h"
#include "apps/edgesplat-fly/pen.h"
#include "engine/overlays/overlays.h"
#include "engine/viewer/screen.h"

namespace {

using edgesplat::viewer::Session;
using edgesplat::viewer::Show;

constexpr ImU32 kPick = IM_COL32(255, 210, 60, 255), kPath = IM_COL32(90, 220, 255, 200);

void draw_divider(const AppState& state, const Pen& pen) {
    const glm::dvec2 size(state.picture_size());
    const double x = state.session.wipe() * size.x;
    pen.line({x, 0}, {x, size.y}, kInk, 2);
    pen.dot({x, size.y / 2}, 0.5 * pen.em, kInk);
    pen.text({x - 7.5 * pen.em, 0.6 * pen.em}, "conventional");
    pen.text({x + 0.8 * pen.em, 0.6 * pen.em}, "edge-preserved");
}

void draw_picks(const AppState& state, const Pen& pen) {
    const Session& session = state.session;
    const auto& picks = session.picks();
    for (std::size_t i = 0; i < picks.size(); ++i) {
        const auto at = edgesplat::viewer::project(session.motion().camera(), state.picture_size(), picks[i].world);
        if (!at) continue;
        pen.dot(*at, 0.25 * pen.em, kPick);
        pen.text(*at + glm::dvec2(0.5 * pen.em, -0.6 * pen.em), fmt::format("{}", i + 1), kPick);
    }
    const auto ruler = session.ruler();
    if (!ruler) return;
    const auto &a = picks[picks.size() - 2].world, &b = picks.back().world;
    world_line(state, pen, a, b, kPick);
    const auto middle = edgesplat::viewer::project(session.motion().camera(), state.picture_size(), (a + b) / 2.0);
    if (middle)
        pen.text(*middle + glm::dvec2(0.5 * pen.em),
                 fmt::format("{:.2f} ± {:.2f} mm", ruler->length, ruler->uncertainty), kPick);
}

void draw_path(AppState& state, const Pen& pen) {
    const auto& line = state.session.tour().line();
    if (!line) return;
    const std::size_t step = std::max<std::size_t>(line->points.size() / 256, 1);
    for (std::size_t i = 0; i + step < line->points.size(); i += step)
        world_line(state, pen, line->points[i], line->points[i + step], kPath);
}

void draw_scale_bar(const AppState& state, const Pen& pen) {
    const glm::dvec2 size(state.picture_size());
    const Session& session = state.session;
    // The scale bar is valid at the depth of the wall ahead, or without one at the depth of the volume's centre.
    const edgesplat::Camera& camera = session.motion().camera();
    auto bar = edgesplat::scale_bar(session.volume(), camera, state.picture_size().y, 0.2 * size.x);
    const double ahead = session.walls() ? session.walls()->free_distance(camera.eye, camera.direction) : 0;
    if (ahead > 0 && std::isfinite(ahead))
        bar = edgesplat::scale_bar(edgesplat::viewer::pixel_size(camera, state.picture_size(), ahead), 0.2 * size.x);
    if (!bar) return;
    const glm::dvec2 right(size.x - pen.em, size.y - 1.2 * pen.em), left(right.x - bar->pixels, right.y);
    pen.line(left, right, kInk, 2);
    for (const auto& end : {left, right})
        pen.line(end - glm::dvec2(0, 0.3 * pen.em), end + glm::dvec2(0, 0.3 * pen.em), kInk, 2);
    pen.text(left - glm::dvec2(0, 1.6 * pen.em), fmt::format("{:g} mm", bar->millimetres));
}

void draw_orientation(const AppState& state, const Pen& pen) {
    const Session& session = state.session;
    const double radius = 2.6 * pen.em;
    const glm::dvec2 middle(radius + pen.em, state.picture_size().y - radius - pen.em);
    auto axes = edgesplat::marker_axes(session.volume(), session.motion().camera());
    constexpr std::array<ImU32, 3> kColors{IM_COL32(255, 110, 100, 255), IM_COL32(120, 230, 120, 255),
                                           IM_COL32(120, 170, 255, 255)};
    // A cube's twelve edges, then its axes.
    const auto corner = [&](int c) {
        glm::dvec2 p(0);
        for (std::size_t axis = 0; axis < 3; ++axis)
            p += ((c >> axis & 1) != 0 ? 0.45 : -0.45) * axes[axis].along;
        return middle + radius * p;
    };
    for (int c = 0; c < 8; ++c)
        for (int axis = 0; axis < 3; ++axis)
            if ((c >> axis & 1) == 0) pen.line(corner(c), corner(c | 1 << axis), IM_COL32(200, 200, 210, 150), 1);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto& a = axes[axis];
        pen.line(middle, middle + radius * 0.8 * a.along, kColors[axis]);
        pen.text(middle + radius * a.along - glm::dvec2(0.3, 0.5) * pen.em, a.positive, kColors[axis]);
        if (!a.negative.empty())
            pen.text(middle - radius * a.along - glm::dvec2(0.3, 0.5) * pen.em, a.negative, kColors[axis]);
    }
}

Placed whole(CanvasPicture& picture, const glm::ivec4& at) {
    return {&picture, {0, 0, 1, 1}, at};
}

/// Computed only while it is shown.
void make_sharpening(AppState& state) {
    const auto &edges = state.last_edges, &plain = state.last_plain;
    const bool both = edges.width > 0 && edges.width == plain.width && edges.height == plain.height;
    if (state.session.show() != Show::Sharpening || !state.sharpening_due || !both) return;
    state.sharpening.set(edgesplat::viewer::sharpening_picture(edges, plain));
    state.sharpening_due = false;
}

bool take_newest(AppState& state) {
    if (!state.drawer) return false;
    if (std::string error = state.drawer->take_error(); !error.empty()) state.error = std::move(error);
    auto picture = state.drawer->take();
    if (!picture) return false;
    state.edges.set(edgesplat::viewer::screen_picture(picture->color));
    state.has_plain = picture->plain.has_value();
    if (picture->plain) {
        state.plain.set(edgesplat::viewer::screen_picture(*picture->plain));
        state.last_plain = std::move(*picture->plain);
    }
    state.last_edges = std::move(picture->color);
    state.sharpening_due = true;
    picture->plain.reset();
    state.shown = std::move(*picture);
    return true;
}

}  // namespace

void world_line(const AppState& state, const Pen& pen, const glm::dvec3& a, const glm::dvec3& b, ImU32 color,
                double width) {
    const auto& camera = state.session.motion().camera();
    const auto from = edgesplat::viewer::project(camera, state.picture_size(), a);
    const auto to = edgesplat::viewer::project(camera, state.picture_size(), b);
    const double most = 4.0 * glm::length(glm::dvec2(state.picture_size()));
    if (from && to && glm::length(*from) < most && glm::length(*to) < most) pen.line(*from, *to, color, width);
}

bool take_pictures(AppState& state) {
    const bool taken = take_newest(state);
    make_sharpening(state);
    return taken;
}

void place_pictures(AppState& state) {
    if (!state.shown || state.edges.empty() || state.picture_size().x < 1 || state.picture_size().y < 1) return;
    const glm::ivec4& at = state.area;
    switch (state.visible()) {
        case Show::Plain:
            state.pictures.push_back(whole(state.plain, at));
            break;
        case Show::Sharpening:
            state.pictures.push_back(whole(state.sharpening.empty() ? state.edges : state.sharpening, at));
            break;
        case Show::Wipe: {
            state.pictures.push_back(whole(state.edges, at));
            // Rounded to whole pixels of the picture, so that both sides meet at a pixel border.
            const double columns = state.plain.size().x;
            const double share = std::round(state.session.wipe() * columns) / columns;
            glm::ivec4 left = at;
            left.z = at.x + static_cast<int>(std::lround(share * state.picture_size().x));
            if (share > 0) state.pictures.push_back({&state.plain, {0, 0, share, 1}, left});
            break;
        }
        case Show::Edges:
            state.pictures.push_back(whole(state.edges, at));
            break;
    }
}

void draw_over_picture(AppState& state) {
    if (!state.session.is_open()) return;
    ImDrawList* list = ImGui::GetBackgroundDrawList();
    const Pen pen{list, glm::dvec2(state.area.x, state.area.y), state.em};
    list->PushClipRect({static_cast<float>(state.area.x), static_cast<float>(state.area.y)},
                       {static_cast<float>(state.area.z), static_cast<float>(state.area.w)}, false);
    if (state.visible() == Show::Wipe) draw_divider(state, pen);
    if (state.overlays) {
        draw_path(state, pen);
        draw_picks(state, pen);
        draw_scale_bar(state, pen);
        draw_orientation(state, pen);
    }
    draw_clip_handles(state, pen);
    list->PopClipRect();
}
