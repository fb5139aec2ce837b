#include "engine/reference/surfaces.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "engine/geometry/in_double.h"
#include "engine/reference/faces.h"
#include "engine/reference/parallel.h"
#include "engine/reference/volume_piece.h"
#include "shaders/shared/limits.h"

namespace edgesplat::reference {

namespace {

using glm::dvec3;
using glm::ivec3;

constexpr auto kReach = static_cast<double>(shader::SURFACE_REACH);
constexpr auto kWindow = static_cast<double>(shader::SURFACE_WINDOW);
constexpr auto kCreaseReach = static_cast<double>(shader::CREASE_REACH);
constexpr auto kSide = static_cast<double>(shader::SURFACE_SIDE);
constexpr double kNowhere = std::numeric_limits<double>::infinity();

bool is_matter(const Field& field, const ScaledScene& scene, const ivec3& i, int m) {
    return i == field.clamped(i) && field.has_data(field.offset(i)) && scene.material(field.at(i)) == m;
}

bool is_outermost(const Field& field, const ivec3& i) {
    return glm::any(glm::equal(i, ivec3(0))) || glm::any(glm::equal(i, field.dims - 1));
}

/// Whether matter of voxel i ends on one of its six sides, or the volume does.
bool ends_beside(const Field& field, const ScaledScene& scene, const ivec3& i, int m) {
    for (int axis = 0; axis < 3; ++axis)
        for (const int step : {-1, 1}) {
            ivec3 j = i;
            j[axis] += step;
            if (!is_matter(field, scene, j, m)) return true;
        }
    return false;
}

geometry::SurfaceCheck checked(const Field& field, const ivec3& i, const geometry::SurfaceSplat& face, const dvec3& n,
                               double iso, bool upper) {
    geometry::SurfaceCheck check = geometry::no_check();
    for (int k = 0; k < geometry::SURFACE_CHECKS; ++k) {
        const dvec3 at = geometry::checked_point(face, n, k), p = dvec3(i) + at;
        const dvec3 slope = spline_gradient(field, p);
        geometry::check_point(check, face, at, sample(field, p, true) - iso, upper ? -slope : slope);
    }
    return check;
}

/// A ray's pieces in matter, searched in small steps.
struct Pieces {
    struct Piece {
        double begin = 0, end = kNowhere;
        dvec3 n{0};  ///< to the lower values
    };
    std::vector<Piece> pieces;
};

Pieces pieces_of(const Field& field, const dvec3& eye, const dvec3& u, const VoxelEdge::Interval& interval) {
    const VolumePiece whole = piece_in_volume(field.dims, eye, u);
    const double from = std::max(whole.low, 0.0);
    Pieces found;
    if (!(from < whole.high)) return found;
    const auto value = [&](double z) { return sample(field, eye + z * u, true); };
    const auto root = [&](double a, double b) {
        const bool inside = interval.holds(value(a));
        for (int step = 0; step < 40; ++step) {
            const double middle = 0.5 * (a + b);
            (interval.holds(value(middle)) == inside ? a : b) = middle;
        }
        return b;
    };
    bool inside = interval.holds(value(from));
    if (inside) found.pieces.push_back({from, kNowhere, whole.low > 0 ? whole.normal : dvec3(0)});
    constexpr double kStep = 0.1;
    for (double a = from; a < whole.high; a += kStep) {
        const double b = std::min(a + kStep, whole.high);
        if (interval.holds(value(b)) == inside) continue;
        const double z = root(a, b);
        if (inside) found.pieces.back().end = z;
        if (!inside) found.pieces.push_back({z, kNowhere, -spline_gradient(field, eye + z * u)});
        inside = !inside;
    }
    return found;
}

geometry::SurfacePlane plane_of(const dvec3& n, double away) {
    return {n, std::isfinite(away) ? away : 1e9};
}

/// A surface splat in a picture.
struct DrawnSplat {
    const SplatRecord* record = nullptr;
    dvec3 x{0};
    bool traced = false, creased = false;
    geometry::SurfaceSplat face;
    int sheet = 0;
    PixelBox box;
};

double longest_voxel(const VolumeGeometry& geometry) {
    const dvec3 spacing = geometry.spacing();
    return std::max({spacing.x, spacing.y, spacing.z});
}

DrawnSplat drawn_splat(const SplatRecord& record, const Field& field, const View& view, double thickness) {
    const VoxelEdge& edge = record.edge;
    DrawnSplat s;
    s.record = &record;
    s.x = dvec3(field.voxel(record.voxel));
    const double depth = std::max(view.depth(s.x), view.mm_per_voxel_along);
    const double pixels = longest_voxel(view.geometry) * view.height / (2 * view.frame.tan_half_y * depth);
    s.traced = edge.traced && edge.D2 * pixels > static_cast<double>(shader::SURFACE_SHOWS);
    s.creased = !s.traced && edge.crease.D < kCreaseReach;
    const dvec3 foot = edge.D * edge.n, turned = edge.bending * foot;
    s.face = {-edge.D + 0.5 * glm::dot(foot, turned), edge.n - turned, edge.bending, foot, kReach};
    const dvec3 center = s.x + (s.traced || s.creased ? dvec3(0) : foot);
    const double crease = s.creased ? static_cast<double>(shader::SURFACE_CREASE) : 0;
    s.box = screen_box(view, {center, kReach + crease});
    s.sheet = static_cast<int>(std::max(std::floor(view.depth(center) / thickness), 0.0));
    return s;
}

/// The vote of a splat on the ray with direction u; `ahead`: distance from the eye to its point p, nearest to the
/// voxel.
geometry::SurfaceVote vote_on(const DrawnSplat& s, const Pieces& ray, const dvec3& p, const dvec3& u, double ahead) {
    const VoxelEdge& edge = s.record->edge;
    if (!s.traced) {
        geometry::SurfaceVote vote =
            s.creased ? geometry::vote_of_planes(plane_of(edge.n, edge.D), plane_of(edge.crease.n, edge.crease.D),
                                                 plane_of(edge.corner.n, edge.corner.D), kReach, p, u)
                      : geometry::vote_of(s.face, p, u);
        if (edge.upper) vote.n = -vote.n;
        return vote;
    }
    const double half_chord = std::sqrt(std::max(kReach * kReach - glm::dot(p, p), 0.0));
    const double low = std::max(ahead - half_chord, 0.0), high = ahead + half_chord;
    double enters = kNowhere;
    dvec3 n(0);
    bool matter = false;
    for (const Pieces::Piece& piece : ray.pieces) {
        matter = matter || std::min(piece.end, high) > std::max(piece.begin, low);
        if (!(piece.begin > low && piece.begin < enters)) continue;
        enters = piece.begin;
        n = piece.n;
    }
    return geometry::vote_of_traced(low, high, enters, matter, n, kReach, p, u, ahead);
}

dvec3 payload_at(const geometry::SurfaceVotes& votes, std::span<const SplatRecord> records, const Scene& scene,
                 const View& view, const dvec3& u, Payload payload) {
    const SplatRecord& record = records[votes.number];
    const dvec3 at = view.eye_index + std::max(geometry::way_to(votes), 1e-4) * u;
    const dvec3 outward = glm::transpose(glm::inverse(view.geometry.index_to_world_axes)) * votes.normal;
    const double length = glm::length(outward);
    const dvec3 normal = length > 0 ? outward / length : dvec3(0);
    switch (payload) {
        case Payload::Color:
            return shade(scene,
                         {.color = record.color(scene),
                          .response = scene.materials[record.material].response,
                          .normal = normal,
                          .position = view.geometry.to_world(at),
                          .depth = view.depth(at)},
                         view.frame.eye, record.reach);
        case Payload::Depth:
            return {view.depth(at), 0, 0};
        case Payload::Distance:
            return {-record.edge.D, 0, 0};
        case Payload::Normal:
            break;
    }
    return normal;
}

}  // namespace

VoxelEdge fit_surface(const Field& field, const ScaledScene& scene, const std::vector<VoxelEdge>& surfels,
                      const ivec3& i, int m, double noise, bool two_values) {
    VoxelEdge face;
    face.has_edge = face.has_normal = true;
    face.n = {0, 0, 1};
    face.D2 = kNowhere;
    const VoxelEdge::Interval interval{scene.lower(m), scene.upper(m)};
    const auto around = [&](const ivec3& center, const auto& take) {
        for (int k = 0; k < 125; ++k) {
            const ivec3 j = center + ivec3(k % 5, k / 5 % 5, k / 25) - 2;
            const auto s = surfel_of(field, scene, surfels, i, j, m);
            if (s && !s->border) take(*s);
        }
    };
    Surfel nearest;
    double distance = static_cast<double>(shader::KERNEL_RADIUS);
    bool found = false;
    around(i, [&](const Surfel& s) {
        if (!(glm::length(s.at) < distance - 1e-4)) return;
        distance = glm::length(s.at);
        nearest = s;
        found = true;
    });
    face.traced = interval;
    if (!found) return face;
    const dvec3 middle = nearest.at;
    Moments sums;
    around(i + ivec3(glm::roundEven(middle)), [&](const Surfel& s) {
        const dvec3 r = s.at - middle;
        const double w = 1 - glm::dot(r, r) / std::pow(static_cast<double>(shader::SURFACE_FIT), 2);
        if (w > 0 && glm::dot(s.n, nearest.n) > 0) sums.add(r, s.n, w * w);
    });
    const Quadric q = quadric_of(sums);
    const Foot foot = foot_of(q, -middle, dvec3(0));
    const double steep = glm::length(foot.slope);
    const bool real = steep >= 0.3 && std::abs(q.at(foot.at)) < 0.05 &&
                      glm::length(foot.at) < static_cast<double>(shader::SURFACE_FIT);
    face.upper = nearest.upper;
    face.n = real ? foot.slope / steep : nearest.n;
    face.D = glm::dot(real ? middle + foot.at : middle, face.n);
    bool kept = false;
    if (real) {
        face.bending = q.h / steep;
        const geometry::SurfaceSplat own{q.at(-middle) / steep, q.slope(-middle) / steep, face.bending,
                                         middle + foot.at, kReach};
        const double iso = face.upper ? scene.upper(m) : scene.lower(m);
        const geometry::SurfaceCheck check = checked(field, i, own, face.n, iso, face.upper);
        double wrong = 0;
        for (int k = 0; k < 27; ++k) {
            const ivec3 o = ivec3(k % 3, k / 3 % 3, k / 9) - 1;
            wrong = std::max(wrong, geometry::contradiction(own, dvec3(o), is_matter(field, scene, i + o, m)));
        }
        const double moved = two_values ? 0 : geometry::moved_by_noise(check.steep, noise);
        kept = (two_values || geometry::is_verified(check, noise)) && wrong <= kSide + moved && face.D > -0.05 &&
               !is_outermost(field, i);
        if (!is_outermost(field, i)) face.D2 = std::max(geometry::error_of(check), wrong);
    }
    if (two_values) {
        VoxelEdge planes = fit_face(field, scene, surfels, i, m);
        planes.traced.reset();
        if (std::isfinite(planes.crease.D)) return planes;
    }
    if (kept) face.traced.reset();
    return face;
}

std::vector<SplatRecord> surface_splats(const Field& field, const ScaledScene& scene,
                                        const std::vector<VoxelEdge>& surfels, double noise, bool two_values,
                                        bool quantised) {
    std::vector<SplatRecord> records;
    for (std::size_t at = 0; at < field.values.size(); ++at) {
        const int m = scene.material(field.at(field.voxel(at)));
        if (field.has_data(at) && scene.drawn[static_cast<std::size_t>(m)] &&
            ends_beside(field, scene, field.voxel(at), m))
            records.push_back({static_cast<std::uint32_t>(at), static_cast<std::uint32_t>(m), {}});
    }
    parallel_for(static_cast<int>(records.size()), [&](int begin, int end) {
        for (int k = begin; k < end; ++k) {
            SplatRecord& record = records[static_cast<std::size_t>(k)];
            record.edge = fit_surface(field, scene, surfels, field.voxel(record.voxel),
                                      static_cast<int>(record.material), noise, two_values);
            if (quantised) record.edge = quantise(record.edge);
        }
    });
    return records;
}

std::vector<glm::dvec4> draw_surfaces(std::span<const SplatRecord> records, const Field& field, const Scene& scene,
                                      const View& view, const Settings& settings, Payload payload) {
    const double thickness = sheet_thickness(view, settings);
    std::vector<DrawnSplat> splats;
    splats.reserve(records.size());
    bool creases = false;
    for (const SplatRecord& record : records) {
        splats.push_back(drawn_splat(record, field, view, thickness));
        creases = creases || record.edge.crease.D < kCreaseReach;
    }
    std::vector<std::uint32_t> order(splats.size());
    std::iota(order.begin(), order.end(), 0U);
    std::ranges::stable_sort(order, {}, [&](std::uint32_t i) { return splats[i].sheet; });
    const dvec3 view_z = glm::transpose(view.geometry.index_to_world_axes) * view.frame.forward;
    const double reach = (kReach + (creases ? static_cast<double>(shader::SURFACE_CREASE) : 0)) * glm::length(view_z);
    std::vector<glm::dvec4> frame(static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height),
                                  glm::dvec4(0));
    parallel_for(view.height, [&](int begin, int end) {
        struct Pixel {
            geometry::SurfacePair pair = geometry::no_surfaces();
            bool closed = false;
            std::optional<Pieces> pieces;
        };
        const auto width = static_cast<std::size_t>(view.width);
        std::vector<Pixel> pixels(width * static_cast<std::size_t>(end - begin));
        for (const std::uint32_t number : order) {
            const DrawnSplat& s = splats[number];
            for (int y = std::max(s.box.y0, begin); y < std::min(s.box.y1, end); ++y)
                for (int x = s.box.x0; x < s.box.x1; ++x) {
                    Pixel& pixel = pixels[static_cast<std::size_t>(y - begin) * width + static_cast<std::size_t>(x)];
                    if (pixel.closed) continue;
                    const dvec3 u = view.ray(x, y), from_eye = s.x - view.eye_index;
                    // No later vote is about the first surface.
                    const double sheet = (thickness * s.sheet - reach) / glm::dot(view_z, u);
                    if (sheet > geometry::way_to(pixel.pair.front) + kWindow) {
                        pixel.closed = geometry::wins(pixel.pair.front);
                        if (pixel.closed) continue;
                        geometry::refuse_front(pixel.pair);
                    }
                    if (s.traced && !pixel.pieces)
                        pixel.pieces = pieces_of(field, view.eye_index, u, *s.record->edge.traced);
                    const double ahead = glm::dot(from_eye, u);
                    geometry::SurfaceVote vote =
                        vote_on(s, pixel.pieces.value_or(Pieces{}), ahead * u - from_eye, u, ahead);
                    const VolumePiece whole = piece_in_volume(field.dims, view.eye_index, u);
                    const double way = ahead + vote.z;
                    if (!(way >= whole.low - 1e-3 && way <= whole.high)) vote.weight = 0;
                    if (vote.enters && way < whole.low + 3e-3)
                        vote.weight *= static_cast<double>(shader::SURFACE_CERTAIN);
                    geometry::count_vote(pixel.pair, vote, way, number);
                }
        }
        for (int y = begin; y < end; ++y)
            for (int x = 0; x < view.width; ++x) {
                Pixel& pixel = pixels[static_cast<std::size_t>(y - begin) * width + static_cast<std::size_t>(x)];
                for (int k = 0; k < 2; ++k)
                    if (!geometry::wins(pixel.pair.front)) geometry::refuse_front(pixel.pair);
                if (!(pixel.pair.front.hits > 0)) continue;
                const dvec3 value = payload_at(pixel.pair.front, records, scene, view, view.ray(x, y), payload);
                frame[static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)] = glm::dvec4(value, 1);
            }
    });
    return frame;
}

}  // namespace edgesplat::reference
