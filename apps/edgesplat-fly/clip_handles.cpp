#include "apps/edgesplat-fly/clip_handles.h"

#include <fmt/format.h>

#include <algorithm>

#include "apps/edgesplat-fly/widgets.h"

namespace {

namespace viewer = edgesplat::viewer;
using viewer::Handle;

constexpr double kReach = 0.7, kRadius = 0.35, kArrow = 2.4, kInset = 0.8;  // em

ImU32 color_of(Handle::Kind kind) {
    if (kind == Handle::Kind::KeepBox) return IM_COL32(120, 230, 140, 255);
    if (kind == Handle::Kind::RemoveBox) return IM_COL32(255, 120, 110, 255);
    return IM_COL32(255, 170, 60, 255);
}

const char* name_of(Handle::Kind kind) {
    if (kind == Handle::Kind::KeepBox) return "crop";
    return kind == Handle::Kind::RemoveBox ? "cut" : "plane";
}

std::vector<Handle> handles_of(const AppState& state) {
    return viewer::clip_handles(state.session.document(), state.session.volume().geometry);
}

bool same(const Handle& a, const Handle& b) {
    return a.kind == b.kind && a.index == b.index;
}

void drag(AppState& state, const glm::dvec2& pixel) {
    ClipHand& hand = state.editing.clip;
    auto& session = state.session;
    const Handle held = *hand.held;
    const auto ray = viewer::pixel_ray(session.motion().camera(), state.picture_size(), pixel);
    const auto at = viewer::along_line(ray, held.place, held.normal);
    if (!at) return;
    if (!hand.start) {
        hand.start = at;
        return;
    }
    session.edit(
        [&](edgesplat::SceneDocument& d) {
            viewer::move_handle(d, session.volume().geometry, held, *at - *hand.start);
        },
        false);
}

void draw_box(const AppState& state, const Pen& pen, const edgesplat::ClipBox& box, ImU32 color) {
    const auto corner = [&](int c) {
        return glm::dvec3((c & 1) != 0 ? box.high.x : box.low.x, (c & 2) != 0 ? box.high.y : box.low.y,
                          (c & 4) != 0 ? box.high.z : box.low.z);
    };
    for (int c = 0; c < 8; ++c)
        for (int axis = 0; axis < 3; ++axis)
            if ((c >> axis & 1) == 0) world_line(state, pen, corner(c), corner(c | 1 << axis), color, 1);
}

void draw_handle(AppState& state, const Pen& pen, const Handle& handle, bool bright) {
    const auto& camera = state.session.motion().camera();
    const glm::ivec2 size = state.picture_size();
    const auto at = viewer::handle_pixel(handle, camera, size, kInset * state.em);
    if (!at) return;
    const ImU32 color = bright ? kInk : color_of(handle.kind);
    const double depth = glm::dot(handle.place - camera.eye, glm::normalize(camera.direction));
    const double length = kArrow * state.em * viewer::pixel_size(camera, size, depth);
    const auto place = viewer::project(camera, size, handle.place);
    auto tip = viewer::project(camera, size, handle.place + length * handle.normal);
    if (tip) {
        *tip += *at - *place;  // parallel to the arrow at the handle's own place
        const glm::dvec2 way = *tip - *at;
        const double pixels = glm::length(way);
        pen.line(*at, *tip, color, 2);
        if (pixels > 0.5 * state.em) {
            const glm::dvec2 along = 0.45 * state.em / pixels * way, across(-along.y, along.x);
            pen.line(*tip, *tip - along + 0.6 * across, color, 2);
            pen.line(*tip, *tip - along - 0.6 * across, color, 2);
        }
    }
    pen.dot(*at, (bright ? 1.3 : 1.0) * kRadius * state.em, color);
    const glm::dvec2 middle = pen.corner + *at;
    note(state, fmt::format("handle.{}{}", name_of(handle.kind), handle.index),
         {middle - kRadius * state.em, middle + kRadius * state.em});
}

}  // namespace

bool clip_handles(AppState& state, const Input& input, bool over_picture) {
    ClipHand& hand = state.editing.clip;
    const bool left = input.down(Button::Left);
    const bool down = left || input.down(Button::Right) || input.down(Button::Middle);
    const bool pressed = left && !hand.was_down;
    const bool free = !hand.was_down || hand.held;
    hand.was_down = down;
    const glm::dvec2 pixel = input.mouse - glm::dvec2(state.area.x, state.area.y);
    const auto handles = hand.shown ? handles_of(state) : std::vector<Handle>();
    if (hand.held) {
        // The scene may have changed during the drag.
        const bool there = std::ranges::any_of(handles, [&](const Handle& h) { return same(h, *hand.held); });
        if (left && there) {
            drag(state, pixel);
            return true;
        }
        hand.held.reset();
        state.session.finish_edit();
        return true;
    }
    hand.hovered.reset();
    if (!over_picture || !free || input.ctrl() || state.tool != Tool::Move) return false;
    hand.hovered = viewer::handle_at(handles, state.session.motion().camera(), state.picture_size(), pixel,
                                     kReach * state.em, kInset * state.em);
    if (!pressed || !hand.hovered) return false;
    hand.held = handles[*hand.hovered];
    hand.start.reset();
    drag(state, pixel);
    return true;
}

void draw_clip_handles(AppState& state, const Pen& pen) {
    const ClipHand& hand = state.editing.clip;
    if (!hand.shown) return;
    const auto& document = state.session.document();
    if (document.keep_box) draw_box(state, pen, *document.keep_box, IM_COL32(120, 230, 140, 120));
    if (document.remove_box) draw_box(state, pen, *document.remove_box, IM_COL32(255, 120, 110, 120));
    const auto handles = handles_of(state);
    for (std::size_t i = 0; i < handles.size(); ++i)
        draw_handle(state, pen, handles[i], hand.held ? same(handles[i], *hand.held) : hand.hovered == i);
}
