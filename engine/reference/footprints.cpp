#include "engine/reference/footprints.h"

#include <cmath>

#include "engine/reference/faces.h"
#include "footprints/kernel.h"

namespace edgesplat::reference {

namespace {

PaperEdge paper_edge(const VoxelEdge& edge) {
    return {edge.D, {}};
}

}  // namespace

Footprints::Footprints(const Settings& settings)
    : settings_(settings),
      band_{settings.edge_half_width, settings.edge_strength},
      largest_radius_(largest_support_radius(band_)) {
    if (settings.warp == WarpFamily::Face) largest_radius_ = kKernelRadius + kFaceDepth;
    if (settings.edge_shape == EdgeShape::Curved) largest_radius_ = covering_supports_of_curved(band_, 1)[0].radius;
    if (asks_for_table(settings) && settings.warp == WarpFamily::Edge) {
        table_ = std::make_shared<const FootprintTable>(load_footprint_table(band_).table);
    }
}

bool Footprints::is_wall(const VoxelEdge& edge) const {
    return edge.D2 < kKernelRadius + band_.half_width;
}

Edge Footprints::faces(const VoxelEdge& edge) const {
    // The two-dimensional short cut knows one face only.
    if (settings_.footprints == FootprintMode::Warp2d) return {edge.D, band_};
    Edge drawn = wall_edge(edge.D, edge.D2, band_);
    if (!is_wall(edge)) drawn.curvature = edge.curvature;
    return drawn;
}

bool Footprints::warped(const VoxelEdge& edge) const {
    if (!edge.has_edge || settings_.footprints == FootprintMode::Isotropic) return false;
    if (settings_.warp == WarpFamily::Face) return true;
    if (settings_.warp == WarpFamily::Paper) return edge.D < kKernelRadius;
    return std::abs(edge.D) < kKernelRadius + band_.half_width && faces(edge).band.strength > 1;
}

bool Footprints::near_edge(const VoxelEdge& edge) const {
    return edge.has_edge && std::abs(edge.D) < edge_reach(settings_) &&
           settings_.footprints != FootprintMode::Isotropic;
}

double Footprints::at_point(const VoxelEdge& edge, const glm::dvec3& r) const {
    const double r2 = glm::dot(r, r);
    if (!warped(edge)) return edge.weight * kernel(r2);
    if (settings_.warp == WarpFamily::Face) {
        // What a ray across the face meets there.
        const double along = glm::dot(r, edge.n);
        return face_path(edge, r - along * edge.n, edge.n).kernel_at(along);
    }
    const double t = glm::dot(r, edge.n);
    if (settings_.warp == WarpFamily::Edge) return edge.weight * kernel(warped_distance2(r2, t, faces(edge)));
    const double w = warped_coordinate(t, paper_edge(edge));
    return edge.weight * kernel(r2 - t * t + w * w);
}

double Footprints::along_ray(const VoxelEdge& edge, const glm::dvec3& p, const glm::dvec3& u) const {
    const Ray ray{glm::dot(p, p), glm::dot(p, edge.n), glm::dot(u, edge.n)};
    if (!warped(edge)) return edge.weight * kernel_footprint(ray.rho2);
    if (table_ && !is_wall(edge) && edge.curvature == 0) {
        return edge.weight * (settings_.footprints == FootprintMode::Table ? table_->nearest(ray, edge.D)
                                                                           : table_->lerp(ray, edge.D));
    }
    return along_slice(edge, p, u, {});
}

double Footprints::along_slice(const VoxelEdge& edge, const glm::dvec3& p, const glm::dvec3& u,
                               const Slice& slice) const {
    const Ray ray{glm::dot(p, p), glm::dot(p, edge.n), glm::dot(u, edge.n)};
    if (!warped(edge)) return edge.weight * sliced_kernel_footprint(ray.rho2, slice);
    if (settings_.warp == WarpFamily::Face) return at_face(edge, p, u, slice).integral;
    const bool flat = settings_.footprints == FootprintMode::Warp2d;
    if (settings_.warp == WarpFamily::Paper) {
        return edge.weight * (flat ? warp2d_footprint(ray, paper_edge(edge), slice)
                                   : procedural_footprint(ray, paper_edge(edge), 10, slice));
    }
    if (flat) return edge.weight * warp2d_footprint(ray, faces(edge), slice);
    const Edge drawn = faces(edge);
    return edge.weight * procedural_footprint(ray, drawn, drawn.curvature == 0 ? 8 : 16, slice);
}

bool Footprints::cuts(const VoxelEdge& edge) const {
    return settings_.warp == WarpFamily::Face && warped(edge);
}

FaceFootprint Footprints::at_face(const VoxelEdge& edge, const glm::dvec3& p, const glm::dvec3& u,
                                  const Slice& slice) const {
    constexpr int kNodes = 6;
    return face_path(edge, p, u).footprint(kNodes, slice);
}

bool Footprints::in_matter(const VoxelEdge& edge, const glm::dvec3& r) const {
    const double r2 = glm::dot(r, r);
    if (!near_edge(edge)) return r2 < kKernelRadius * kKernelRadius;
    if (settings_.warp == WarpFamily::Face) return at_point(edge, r) > 0;
    const double t = glm::dot(r, edge.n), q = t - edge.D;
    const double curvature = is_wall(edge) ? 0 : edge.curvature;
    const double side = 2 * q + curvature * (q * q + r2 - t * t);
    const bool own_side = side < 0 && t > -edge.D2;
    if (settings_.warp == WarpFamily::Paper) return own_side && r2 < (kKernelRadius + 1) * (kKernelRadius + 1);
    return own_side && at_point(edge, r) > 0;
}

Support Footprints::support(const VoxelEdge& edge) const {
    if (!warped(edge)) return {0, kKernelRadius, kKernelRadius};
    if (settings_.warp == WarpFamily::Face) return {0, cut_of(edge).reach, cut_of(edge).reach};
    // The paper's curve moves points by less than a voxel, both ways: a bound, not the exact support.
    if (settings_.warp == WarpFamily::Paper) return {0, kKernelRadius + 1, kKernelRadius + 1};
    return {0, largest_radius_, largest_radius_};
}

}  // namespace edgesplat::reference
