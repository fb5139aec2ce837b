#include "engine/reference/5_draw_splats.h"

#include <algorithm>
#include <cmath>

#include "engine/reference/face_geometry.h"
#include "engine/reference/faces.h"
#include "engine/volume/parallel.h"
#include "footprints/kernel.h"
#include "shaders/shared/limits.h"

namespace edgesplat::reference {

namespace {

glm::dvec3 world_normal(const VolumeGeometry& geometry, const glm::dvec3& n_index) {
    return glm::normalize(glm::transpose(glm::inverse(geometry.index_to_world_axes)) * n_index);
}

/// Share of a kernel that lies in front of the eye.
double in_front(double s0, double radius) {
    const double t = std::clamp((s0 + radius) / (2 * radius), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

}  // namespace

glm::dvec3 payload_of(const SplatRecord& record, const Field& field, const Scene& scene, const View& view,
                      const Settings& settings, Payload payload, const std::optional<DepthRange>& cut) {
    const VoxelEdge& edge = record.edge;
    const glm::dvec3 x(field.voxel(record.voxel));
    // A surface's normal points to its lower values, on whichever side the splat is.
    glm::dvec3 n = edge.has_normal ? (edge.upper ? -edge.n : edge.n) : glm::dvec3(0);
    // A wall's kernel reaches both faces; the visible one is turned to the eye.
    const bool wall = edge.has_edge && edge.D2 < edge_reach(settings);
    const bool turned =
        wall && glm::dot(world_normal(view.geometry, n), view.frame.eye - view.geometry.to_world(x)) < 0;
    if (turned) n = -n;
    const glm::dvec3 normal = edge.has_normal ? world_normal(view.geometry, n) : n;
    const double depth = cut ? std::clamp(view.depth(x), cut->near, cut->far) : view.depth(x);
    switch (payload) {
        case Payload::Color: {
            const Material& material = scene.materials[record.material];
            const bool unlit = lights_edges_only(scene, settings.edges != EdgeEstimator::Off) && !edge.has_edge;
            return shade(scene,
                         {.color = record.color(scene),
                          .response = material.response,
                          .normal = unlit ? glm::dvec3(0) : normal,
                          .position = view.geometry.to_world(x),
                          .depth = depth},
                         view.frame.eye, record.reach_at(turned));
        }
        case Payload::Depth:
            return {depth, 0, 0};
        case Payload::Distance:
            if (!edge.has_edge) return {-edge_reach(settings), 0, 0};
            return {edge.upper ? edge.D : -edge.D, 0, 0};
        case Payload::Normal:
            break;
    }
    return normal;
}

glm::dvec3 cap_payload(const SplatRecord& record, const glm::dvec3& own, const glm::dvec3& face,
                       const glm::dvec3& entry, const Scene& scene, const View& view, Payload payload) {
    switch (payload) {
        case Payload::Color:
            return shade(scene,
                         {.color = record.color(scene),
                          .response = scene.materials[record.material].response,
                          .normal = world_normal(view.geometry, face),
                          .position = view.geometry.to_world(entry),
                          .depth = view.depth(entry)},
                         view.frame.eye, record.reach);
        case Payload::Depth:
            return {view.depth(entry), 0, 0};
        case Payload::Distance:
            return own;
        case Payload::Normal:
            break;
    }
    return world_normal(view.geometry, face);
}

namespace {

/// A splat along the ray p + z u.
struct SeenSplat {
    const SplatRecord& record;
    const Scene& scene;
    const View& view;
    const Settings& settings;
    glm::dvec3 center, p, u;
    bool cut = false;
    geometry::FaceGeometry face{};              ///< set if `cut`
    geometry::FaceGeometry::FaceSight sight{};  ///< likewise

    /// The payload at one end of the ray's path through the splat's matter. `border`: the volume's outward normal if
    /// the path ends at the border, else 0.
    glm::dvec3 at(const FaceEnd& end, const glm::dvec3& border, Payload payload) {
        const VoxelEdge& edge = record.edge;
        glm::dvec3 outward = edge.has_normal ? edge.n : glm::dvec3(0);
        bool upper = edge.upper;
        if (cut) {
            outward = face.normal_at(sight, end, true);
            // In a layer between two iso-values both normals point to the lower values.
            const glm::dvec3 a = glm::abs(edge.n);
            const int axis = a.x >= a.y && a.x >= a.z ? 0 : (a.y >= a.z ? 1 : 2);
            upper = upper != (edge.mixed && outward[axis] * edge.n[axis] < 0);
        }
        if (border != glm::dvec3(0)) {
            outward = border;
            upper = false;
        }
        // If the eye is inside the matter, light falls just in front of it.
        const double eye = glm::dot(view.eye_index - center - p, u);
        const glm::dvec3 at = center + p + std::max(end.z, eye + 1e-4) * u;
        const bool faceless = glm::length(outward) == 0;
        const glm::dvec3 normal = faceless ? glm::dvec3(0) : world_normal(view.geometry, upper ? -outward : outward);
        if (payload == Payload::Depth) return {view.depth(at), 0, 0};
        if (payload == Payload::Normal) return normal;
        const bool unlit = lights_edges_only(scene, settings.edges != EdgeEstimator::Off) && !edge.has_edge;
        return shade(scene,
                     {.color = record.color(scene),
                      .response = scene.materials[record.material].response,
                      .normal = unlit ? glm::dvec3(0) : normal,
                      .position = view.geometry.to_world(at),
                      .depth = view.depth(at)},
                     view.frame.eye, record.reach_at(end.side < 0));
    }
};

}  // namespace

glm::dvec3 face_payload(const SplatRecord& record, const Field& field, const Scene& scene, const View& view,
                        const Settings& settings, Payload payload, const Footprints& footprints, const glm::dvec3& p,
                        const glm::dvec3& u, const Slice& slice, bool plain) {
    const VoxelEdge& edge = record.edge;
    if (payload == Payload::Distance) return payload_of(record, field, scene, view, settings, payload);
    SeenSplat seen{record, scene, view, settings, glm::dvec3(field.voxel(record.voxel)), p, u, footprints.cuts(edge)};
    if (!seen.cut) return seen.at({0, 1, 0}, glm::dvec3(0), payload);
    seen.face.take(drawn_edge(edge, settings));
    seen.sight = seen.face.face_sight(p, u);
    const double radius = footprints.kernel().radius;
    const double eye = glm::dot(view.eye_index - seen.center - p, u);
    const VolumePiece inside = piece_in_volume(view.geometry.dims, view.eye_index, u).seen_from(eye);
    if (plain) {
        // A widened kernel is lit where the ray through its voxel's centre enters the face.
        const Quadratic phi = seen.face.face_sight(glm::dvec3(0), u).ray.phi;
        const double value = phi.c, along = phi.b;
        const double begin = std::max(along < 0 ? -value / along : -radius, -radius);
        const bool at_border = value < 0 && inside.low > std::max(begin, eye);
        return seen.at({at_border ? inside.low : 0, 1, 0}, at_border ? inside.normal : glm::dvec3(0), payload);
    }
    FaceFootprint f = footprints.at_face(edge, p, u, slice);
    const bool at_border = inside.low > std::max(f.entry.z, eye);
    const glm::dvec3 normal = at_border ? inside.normal : glm::dvec3(0);
    if (at_border) f.entry.z = inside.low;
    if (payload != Payload::Color || !footprints.lit_in_depth(edge)) return seen.at(f.entry, normal, payload);
    const double half_chord = std::sqrt(std::max(radius * radius - glm::dot(p, p), 0.0));
    const double absorbs = record.extinction(scene) * glm::length(view.geometry.index_to_world_axes * u);
    const auto path = seen.face.lit_path(f.entry.z, f.leave.z, at_border, inside.high, half_chord, absorbs, edge.mixed,
                                         seen.sight.ray.phi);
    f.entry.z = path.near;
    f.leave.z = path.far;
    return glm::mix(seen.at(f.entry, normal, payload),
                    seen.at(f.leave, path.to_border ? inside.far_normal : glm::dvec3(0), payload), path.share);
}

SplatDrawer::SplatDrawer(std::span<const SplatRecord> records, std::span<const Selected> selected, const Field& field,
                         const Scene& scene, const View& view, const Settings& settings, const Footprints& footprints,
                         std::span<const double> ends)
    : records_(records),
      selected_(selected),
      field_(field),
      scene_(scene),
      view_(view),
      settings_(settings),
      footprints_(footprints),
      ends_(ends),
      clip_(index_clip(scene.effects.clip, view.geometry)) {
    rays_.reserve(static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height));
    for (int y = 0; y < view.height; ++y) {
        for (int x = 0; x < view.width; ++x) {
            const glm::dvec3 u = view.ray(x, y);
            rays_.emplace_back(u, glm::length(view.geometry.index_to_world_axes * u));
        }
    }
}

const glm::dvec4& SplatDrawer::ray_of(int x, int y) const {
    return rays_[static_cast<std::size_t>(y) * static_cast<std::size_t>(view_.width) + static_cast<std::size_t>(x)];
}

double SplatDrawer::end_of(int x, int y, double ahead) const {
    if (ends_.empty()) return Slice{}.high;
    const double end =
        ends_[static_cast<std::size_t>(y) * static_cast<std::size_t>(view_.width) + static_cast<std::size_t>(x)] -
        ahead;
    return end < footprints_.kernel().radius ? end : Slice{}.high;
}

double SplatDrawer::footprint(std::uint32_t splat, const VoxelEdge& edge, int x, int y, const glm::dvec3& p,
                              const glm::dvec3& u, const std::optional<Slice>& slice) const {
    const PixelFilter& filter = selected_[splat].filter;
    double own = 0;
    Slice piece = slice.value_or(Slice{});
    if (footprints_.cuts(edge)) {
        const double eye = glm::dot(view_.eye_index - glm::dvec3(field_.voxel(records_[splat].voxel)), u);
        const VolumePiece inside = piece_in_volume(view_.geometry.dims, view_.eye_index, u).seen_from(eye);
        piece = {std::max(piece.low, inside.low), std::min(piece.high, inside.high)};
    }
    const double reach = footprints_.reach(edge), half = std::sqrt(std::max(reach * reach - glm::dot(p, p), 0.0));
    if (filter.share < 1 && footprints_.tabulated(edge) && piece.low <= -half && piece.high >= half)
        own = half > 0 ? footprints_.table_value(selected_[splat].layer, selected_[splat].axis, p) : 0;
    else if (filter.share < 1 && (slice || footprints_.cuts(edge)))
        own = footprints_.along_slice(edge, p, u, piece);
    else if (filter.share < 1)
        own = footprints_.along_ray(edge, p, u);
    if (filter.share == 0) return own;
    // The pixel filter widens kernels across the view only; along z they keep their depth.
    const double rho2 = filter.rho2(glm::dot(p, p), glm::dvec2(x, y) + 0.5 + view_.offset);
    const Kernel& kernel = footprints_.kernel();
    double wide = kernel_footprint(rho2, kernel);
    if (slice) {
        const double z = depth_on_ray(p, u);
        wide = sliced_kernel_footprint(rho2, {slice->low - z, slice->high - z}, kernel);
    }
    return glm::mix(own, filter.amplitude * wide, filter.share);
}

double SplatDrawer::depth_on_ray(const glm::dvec3& p, const glm::dvec3& u) const {
    const glm::dvec3 z = glm::transpose(view_.geometry.index_to_world_axes) * view_.frame.forward;
    return -glm::dot(z, p) / glm::dot(z, u);
}

bool SplatDrawer::in_matter(std::uint32_t splat, const VoxelEdge& edge, int x, int y, const glm::dvec3& p,
                            const glm::dvec3& u, double z) const {
    const PixelFilter& filter = selected_[splat].filter;
    if (filter.share < 1) return footprints_.in_matter(edge, p, u, z);
    const double rho2 = filter.rho2(glm::dot(p, p), glm::dvec2(x, y) + 0.5 + view_.offset);
    const double from_voxel = z - depth_on_ray(p, u);
    return rho2 + from_voxel * from_voxel < std::pow(footprints_.kernel().radius, 2);
}

double SplatDrawer::tau(std::uint32_t splat, int x, int y, const std::optional<DepthRange>& cut) const {
    const SplatRecord& record = records_[splat];
    const glm::dvec4& ray = ray_of(x, y);
    const glm::dvec3 u(ray);
    const glm::dvec3 v = glm::dvec3(field_.voxel(record.voxel)) - view_.eye_index;
    const double s0 = glm::dot(v, u);
    const glm::dvec3 p = s0 * u - v;
    if (cut) {
        const double depth_along = glm::dot(view_.frame.forward, view_.geometry.index_to_world_axes * u);
        const Slice slice{cut->near / depth_along - s0, cut->far / depth_along - s0};
        return record.extinction(scene_) * ray.w * footprint(splat, record.edge, x, y, p, u, slice);
    }
    // At the end of the ray a kernel is cut at the eye, too.
    const double end = end_of(x, y, s0);
    const bool ends = end < Slice{}.high;
    const double share = ends ? 1 : in_front(s0, footprints_.kernel().radius);
    if (!(share > 0)) return 0;
    const auto slice = ends ? std::optional(Slice{-s0, std::max(end, -s0)}) : std::nullopt;
    return record.extinction(scene_) * ray.w * share * footprint(splat, record.edge, x, y, p, u, slice);
}

glm::dvec4 SplatDrawer::contribution(std::uint32_t splat, int x, int y, const glm::dvec3& own, Payload payload,
                                     const std::optional<DepthRange>& cut) const {
    const glm::dvec4& ray = ray_of(x, y);
    const glm::dvec3 u(ray), center(field_.voxel(records_[splat].voxel));
    const double s0 = glm::dot(center - view_.eye_index, u);
    const glm::dvec3 p = view_.eye_index + s0 * u - center;
    const SplatRecord& record = records_[splat];
    const bool faces = draws_faces(settings_);
    const bool plain = selected_[splat].filter.share == 1;  // fully widened kernels are not cut
    const auto quantity_of = [&](const Slice& slice) {
        return face_payload(record, field_, scene_, view_, settings_, payload, footprints_, p, u, slice, plain);
    };
    Slice slice;
    if (cut) {
        const double depth_along = glm::dot(view_.frame.forward, view_.geometry.index_to_world_axes * u);
        slice = {cut->near / depth_along - s0, cut->far / depth_along - s0};
    }
    if (const double end = end_of(x, y, s0); end < slice.high) slice = {std::max(slice.low, -s0), std::max(end, -s0)};
    if (clip_.empty()) {
        const double share = tau(splat, x, y, cut);
        return share > 0 ? share * glm::dvec4(faces ? quantity_of(slice) : own, 1) : glm::dvec4(0);
    }
    slice.low = std::max(slice.low, -s0);
    glm::dvec4 sum(0);
    for (const KeptPiece& piece : clip_.kept_along(center + p, u)) {
        const Slice kept{std::max(piece.first, slice.low), std::min(piece.last, slice.high)};
        if (piece.empty() || !(kept.low < kept.high)) continue;
        glm::dvec3 quantity = faces ? quantity_of(kept) : own;
        const glm::dvec3 entry = p + piece.first * u;
        if (piece.face && piece.first > -s0 && in_matter(splat, record.edge, x, y, p, u, piece.first)) {
            quantity = cap_payload(record, own, *piece.face, center + entry, scene_, view_, payload);
        }
        sum += footprint(splat, record.edge, x, y, p, u, kept) * glm::dvec4(quantity, 1);
    }
    return record.extinction(scene_) * ray.w * sum;
}

void SplatDrawer::draw(std::span<const std::uint32_t> splats, Payload payload, std::span<const char> closed,
                       std::span<glm::dvec4> sheet, const std::optional<DepthRange>& cut) const {
    std::vector<glm::dvec3> quantities;
    quantities.reserve(splats.size());
    for (const std::uint32_t i : splats) {
        quantities.push_back(payload_of(records_[i], field_, scene_, view_, settings_, payload, cut));
    }
    // Rows run in parallel. Every pixel adds its splats in list order, so the sum does not depend on the threads.
    parallel_for(view_.height, [&](int begin, int end) {
        for (std::size_t k = 0; k < splats.size(); ++k) {
            const PixelBox& box = selected_[splats[k]].box;
            for (int y = std::max(box.y0, begin); y < std::min(box.y1, end); ++y) {
                for (int x = box.x0; x < box.x1; ++x) {
                    const std::size_t at = static_cast<std::size_t>(y) * static_cast<std::size_t>(view_.width) +
                                           static_cast<std::size_t>(x);
                    if (!closed.empty() && closed[at] != 0) continue;
                    const glm::dvec4 added = contribution(splats[k], x, y, quantities[k], payload, cut);
                    if (added.w > 0) sheet[at] += added;
                }
            }
        }
    });
}

void SplatDrawer::outline(std::span<const std::uint32_t> splats, std::span<const glm::dvec4> frame,
                          std::span<std::optional<Outline>> outlines, const std::optional<DepthRange>& cut) const {
    parallel_for(view_.height, [&](int begin, int end) {
        for (const std::uint32_t splat : splats) {
            if (!footprints_.cuts(records_[splat].edge)) continue;
            const PixelBox& box = selected_[splat].box;
            const glm::dvec3 center(field_.voxel(records_[splat].voxel));
            for (int y = std::max(box.y0, begin); y < std::min(box.y1, end); ++y) {
                for (int x = box.x0; x < box.x1; ++x) {
                    const std::size_t at = static_cast<std::size_t>(y) * static_cast<std::size_t>(view_.width) +
                                           static_cast<std::size_t>(x);
                    if (frame[at].w >= static_cast<double>(shader::OUTLINE_OPEN)) continue;
                    const glm::dvec3 u(rays_[at]);
                    const double ahead = glm::dot(center - view_.eye_index, u);
                    const glm::dvec3 p = view_.eye_index + ahead * u - center;
                    const double radius = footprints_.kernel().radius;
                    if (!(glm::dot(p, p) < radius * radius)) continue;
                    const double tau = contribution(splat, x, y, glm::dvec3(0), Payload::Distance, cut).w;
                    const VoxelEdge& edge = records_[splat].edge;
                    keep_outer(outlines[at], outline_of(drawn_edge(edge, settings_), view_, p, u, ahead, tau));
                }
            }
        }
    });
}

}  // namespace edgesplat::reference
