#include "engine/reference/5_draw_splats.h"

#include <algorithm>
#include <cmath>

#include "engine/reference/parallel.h"
#include "footprints/kernel.h"

namespace edgesplat::reference {

namespace {

glm::dvec3 world_normal(const VolumeGeometry& geometry, const glm::dvec3& n_index) {
    return glm::normalize(glm::transpose(glm::inverse(geometry.index_to_world_axes)) * n_index);
}

/// Share of a kernel that lies in front of the eye.
double in_front(double s0) {
    const double t = std::clamp((s0 + kKernelRadius) / (2 * kKernelRadius), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

}  // namespace

double light_on(const Light& light, const VolumeGeometry& geometry, const glm::dvec3& n_index,
                const glm::dvec3& position, const glm::dvec3& eye) {
    if (light.kind == Light::Kind::None) return 1;
    if (n_index == glm::dvec3(0)) return light.ambient + light.diffuse / 2;
    const glm::dvec3 towards = light.kind == Light::Kind::Headlight ? eye - position : light.direction;
    const double length = glm::length(towards);
    // A voxel centre exactly at the eye: every direction is as good.
    const double facing = length > 0 ? glm::dot(world_normal(geometry, n_index), towards / length) : 1.0;
    return light.ambient + light.diffuse * std::max(facing, 0.0);
}

glm::dvec3 payload_of(const SplatRecord& record, const Field& field, const Scene& scene, const View& view,
                      const Settings& settings, Payload payload) {
    const VoxelEdge& edge = record.edge;
    const glm::dvec3 x(field.voxel(record.voxel));
    // A surface faces its lower values, whichever side of it the splat is on.
    glm::dvec3 n = edge.has_normal ? (edge.upper ? -edge.n : edge.n) : glm::dvec3(0);
    // A wall's kernel reaches both faces, and the one that is seen faces the eye.
    const bool wall = edge.has_edge && edge.D2 < kKernelRadius + settings.edge_half_width;
    if (wall && glm::dot(world_normal(view.geometry, n), view.frame.eye - view.geometry.to_world(x)) < 0) {
        n = -n;
    }
    switch (payload) {
        case Payload::Color:
            return scene.materials[record.material].color *
                   light_on(scene.light, view.geometry, n, view.geometry.to_world(x), view.frame.eye);
        case Payload::Depth:
            return {view.depth(x), 0, 0};
        case Payload::Distance:
            if (!edge.has_edge) return {-(kKernelRadius + settings.edge_half_width), 0, 0};
            return {edge.upper ? edge.D : -edge.D, 0, 0};
        case Payload::Normal:
            break;
    }
    return edge.has_normal ? world_normal(view.geometry, n) : glm::dvec3(0);
}

SplatDrawer::SplatDrawer(std::span<const SplatRecord> records, std::span<const Selected> selected, const Field& field,
                         const Scene& scene, const View& view, const Settings& settings, const Footprints& footprints)
    : records_(records),
      selected_(selected),
      field_(field),
      scene_(scene),
      view_(view),
      settings_(settings),
      footprints_(footprints) {
    rays_.reserve(static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height));
    for (int y = 0; y < view.height; ++y) {
        for (int x = 0; x < view.width; ++x) {
            const glm::dvec3 u = view.ray(x, y);
            rays_.emplace_back(u, glm::length(view.geometry.index_to_world_axes * u));
        }
    }
}

double SplatDrawer::tau(std::uint32_t splat, int x, int y, const std::optional<DepthRange>& cut) const {
    const SplatRecord& record = records_[splat];
    const glm::dvec4& ray =
        rays_[static_cast<std::size_t>(y) * static_cast<std::size_t>(view_.width) + static_cast<std::size_t>(x)];
    const glm::dvec3 u(ray);
    const glm::dvec3 v = glm::dvec3(field_.voxel(record.voxel)) - view_.eye_index;
    const double s0 = glm::dot(v, u);
    if (cut) {
        const double depth_along = glm::dot(view_.frame.forward, view_.geometry.index_to_world_axes * u);
        const Slice slice{cut->near / depth_along - s0, cut->far / depth_along - s0};
        return scene_.materials[record.material].extinction * ray.w *
               footprints_.along_slice(record.edge, s0 * u - v, u, slice);
    }
    const double share = in_front(s0);
    if (!(share > 0)) return 0;
    const glm::dvec3 p = s0 * u - v;
    return scene_.materials[record.material].extinction * ray.w * share * footprints_.along_ray(record.edge, p, u);
}

void SplatDrawer::draw(std::span<const std::uint32_t> splats, Payload payload, std::span<const char> closed,
                       std::span<glm::dvec4> sheet, const std::optional<DepthRange>& cut) const {
    std::vector<glm::dvec3> quantities;
    quantities.reserve(splats.size());
    for (const std::uint32_t i : splats) {
        glm::dvec3 quantity = payload_of(records_[i], field_, scene_, view_, settings_, payload);
        if (cut && payload == Payload::Depth) quantity.x = std::clamp(quantity.x, cut->near, cut->far);
        quantities.push_back(quantity);
    }
    // Rows in parallel: every pixel adds its splats in the list's order, however the rows are shared out.
    parallel_for(view_.height, [&](int begin, int end) {
        for (std::size_t k = 0; k < splats.size(); ++k) {
            const PixelBox& box = selected_[splats[k]].box;
            for (int y = std::max(box.y0, begin); y < std::min(box.y1, end); ++y) {
                for (int x = box.x0; x < box.x1; ++x) {
                    const std::size_t at = static_cast<std::size_t>(y) * static_cast<std::size_t>(view_.width) +
                                           static_cast<std::size_t>(x);
                    if (!closed.empty() && closed[at] != 0) continue;
                    const double t = tau(splats[k], x, y, cut);
                    if (t > 0) sheet[at] += t * glm::dvec4(quantities[k], 1);
                }
            }
        }
    });
}

}  // namespace edgesplat::reference
