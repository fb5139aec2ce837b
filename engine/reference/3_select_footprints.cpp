#include "engine/reference/3_select_footprints.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "footprints/kernel.h"

namespace edgesplat::reference {

View::View(const Camera& camera, const VolumeGeometry& grid, int w, int h)
    : frame(camera_frame(camera)),
      geometry(grid),
      width(w),
      height(h),
      world_to_index(glm::inverse(grid.index_to_world_axes)),
      eye_index(grid.to_index(frame.eye)),
      mm_per_voxel_along(1 / glm::length(world_to_index * frame.forward)) {}

glm::dvec3 View::ray(int x, int y) const {
    const double half_x = frame.tan_half_y * width / height;
    const double sx = (2 * (x + 0.5 + offset.x) / width - 1) * half_x;
    const double sy = (1 - 2 * (y + 0.5 + offset.y) / height) * frame.tan_half_y;
    return glm::normalize(world_to_index * (frame.forward + sx * frame.right + sy * frame.up));
}

double View::depth(const glm::dvec3& index) const {
    return glm::dot(frame.forward, geometry.to_world(index) - frame.eye);
}

glm::dvec2 View::pixel_of(const glm::dvec3& index) const {
    const glm::dvec3 from_eye = geometry.to_world(index) - frame.eye;
    const double unit = height / (2 * frame.tan_half_y * glm::dot(frame.forward, from_eye));
    return {0.5 * width + unit * glm::dot(frame.right, from_eye), 0.5 * height - unit * glm::dot(frame.up, from_eye)};
}

namespace {

/// Largest depth of a unit step in index space, mm along the view axis.
double depth_of_unit(const View& view) {
    return glm::length(glm::transpose(view.geometry.index_to_world_axes) * view.frame.forward);
}

}  // namespace

PixelBox screen_box(const View& view, const SplatSupport& support) {
    const PixelBox whole{0, 0, view.width, view.height};
    const glm::dmat3 to_index = glm::transpose(view.geometry.index_to_world_axes);
    const glm::dvec3 x = to_index * view.frame.right;
    const glm::dvec3 y = to_index * view.frame.up;
    const glm::dvec3 z = to_index * view.frame.forward;
    const glm::dvec3 offset = view.geometry.to_world(support.center) - view.frame.eye;
    const glm::dvec3 e(glm::dot(view.frame.right, offset), glm::dot(view.frame.up, offset),
                       glm::dot(view.frame.forward, offset));
    const double r2 = support.radius * support.radius;
    const double depth_extent = support.radius * glm::length(z);
    if (e.z <= -depth_extent) return {};
    if (e.z <= depth_extent) return whole;

    // Tangents of the outline: the dual conic r^2 (S^T a).(S^T b) - e_a e_b of the ellipsoid's image, set to 0.
    const auto range = [&](const glm::dvec3& axis, double e_axis) {
        const double aa = r2 * glm::dot(axis, axis) - e_axis * e_axis;
        const double az = r2 * glm::dot(axis, z) - e_axis * e.z;
        const double zz = r2 * glm::dot(z, z) - e.z * e.z;  // < 0
        const double root = std::sqrt(std::max(az * az - aa * zz, 0.0));
        return std::pair{(az + root) / zz, (az - root) / zz};
    };
    const auto [x_low, x_high] = range(x, e.x);
    const auto [y_low, y_high] = range(y, e.y);
    const double half_y = view.frame.tan_half_y;
    const double half_x = half_y * view.width / view.height;
    // The first pixel whose centre is at or after the left tangent; one past the last pixel before the right tangent.
    const auto pixel = [](double at, int size) {
        return static_cast<int>(std::ceil(std::clamp(at - 0.5, -1.0, size + 1.0)));
    };
    const auto column = [&](double s) { return (s / half_x + 1) / 2 * view.width - view.offset.x; };
    const auto row = [&](double s) { return (1 - s / half_y) / 2 * view.height - view.offset.y; };
    PixelBox box{pixel(column(x_low), view.width), pixel(row(y_high), view.height), pixel(column(x_high), view.width),
                 pixel(row(y_low), view.height)};
    box.x0 = std::max(box.x0, 0);
    box.y0 = std::max(box.y0, 0);
    box.x1 = std::min(box.x1, view.width);
    box.y1 = std::min(box.y1, view.height);
    return box.empty() ? PixelBox{} : box;
}

double sheet_thickness(const View& view, const Settings& settings) {
    return settings.sheet_spacing * view.mm_per_voxel_along;
}

int Sheets::first() const {
    return std::isinf(nearest) ? 0 : static_cast<int>(std::max(std::floor(nearest / thickness), 0.0));
}

Sheets Sheets::with(const Sheets& other) const {
    return {std::min(nearest, other.nearest), std::min(thickness, other.thickness)};
}

Sheets sheets_of(std::span<const SplatRecord> records, const Field& field, const View& view, const Settings& settings,
                 const Footprints& footprints) {
    Sheets sheets{.thickness = sheet_thickness(view, settings)};
    if (records.empty()) return sheets;
    glm::dvec3 low(field.dims);
    glm::dvec3 high(0);
    for (const SplatRecord& record : records) {
        const glm::dvec3 x(field.voxel(record.voxel));
        low = glm::min(low, x);
        high = glm::max(high, x);
    }
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 at((corner & 1) != 0 ? high.x : low.x, (corner & 2) != 0 ? high.y : low.y,
                            (corner & 4) != 0 ? high.z : low.z);
        sheets.nearest = std::min(sheets.nearest, view.depth(at));
    }
    if (settings.sheets == SheetCut::Sliced) sheets.nearest -= footprints.farthest_reach() * depth_of_unit(view);
    return sheets;
}

std::vector<Selected> select_footprints(std::span<const SplatRecord> records, const Field& field, const View& view,
                                        const Settings& settings, const Footprints& footprints, const Sheets& sheets,
                                        const IndexClip& clip) {
    std::vector<Selected> selected(records.size());
    if (records.empty()) return selected;
    const double thickness = sheets.thickness;
    const int base = sheets.first();
    const auto sheet_of = [&](double z) { return static_cast<int>(std::max(std::floor(z / thickness), 0.0)) - base; };
    for (std::size_t i = 0; i < records.size(); ++i) {
        Selected& s = selected[i];
        const glm::dvec3 x(field.voxel(records[i].voxel));
        s.support = {x, footprints.reach(records[i].edge)};
        SplatSupport drawn = s.support;
        if (draws_table(settings)) std::tie(s.layer, s.axis) = footprints.select(records[i].edge, x - view.eye_index);
        s.filter = pixel_filter(view, records[i], x, footprints);
        if (s.filter.share > 0) drawn.radius = std::max(drawn.radius, s.filter.reach);
        s.box = screen_box(view, drawn);
        const double middle = view.depth(s.support.center);
        const double extent = s.support.radius * depth_of_unit(view);
        const bool sliced = settings.sheets == SheetCut::Sliced;
        // A voxel outside its matter (D < 0) is sorted by its foot point, since its matter lies behind the face. A
        // translucent splat is sorted one sheet before the matter beyond its face. So no splat of another material
        // comes between the two, and the splat shares no sheet with matter that occludes it.
        const VoxelEdge& edge = records[i].edge;
        const bool face = settings.warp == WarpFamily::Face && edge.has_edge;
        const double beside = face ? std::min(edge.D, 0.0) : 0;
        const double apart = face && footprints.lit_in_depth(edge) ? thickness / depth_of_unit(view) : 0;
        s.z = view.depth(x + (beside - apart) * edge.n);
        s.sheet = std::max(sheet_of(sliced ? middle - extent : s.z), 0);
        s.last_sheet = sliced ? std::max(sheet_of(middle + extent), s.sheet) : s.sheet;
        s.kept = beside > -footprints.kernel().radius && middle > -extent && !s.box.empty() &&
                 !clip.cuts_away(drawn.center, drawn.radius);
    }
    return selected;
}

}  // namespace edgesplat::reference
