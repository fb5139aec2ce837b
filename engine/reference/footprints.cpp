#include "engine/reference/footprints.h"

#include <algorithm>
#include <cmath>

#include "engine/reference/face_geometry.h"
#include "engine/reference/faces.h"
#include "footprints/kernel.h"
#include "shaders/shared/limits.h"

namespace edgesplat::reference {

namespace {

PaperEdge paper_edge(const VoxelEdge& edge) {
    return {edge.D, {}};
}

}  // namespace

Footprints::Footprints(const Settings& settings, double table_depth, FacePieces pieces)
    : settings_(settings), table_depth_(table_depth), pieces_(pieces) {}

const Kernel& Footprints::kernel() const {
    return draws_faces(settings_) ? kernel_of_table(table_depth_) : kKernel;
}

bool Footprints::warped(const VoxelEdge& edge) const {
    if (!edge.has_edge || settings_.footprints == FootprintMode::Isotropic) return false;
    if (settings_.warp == WarpFamily::Face) return edge.D < kernel().radius + FACE_DEPTH;
    return edge.D < kKernelRadius;
}

double Footprints::at_point(const VoxelEdge& edge, const glm::dvec3& r) const {
    const double r2 = glm::dot(r, r);
    if (!warped(edge)) return edgesplat::kernel(r2, kernel());
    if (settings_.warp == WarpFamily::Face) {
        // The value on a ray through r along the face's normal.
        const double along = glm::dot(r, edge.n);
        return face_path(edge, r - along * edge.n, edge.n).kernel_at(along);
    }
    const double t = glm::dot(r, edge.n);
    const double w = warped_coordinate(t, paper_edge(edge));
    return edgesplat::kernel(r2 - t * t + w * w);
}

double Footprints::along_ray(const VoxelEdge& edge, const glm::dvec3& p, const glm::dvec3& u) const {
    return warped(edge) ? along_slice(edge, p, u, {}) : kernel_footprint(glm::dot(p, p), kernel());
}

double Footprints::along_slice(const VoxelEdge& edge, const glm::dvec3& p, const glm::dvec3& u,
                               const Slice& slice) const {
    const Ray ray{glm::dot(p, p), glm::dot(p, edge.n), glm::dot(u, edge.n)};
    if (!warped(edge)) return sliced_kernel_footprint(ray.rho2, slice, kernel());
    if (settings_.warp == WarpFamily::Face) return at_face(edge, p, u, slice).integral;
    const bool flat = settings_.footprints == FootprintMode::Warp2d;
    return flat ? warp2d_footprint(ray, paper_edge(edge), slice)
                : procedural_footprint(ray, paper_edge(edge), kManyNodes, slice);
}

bool Footprints::cuts(const VoxelEdge& edge) const {
    return settings_.warp == WarpFamily::Face && warped(edge);
}

FacePath Footprints::face_path(const VoxelEdge& edge, const glm::dvec3& p, const glm::dvec3& u) const {
    geometry::FaceGeometry at(kernel());
    at.take(drawn_edge(edge, settings_));
    return {at.face_sight(p, u).ray, at.face_form.cut, at.crease_seen(p, u), kernel(), pieces_};
}

FaceFootprint Footprints::at_face(const VoxelEdge& edge, const glm::dvec3& p, const glm::dvec3& u,
                                  const Slice& slice) const {
    return face_path(edge, p, u).footprint(table_depth_ != FACE_DEPTH ? kManyNodes : kFewNodes, slice);
}

bool Footprints::tabulated(const VoxelEdge& edge) const {
    return draws_table(settings_) && (!warped(edge) || (edge.deepest == table_depth_ && is_in_table(edge, settings_)));
}

std::pair<FootprintLayer, glm::dvec3> Footprints::select(const VoxelEdge& edge, const glm::dvec3& to_voxel) const {
    if (!warped(edge)) return {plain_footprint_layer(table_depth_), glm::dvec3(0)};
    const double length = glm::length(to_voxel);
    const glm::dvec3 u = length > 1e-6 ? to_voxel / length : glm::dvec3(0);
    const double cosine = glm::dot(edge.n, u);
    const glm::dvec3 across = edge.n - cosine * u;
    const double sine = glm::length(across);
    // A ray along n: the footprint is rotationally symmetric, so any axis will do.
    return {select_footprint_layer(edge.D, std::abs(cosine), table_depth_),
            sine > 1e-4 ? across / sine : glm::dvec3(1, 0, 0)};
}

double Footprints::table_value(const FootprintLayer& layer, const glm::dvec3& axis, const glm::dvec3& p) const {
    const double x = glm::dot(p, axis);
    return kept_footprint_table(table_depth_).lookup(layer, x, std::sqrt(std::max(glm::dot(p, p) - x * x, 0.0)));
}

bool Footprints::in_matter(const VoxelEdge& edge, const glm::dvec3& p, const glm::dvec3& u, double z) const {
    const double r2 = glm::dot(p, p) + z * z;
    if (!warped(edge)) return r2 < kernel().radius * kernel().radius;
    if (settings_.warp == WarpFamily::Face) return face_path(edge, p, u).kernel_at(z) > 0;
    return glm::dot(p + z * u, edge.n) < edge.D && r2 < kPaperReach * kPaperReach;
}

double Footprints::reach(const VoxelEdge& edge) const {
    if (!warped(edge)) return kernel().radius;
    if (settings_.warp != WarpFamily::Face) return kPaperReach;
    geometry::FaceGeometry at(kernel());
    at.take(drawn_edge(edge, settings_));
    return std::sqrt(at.face_form.cut.reach2);
}

}  // namespace edgesplat::reference
