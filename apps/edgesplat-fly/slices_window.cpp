// Three slices through one point, beside the picture.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "apps/edgesplat-fly/panels.h"
#include "apps/edgesplat-fly/pen.h"
#include "apps/edgesplat-fly/widgets.h"
#include "engine/error.h"
#include "engine/scene/label_choice.h"
#include "engine/viewer/samples.h"
#include "engine/viewer/screen.h"
#include "engine/volume/labels.h"
#include "engine/volume/value_text.h"

namespace {

namespace viewer = edgesplat::viewer;
using viewer::Slice;

constexpr ImU32 kGround = IM_COL32(13, 13, 16, 255), kFrame = IM_COL32(70, 72, 84, 255);
constexpr ImU32 kCross = IM_COL32(255, 210, 60, 190), kEye = IM_COL32(90, 220, 255, 255);

/// The volume; of drawn labels its samples as read.
const std::shared_ptr<const edgesplat::Volume>& sliced_volume(const AppState& state) {
    const viewer::Opened& opened = state.session.opened();
    return opened.volume->shown_labels ? opened.samples : opened.volume;
}
const edgesplat::Volume& sliced(const AppState& state) {
    return *sliced_volume(state);
}

bool inside(const edgesplat::VolumeGeometry& geometry, const glm::dvec3& world) {
    const glm::dvec3 voxel = geometry.to_index(world);
    return glm::all(glm::greaterThanEqual(voxel, glm::dvec3(-0.5))) &&
           glm::all(glm::lessThanEqual(voxel, glm::dvec3(geometry.dims) - 0.5));
}

/// The last pick; without one, the eye if it is inside the volume, else the volume's centre.
glm::dvec3 linked_point(const AppState& state) {
    const auto& session = state.session;
    if (session.point()) return *session.point();
    const auto& geometry = session.volume().geometry;
    const glm::dvec3& eye = session.motion().camera().eye;
    return inside(geometry, eye) ? eye : geometry.center();
}

viewer::ScreenPicture grey_picture(const Slice& slice) {
    viewer::ScreenPicture out{slice.width, slice.height, {}};
    out.pixels.reserve(4 * slice.grey.size());
    for (const std::uint8_t grey : slice.grey)
        out.pixels.insert(out.pixels.end(), {grey, grey, grey, 255});
    return out;
}

/// The label at a voxel, or the interpolated value.
std::string text_there(const edgesplat::Volume& volume, const glm::dvec3& voxel) {
    const glm::ivec3 at = glm::clamp(glm::ivec3(glm::round(voxel)), glm::ivec3(0), volume.geometry.dims - 1);
    if (!volume.has_data(at)) return "no data";
    if (!volume.labels)
        return edgesplat::value_text(volume.in_file_unit(viewer::interpolated(volume, voxel)),
                                     volume.in_file_unit(static_cast<double>(volume.max_value - volume.min_value)));
    const std::size_t place = place_of_label(*volume.labels, volume.at(at.x, at.y, at.z));
    return place < volume.labels->labels.size() ? text_of(*volume.labels, volume.labels->labels[place]) : "";
}

void update(AppState& state, int axis, const glm::dvec3& voxel) {
    SlicePicture& shown = state.slice_pictures[static_cast<std::size_t>(axis)];
    const auto& volume = sliced(state);
    const SliceView& view = state.slice_view;
    const int depth = std::clamp(static_cast<int>(std::lround(voxel[axis])), 0, volume.geometry.dims[axis] - 1);
    // A failed read is not repeated until another slice is requested.
    if (shown.volume == &volume && shown.depth == depth && shown.low == view.low && shown.high == view.high) {
        if (shown.slice) shown.slice->cross = viewer::pixel_at(*shown.slice, voxel);
        return;
    }
    // Slices of a file are read when the eye stands still: reading must not delay the flight.
    if (shown.slice && shown.volume == &volume && volume.packed && state.session.moving()) return;
    shown.slice.reset();
    try {
        shown.slice = viewer::slice(volume, axis, voxel, view.low, view.high);
        shown.picture.set(grey_picture(*shown.slice));
    } catch (const edgesplat::Error& error) {
        state.session.say(error.what());
    }
    shown.volume = &volume;
    shown.depth = depth;
    shown.low = view.low;
    shown.high = view.high;
}

/// A slice in its rectangle of the window.
struct Cell {
    ImDrawList* list;
    const Slice& slice;
    glm::dvec2 low, high;  ///< corners of the slice's picture

    glm::dvec2 scale() const { return (high - low) / glm::dvec2(slice.width, slice.height); }
    glm::dvec2 place(const glm::dvec2& pixel) const { return low + pixel * scale(); }
    glm::dvec2 pixel(const glm::dvec2& at) const { return (at - low) / scale(); }
};

void letters(const AppState& state, const Cell& cell) {
    const auto& volume = sliced(state);
    if (!volume.in_patient) return;
    const auto side = viewer::slice_letters(cell.slice, volume.geometry);
    const auto letter = [&](std::size_t i) { return std::string(1, side[i]); };
    const Pen pen{cell.list, glm::dvec2(0), state.em};
    const glm::dvec2 middle = (cell.low + cell.high) / 2.0, half = 0.5 * state.em * glm::dvec2(0.6, 1.1);
    const double edge = 0.3 * state.em;
    // A slice of few voxels has no room for all letters.
    if (cell.high.x - cell.low.x > 4 * state.em) {
        pen.text({cell.low.x + edge, middle.y - half.y}, letter(0));
        pen.text({cell.high.x - edge - 2 * half.x, middle.y - half.y}, letter(1));
    }
    if (cell.high.y - cell.low.y > 4 * state.em) {
        pen.text({middle.x - half.x, cell.low.y + edge}, letter(2));
        pen.text({middle.x - half.x, cell.high.y - edge - 2 * half.y}, letter(3));
    }
}

void cross(const Cell& cell) {
    const glm::dvec2 at = cell.place(cell.slice.cross);
    cell.list->AddLine(to_im({cell.low.x, at.y}), to_im({cell.high.x, at.y}), kCross);
    cell.list->AddLine(to_im({at.x, cell.low.y}), to_im({at.x, cell.high.y}), kCross);
}

/// Draws the eye and its view direction, projected into the slice. An eye outside the slice is drawn at its side.
void eye(const AppState& state, const Cell& cell) {
    const auto& geometry = sliced(state).geometry;
    const auto& camera = state.session.motion().camera();
    const auto seen = [&](const glm::dvec3& world) {
        return cell.place(viewer::pixel_at(cell.slice, geometry.to_index(world)));
    };
    const glm::dvec2 there = seen(camera.eye), margin(0.5 * state.em);
    const glm::dvec2 at = glm::clamp(there, cell.low + margin, cell.high - margin);
    const glm::dvec2 way = seen(camera.eye + edgesplat::unit(camera.direction)) - there;
    // A view along the slice's axis has no direction in the slice.
    const double flat = glm::length(way) / glm::length(cell.scale() / cell.slice.pixel_mm);
    const auto radius = static_cast<float>(0.22 * state.em);
    if (flat > 0.05) {
        const glm::dvec2 along = 1.1 * state.em * std::min(1.4 * flat, 1.0) * glm::normalize(way),
                         across(-along.y, along.x);
        cell.list->AddLine(to_im(at), to_im(at + along), kShade, 4);
        cell.list->AddLine(to_im(at), to_im(at + along), kEye, 2);
        cell.list->AddTriangleFilled(to_im(at + 1.3 * along), to_im(at + 0.8 * along + 0.3 * across),
                                     to_im(at + 0.8 * along - 0.3 * across), kEye);
    }
    cell.list->AddCircleFilled(to_im(at), radius + 1.5F, kShade);
    if (at == there)
        cell.list->AddCircleFilled(to_im(at), radius, kEye);
    else
        cell.list->AddCircle(to_im(at), radius, kEye, 0, 1.5F);
}

void mouse(AppState& state, const Cell& cell, const glm::dvec3& voxel) {
    const auto& geometry = sliced(state).geometry;
    glm::dvec3 to = voxel;
    const ImVec2 at = ImGui::GetIO().MousePos;
    const float wheel = ImGui::IsItemHovered() ? ImGui::GetIO().MouseWheel : 0;
    if (ImGui::IsItemActive()) {
        to = viewer::voxel_at(cell.slice, cell.pixel({static_cast<double>(at.x), static_cast<double>(at.y)}));
        to[cell.slice.axis] = voxel[cell.slice.axis];
    }
    to[cell.slice.axis] += static_cast<double>(wheel);
    to = glm::clamp(to, glm::dvec3(0), glm::dvec3(geometry.dims - 1));
    if (to != voxel && (wheel != 0 || ImGui::IsItemActive())) state.session.set_point(geometry.to_world(to));
}

/// Shows a slice in a rectangle and paints the area around it: the window is transparent over the slice.
void show(AppState& state, int axis, const glm::dvec3& voxel, const glm::dvec2& low, const glm::dvec2& high) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    SlicePicture& shown = state.slice_pictures[static_cast<std::size_t>(axis)];
    if (!shown.slice || shown.picture.empty()) {
        list->AddRectFilled(to_im(low), to_im(high), kGround);
        return;
    }
    const glm::dvec2 size = glm::dvec2(shown.slice->width, shown.slice->height) * shown.slice->pixel_mm;
    const glm::dvec2 fits =
        glm::max(glm::floor(std::min((high.x - low.x) / size.x, (high.y - low.y) / size.y) * size), glm::dvec2(1));
    const glm::dvec2 corner = glm::floor(low + (high - low - fits) / 2.0);
    const Cell cell{list, *shown.slice, corner, corner + fits};
    list->AddRectFilled(to_im(low), to_im({cell.low.x, high.y}), kGround);
    list->AddRectFilled(to_im({cell.high.x, low.y}), to_im(high), kGround);
    list->AddRectFilled(to_im({cell.low.x, low.y}), to_im({cell.high.x, cell.low.y}), kGround);
    list->AddRectFilled(to_im({cell.low.x, cell.high.y}), to_im({cell.high.x, high.y}), kGround);
    list->AddRect(to_im(low), to_im(high), kFrame);
    state.pictures.push_back({&shown.picture, {0, 0, 1, 1}, {glm::ivec2(cell.low), glm::ivec2(cell.high)}});
    list->PushClipRect(to_im(cell.low), to_im(cell.high), true);
    cross(cell);
    eye(state, cell);
    letters(state, cell);
    list->PopClipRect();
    const std::string name = fmt::format("slice{}", axis);
    ImGui::SetCursorScreenPos(to_im(cell.low));
    ImGui::InvisibleButton(name.c_str(), to_im(fits));
    note(state, name.c_str());
    mouse(state, cell, voxel);
}

void window_sliders(AppState& state) {
    SliceView& view = state.slice_view;
    const auto& volume = sliced(state);
    const auto least = static_cast<double>(volume.min_value), most = static_cast<double>(volume.max_value);
    ImGui::SetNextItemWidth(-3.5F * static_cast<float>(state.em));
    ImGui::SliderScalar("black", ImGuiDataType_Double, &view.low, &least, &most, "%.5g");
    note(state, "black");
    ImGui::SetNextItemWidth(-3.5F * static_cast<float>(state.em));
    ImGui::SliderScalar("white", ImGuiDataType_Double, &view.high, &least, &most, "%.5g");
    note(state, "white");
    // Keep black below white, whichever was moved.
    const double gap = 1e-3 * (most - least);
    view.low = std::clamp(view.low, least, most - gap);
    view.high = std::clamp(view.high, view.low + gap, most);
}

/// Marks the linked point in the picture.
void mark(const AppState& state, const glm::dvec3& world) {
    const auto at = viewer::project(state.session.motion().camera(), state.picture_size(), world);
    if (!at || !state.overlays) return;
    const Pen pen{ImGui::GetBackgroundDrawList(), glm::dvec2(state.area.x, state.area.y), state.em};
    const glm::dvec2 limit(state.picture_size());
    if (at->x < 0 || at->y < 0 || at->x >= limit.x || at->y >= limit.y) return;
    for (const glm::dvec2& way : {glm::dvec2(1, 0), glm::dvec2(0, 1), glm::dvec2(-1, 0), glm::dvec2(0, -1)})
        pen.line(*at + 0.3 * state.em * way, *at + 0.8 * state.em * way, kCross);
}

void contents(AppState& state) {
    const Scope scope(state, "slices");
    const auto& volume = sliced(state);
    const glm::dvec3 world = linked_point(state), voxel = volume.geometry.to_index(world);
    mark(state, world);
    const ImVec2 at = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
    const glm::dvec2 corner(static_cast<double>(at.x), static_cast<double>(at.y));
    const double pad = 0.4 * state.em, foot = 6.8 * state.em, width = static_cast<double>(size.x);
    const double height = std::floor((static_cast<double>(size.y) - foot) / 3);
    // Radiologists' order: from above, from the front, from the side.
    constexpr std::array<int, 3> kOrder{2, 1, 0};
    for (std::size_t i = 0; i < kOrder.size(); ++i) {
        const glm::dvec2 low = corner + glm::dvec2(0, static_cast<double>(i) * height);
        update(state, kOrder[i], voxel);
        show(state, kOrder[i], voxel, low, low + glm::dvec2(width, height));
    }
    const glm::dvec2 under = corner + glm::dvec2(0, 3 * height);
    ImGui::GetWindowDrawList()->AddRectFilled(to_im(under), {at.x + size.x, at.y + size.y}, kGround);
    ImGui::SetCursorScreenPos(to_im(under + pad));
    ImGui::BeginGroup();
    window_sliders(state);
    ImGui::Text("%.1f, %.1f, %.1f mm", world.x, world.y, world.z);
    if (inside(volume.geometry, world))
        ImGui::TextDisabled("voxel %.1f, %.1f, %.1f: %s", voxel.x, voxel.y, voxel.z, text_there(volume, voxel).c_str());
    ImGui::EndGroup();
}

}  // namespace

void slices_window(AppState& state) {
    if (!state.slices || !state.session.is_open()) return;
    const std::shared_ptr<const edgesplat::Volume> volume = sliced_volume(state);
    if (state.slice_view.volume != volume) {
        state.slice_view = {volume, static_cast<double>(volume->min_value), static_cast<double>(volume->max_value)};
        state.slice_pictures = {};
    }
    const glm::dvec4 area(state.slices_area);
    const glm::dvec2 size(area.z - area.x, area.w - area.y);
    if (!(volume->max_value > volume->min_value) || size.x < 2 || size.y < 8 * state.em) return;
    ImGui::SetNextWindowPos(to_im({area.x, area.y}));
    ImGui::SetNextWindowSize(to_im(size));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0);
    ImGui::Begin("slices", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                     ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoBringToFrontOnFocus |
                     ImGuiWindowFlags_NoScrollWithMouse | ImGuiWindowFlags_NoFocusOnAppearing);
    contents(state);
    ImGui::End();
    ImGui::PopStyleVar(2);
}
