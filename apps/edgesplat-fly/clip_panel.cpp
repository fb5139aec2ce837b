#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>

#include "apps/edgesplat-fly/panels.h"
#include "apps/edgesplat-fly/widgets.h"

namespace {

namespace viewer = edgesplat::viewer;
using edgesplat::ClipBox;
using edgesplat::Plane;
using edgesplat::SceneDocument;

constexpr std::size_t kBesideBox = edgesplat::kMaxClipPlanes - 6;

glm::dvec3 towards_eye(const AppState& state) {
    return -edgesplat::unit(state.session.motion().camera().direction);
}

/// The nearest world axis, with the direction's sign.
glm::dvec3 along_axis(const glm::dvec3& direction) {
    const glm::dvec3 size = glm::abs(direction);
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    glm::dvec3 out(0);
    out[axis] = direction[axis] < 0 ? -1 : 1;
    return out;
}

void one_plane(AppState& state, std::size_t i) {
    const Scope scope(state, fmt::format("plane{}", i));
    auto& session = state.session;
    const auto& geometry = session.volume().geometry;
    const Plane plane = session.document().effects.clip.keep[i];
    const glm::dvec3 normal = edgesplat::unit(plane.normal), middle = geometry.center();
    const double length = glm::length(viewer::volume_box(geometry).high - viewer::volume_box(geometry).low) / 2;
    slide(state, "mm from the centre", glm::dot(plane.point - middle, normal), {-length, length, "%.2f"},
          [&](SceneDocument& d, double v) { d.effects.clip.keep.at(i).point = middle + v * normal; });
    drag3(state, "normal", plane.normal, 0.01, [i](SceneDocument& d, const glm::dvec3& v) {
        if (glm::length(v) > 0) d.effects.clip.keep.at(i).normal = v;
    });
    const auto turn = [&](const glm::dvec3& to) {
        session.edit([&](SceneDocument& d) { d.effects.clip.keep.at(i).normal = to; });
    };
    if (button(state, "to eye")) turn(towards_eye(state));
    ImGui::SameLine();
    if (button(state, "along an axis")) turn(along_axis(plane.normal));
    ImGui::SameLine();
    if (button(state, "flip")) turn(-plane.normal);
    ImGui::SameLine();
    if (button(state, "remove"))
        session.edit([i](SceneDocument& d) {
            auto& keep = d.effects.clip.keep;
            keep.erase(keep.begin() + static_cast<std::ptrdiff_t>(i));
        });
}

void box(AppState& state, const char* name, const char* label, std::optional<ClipBox> SceneDocument::*member,
         const ClipBox& fresh) {
    const Scope scope(state, name);
    flag(state, label, (state.session.document().*member).has_value(),
         [&](SceneDocument& d, bool on) { d.*member = on ? std::optional(fresh) : std::nullopt; });
    const auto now = state.session.document().*member;
    if (!now) return;
    const auto& geometry = state.session.volume().geometry;
    const auto spacing = geometry.spacing();
    const double voxel = std::min({spacing.x, spacing.y, spacing.z});
    drag3(state, "low", now->low, voxel / 2,
          [&](SceneDocument& d, const glm::dvec3& v) { (d.*member)->low = glm::min(v, now->high - voxel / 2); });
    drag3(state, "high", now->high, voxel / 2,
          [&](SceneDocument& d, const glm::dvec3& v) { (d.*member)->high = glm::max(v, now->low + voxel / 2); });
}

/// The eighth of the volume nearest to the eye.
ClipBox near_corner(const AppState& state) {
    const auto& geometry = state.session.volume().geometry;
    ClipBox out = viewer::volume_box(geometry);
    const glm::dvec3 middle = (out.low + out.high) / 2.0, eye = state.session.motion().camera().eye;
    for (int axis = 0; axis < 3; ++axis)
        (eye[axis] < middle[axis] ? out.high : out.low)[axis] = middle[axis];
    return out;
}

}  // namespace

void clip_panel(AppState& state) {
    auto& session = state.session;
    ImGui::Checkbox("handles in the picture", &state.editing.clip.shown);
    note(state, "handles in the picture");
    const ClipBox whole = viewer::volume_box(session.volume().geometry);
    const edgesplat::Clip clip = session.document().effects.clip;
    const bool fits = clip.keep.size() <= kBesideBox || session.document().keep_box;
    ImGui::BeginDisabled(!fits);
    box(state, "crop", "crop to a box", &SceneDocument::keep_box, whole);
    ImGui::EndDisabled();
    ImGui::BeginDisabled(!clip.remove.empty());
    box(state, "cut", "cut a box out", &SceneDocument::remove_box, near_corner(state));
    ImGui::EndDisabled();
    if (!fits) ImGui::TextDisabled("with a box, at most %zu planes", kBesideBox);
    if (!clip.remove.empty())
        ImGui::TextDisabled("the scene already cuts out matter with %zu planes", clip.remove.size());
    for (std::size_t i = 0; i < session.document().effects.clip.keep.size(); ++i) {
        ImGui::Separator();
        one_plane(state, i);
    }
    ImGui::Separator();
    const std::size_t most = session.document().keep_box ? kBesideBox : edgesplat::kMaxClipPlanes;
    ImGui::BeginDisabled(clip.keep.size() >= most);
    if (button(state, "add a plane"))
        session.edit([&](SceneDocument& d) {
            const glm::dvec3 at = session.point().value_or(session.volume().geometry.center());
            d.effects.clip.keep.push_back({at, along_axis(towards_eye(state))});
        });
    ImGui::EndDisabled();
}
