#include "engine/reference/surfaces.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "engine/reference/face_geometry.h"
#include "engine/reference/outlines.h"
#include "engine/reference/volume_piece.h"
#include "engine/volume/labels.h"
#include "engine/volume/parallel.h"
#include "shaders/shared/limits.h"

namespace edgesplat::reference {

namespace {

using glm::dvec3;
using glm::ivec3;

constexpr auto kReach = static_cast<double>(shader::SURFACE_REACH);
constexpr auto kCreaseReach = static_cast<double>(shader::CREASE_REACH);
constexpr auto kSide = static_cast<double>(shader::SURFACE_SIDE);
constexpr double kNowhere = std::numeric_limits<double>::infinity();

/// A part of a ray in the volume that clip planes keep. Distances from the eye, voxels.
struct RayPart {
    double first = 0, last = 0;
    dvec3 n{0};  ///< normal where the part begins, away from it; 0: at the eye
};

std::vector<RayPart> ray_parts(const Field& field, const IndexClip& clip, const dvec3& eye, const dvec3& u) {
    const VolumePiece whole = piece_in_volume(field.dims, eye, u);
    const double first = std::max(whole.low, 0.0);
    std::vector<RayPart> parts;
    for (const KeptPiece& piece : clip.kept_along(eye, u)) {
        const bool cut = piece.first > first;
        const dvec3 border = whole.low > 0 ? whole.normal : dvec3(0);
        const RayPart part{std::max(first, piece.first), std::min(whole.high, piece.last),
                           cut ? piece.face.value_or(dvec3(0)) : border};
        if (part.first < part.last) parts.push_back(part);
    }
    return parts;
}

/// A piece of a ray in matter.
struct Piece {
    double begin = 0, end = kNowhere;
    bool entered = false;  ///< through a surface
    dvec3 n{0};            ///< to the lower values
};

/// A ray's pieces in matter, searched in small steps.
std::vector<Piece> pieces_of(const Field& field, const ScaledScene& bodies, std::span<const RayPart> parts,
                             const dvec3& eye, const dvec3& u) {
    const auto matter = [&](double z) {
        return bodies.drawn[static_cast<std::size_t>(bodies.material(sample(field, eye + z * u, true)))];
    };
    const auto root = [&](double a, double b) {
        const bool inside = matter(a);
        for (int step = 0; step < 40; ++step) {
            const double middle = 0.5 * (a + b);
            (matter(middle) == inside ? a : b) = middle;
        }
        return b;
    };
    std::vector<Piece> found;
    for (const RayPart& part : parts) {
        bool inside = matter(part.first);
        if (inside) found.push_back({part.first, part.last, false, {}});
        constexpr double kStep = 0.1;
        for (double a = part.first; a < part.last; a += kStep) {
            const double b = std::min(a + kStep, part.last);
            if (matter(b) == inside) continue;
            const double z = root(a, b);
            if (inside) found.back().end = z;
            if (!inside) found.push_back({z, part.last, true, -spline_gradient(field, eye + z * u)});
            inside = !inside;
        }
    }
    return found;
}

/// The outlines of the field next to a ray between `low` and `high`: where it passes nearest to matter, and where it is
/// deepest behind the begin of its first piece.
std::optional<Outline> searched_outline(const Field& field, const ScaledScene& bodies, std::span<const RayPart> parts,
                                        std::span<const Piece> pieces, const View& view, const dvec3& u, double low,
                                        double high) {
    const dvec3& eye = view.eye_index;
    const auto slope = [&](double z) { return glm::dot(spline_gradient(field, eye + z * u), u); };
    // Where the field turns between a and b, or nullopt.
    const auto turn = [&](double a, double b) -> std::optional<double> {
        const bool rises = slope(a) > 0;
        if ((slope(b) > 0) == rises) return {};
        for (int step = 0; step < 30; ++step)
            ((slope(0.5 * (a + b)) > 0) == rises ? a : b) = 0.5 * (a + b);
        return a;
    };
    constexpr double kStep = 0.1;
    std::optional<Outline> found;
    // The level is 0 at the value `end`, and `outward` is 1 if values grow out of the matter, else -1.
    const auto keep = [&](double z, double end, double outward) {
        const dvec3 g = spline_gradient(field, eye + z * u);
        const double level = outward * (sample(field, eye + z * u, true) - end) / glm::length(g);
        if (std::isfinite(end)) keep_outer(found, outline_at(view, u, z, level, outward * glm::normalize(g)));
    };
    for (double a = low; a < high; a += kStep) {
        const auto z = turn(a, a + kStep);
        const auto holds = [&](const RayPart& part) { return z >= part.first && z <= part.last; };
        if (!z || std::ranges::none_of(parts, holds)) continue;
        const int m = bodies.material(sample(field, eye + *z * u, true));
        if (bodies.drawn[static_cast<std::size_t>(m)]) continue;
        const bool rises = slope(a) > 0;
        keep(*z, rises ? bodies.upper(m) : bodies.lower(m), rises ? -1 : 1);
    }
    if (pieces.empty() || !pieces[0].entered) return found;
    const double begin = pieces[0].begin, farthest = std::sqrt(static_cast<double>(shader::OUTLINE_FAR2));
    for (double a = begin; a < begin + farthest; a += kStep)
        if (const auto z = turn(a, a + kStep)) {
            keep(*z, sample(field, eye + begin * u, true), slope(begin) > 0 ? -1 : 1);
            break;
        }
    return found;
}

geometry::Plane plane_of(const dvec3& n, double away) {
    return {n, std::isfinite(away) ? away : geometry::NO_PLANE};
}

/// A surface splat in a picture.
struct DrawnSplat {
    const SplatRecord* record = nullptr;
    dvec3 x{0};
    bool traced = false, creased = false;
    double reach = kReach;
    geometry::SurfaceSplat face;
    int sheet = 0;
    PixelBox box;
};

/// Its face without the error in D2, which is no wall's thickness.
VoxelEdge outlined_face(const DrawnSplat& s) {
    VoxelEdge face = s.record->edge;
    face.D2 = std::numeric_limits<double>::infinity();
    if (!s.creased) face.crease = face.corner = {};
    return face;
}

double longest_voxel(const VolumeGeometry& geometry) {
    const dvec3 spacing = geometry.spacing();
    return std::max({spacing.x, spacing.y, spacing.z});
}

/// Change of the depth, mm, with the position in index space.
dvec3 depth_slope(const View& view) {
    return glm::transpose(view.geometry.index_to_world_axes) * view.frame.forward;
}

/// `before`: how far in front of their sheets splats vote, voxels.
DrawnSplat drawn_splat(const SplatRecord& record, const Field& field, const View& view, double thickness,
                       double before) {
    const VoxelEdge& edge = record.edge;
    DrawnSplat s;
    s.record = &record;
    s.x = dvec3(field.voxel(record.voxel));
    const double depth = std::max(view.depth(s.x), view.mm_per_voxel_along);
    const double pixels = longest_voxel(view.geometry) * view.height / (2 * view.frame.tan_half_y * depth);
    s.traced = edge.traced && edge.D2 * pixels > static_cast<double>(shader::SURFACE_SHOWS);
    s.creased = !s.traced && edge.crease.D < kCreaseReach;
    const dvec3 foot = edge.D * edge.n;
    geometry::FaceGeometry at;
    at.take(edge);
    s.face = {at.face_form.value, at.face_form.slope, at.face_form.h, foot, kReach};
    const dvec3 center = s.x + (s.traced || s.creased ? dvec3(0) : foot);
    const double crease = s.creased ? static_cast<double>(shader::SURFACE_CREASE) : 0;
    s.reach = s.traced && !(edge.D2 < static_cast<double>(shader::SURFACE_LOST))
                  ? static_cast<double>(shader::SURFACE_AROUND)
                  : kReach;
    s.box = screen_box(view, {center, s.reach + crease});
    const double further = std::max(s.reach + crease - before, 0.0) * glm::length(depth_slope(view));
    s.sheet = static_cast<int>(std::max(std::floor((view.depth(center) - further) / thickness), 0.0));
    return s;
}

/// The vote of a splat on the ray with direction u, after `front` is counted; `ahead`: distance from the eye to its
/// point p, nearest to the voxel.
geometry::SurfaceVote vote_on(const geometry::SurfaceVotes& front, const DrawnSplat& s, std::span<const Piece> ray,
                              const dvec3& p, const dvec3& u, double ahead) {
    const VoxelEdge& edge = s.record->edge;
    if (!s.traced) {
        geometry::SurfaceVote vote =
            s.creased ? geometry::vote_of_planes(plane_of(edge.n, edge.D), plane_of(edge.crease.n, edge.crease.D),
                                                 plane_of(edge.corner.n, edge.corner.D), kReach, p, u)
                      : geometry::vote_of(s.face, p, u);
        if (edge.upper) vote.n = -vote.n;
        return vote;
    }
    const double half_chord = std::sqrt(std::max(s.reach * s.reach - glm::dot(p, p), 0.0));
    const double low = std::max(ahead - half_chord, 0.0), high = ahead + half_chord;
    // Rays are not traced further than this in matter.
    for (const Piece& piece : ray)
        if (const double deep = piece.begin + static_cast<double>(shader::SURFACE_DEEP);
            half_chord > 0 && piece.entered && piece.end > deep && deep < low)
            return geometry::vote_of_deep(piece.begin, piece.n, ahead, geometry::is_seen_before(front, piece.begin));
    double enters = kNowhere, chord = 0;
    dvec3 n(0);
    bool matter = false;
    for (const Piece& piece : ray) {
        matter = matter || std::min(piece.end, high) > std::max(piece.begin, low);
        if (!(piece.entered && piece.begin > low && piece.begin < enters)) continue;
        enters = piece.begin;
        n = piece.n;
    }
    // Matter soon behind counts, too.
    for (const Piece& piece : ray)
        if (piece.begin >= enters)
            chord +=
                std::max(std::min(piece.end, enters + static_cast<double>(shader::SURFACE_CHORD)) - piece.begin, 0.0);
    return geometry::vote_of_traced(low, high, enters, chord, matter, n, s.reach, p, u, ahead);
}

/// Material and light of what a ray sees.
struct Seen {
    dvec3 color{0};
    std::size_t material = 0;
    double distance = 0;  ///< of the splat's voxel from its face, negative in matter
    Reach reach{};
};

dvec3 payload_at(const geometry::SurfaceVotes& votes, const Seen& seen, const Scene& scene, const View& view,
                 const dvec3& u, Payload payload) {
    const dvec3 at = view.eye_index + std::max(geometry::way_to(votes), 1e-4) * u;
    const dvec3 outward = glm::transpose(glm::inverse(view.geometry.index_to_world_axes)) * votes.normal;
    const double length = glm::length(outward);
    const dvec3 normal = length > 0 ? outward / length : dvec3(0);
    switch (payload) {
        case Payload::Color:
            return shade(scene,
                         {.color = seen.color,
                          .response = scene.materials[seen.material].response,
                          .normal = normal,
                          .position = view.geometry.to_world(at),
                          .depth = view.depth(at)},
                         view.frame.eye, seen.reach);
        case Payload::Depth:
            return {view.depth(at), 0, 0};
        case Payload::Distance:
            return {seen.distance, 0, 0};
        case Payload::Normal:
            break;
    }
    return normal;
}

/// Whether a place lies in a side of the rim, beyond which matter of another volume continues.
bool is_at_rim(std::span<const IndexPlane> sides, const dvec3& at) {
    return std::ranges::any_of(sides, [&](const IndexPlane& side) {
        return std::abs(side.distance(at)) < static_cast<double>(shader::RIM_WIDTH);
    });
}

/// The inner sides of the rim.
std::vector<IndexPlane> inner_sides(const Rim& rim, const VolumeGeometry& geometry) {
    Clip sides;
    for (const RimSide& side : rim.sides)
        if (side.inner) sides.keep.push_back(side.plane);
    return index_clip(sides, geometry).keep;
}

/// Matter that begins where the ray enters a part, certainly.
geometry::SurfacePair begun(const Field& field, const SurfaceScene& surfaces, std::span<const IndexPlane> rim,
                            std::span<const RayPart> parts, const dvec3& eye, const dvec3& u) {
    const ScaledScene& materials = surfaces.materials;
    geometry::SurfacePair pair = geometry::no_surfaces();
    for (const RayPart& part : parts) {
        const dvec3 at = eye + part.first * u;
        const double value = sample(field, at, true);
        const int material = materials.material(value);
        const bool matter = materials.drawn[static_cast<std::size_t>(material)] &&
                            field.has_data(field.offset(field.clamped(ivec3(glm::round(at)))));
        if (pair.front.hits > 0 || !matter) continue;
        // An eye in matter sees nothing else.
        dvec3 n = part.n == dvec3(0) ? -u : part.n;
        const ScaledScene& bodies = surfaces.bodies;
        const int body = bodies.material(value);
        const dvec3 gradient = spline_gradient(field, at);
        if (part.n != dvec3(0) && is_at_rim(rim, at)) {
            // This volume's surface continues that of another volume, so the ray does not see a cut.
            const double up = bodies.upper(body) - value, down = value - bodies.lower(body);
            const dvec3 outwards = up < down ? gradient : -gradient;
            const bool near = std::min(up, down) < static_cast<double>(shader::SURFACE_STEP) * glm::length(gradient);
            if (near && glm::dot(outwards, u) < 0) n = outwards;
        }
        double chord = geometry::chord_in_body(value, glm::dot(gradient, u), bodies.lower(body), bodies.upper(body));
        if (chord < static_cast<double>(shader::SURFACE_CHORD)) {
            // Matter soon behind counts, too.
            constexpr auto kStep = static_cast<double>(shader::SURFACE_PROBE);
            chord = std::min(chord, kStep);
            for (int k = 1; k < shader::SURFACE_PROBES; ++k) {
                const double further = sample(field, at + (k + 0.5) * kStep * u, true);
                chord += bodies.drawn[static_cast<std::size_t>(bodies.material(further))] ? kStep : 0;
            }
        }
        geometry::begin_matter(pair.front, part.first, std::min(chord, part.last - part.first), glm::normalize(n),
                               shader::BEGUN_MATTER + static_cast<std::uint32_t>(material));
    }
    return pair;
}

}  // namespace

SurfaceScene::SurfaceScene(const Scene& whole, const Volume& volume)
    : scene(scene_of_bodies(whole)), bodies(scale_scene(scene, volume)), materials(scale_scene(whole, volume)) {}

VoxelEdge fit_surface(const Field& field, const ScaledScene& scene, const std::vector<VoxelEdge>& surfels,
                      const ivec3& i, int m, double noise) {
    geometry::FieldGeometry at(field, scene, surfels, noise);
    return geometry::FieldGeometry::voxel_edge(at.fit_surface(i, static_cast<std::uint32_t>(m)));
}

std::vector<SplatRecord> surface_splats(const Field& field, const SurfaceScene& surfaces,
                                        const std::vector<VoxelEdge>& surfels, double noise, bool quantised) {
    const ScaledScene& bodies = surfaces.bodies;
    std::vector<SplatRecord> records;
    geometry::FieldGeometry samples(field, bodies);
    for (std::size_t at = 0; at < field.values.size(); ++at) {
        const glm::ivec3 i = field.voxel(at);
        const std::uint32_t m = samples.material_at(i);
        if (field.has_data(at) && bodies.drawn[m] && samples.ends_beside(i, field.at(i), m))
            records.push_back({static_cast<std::uint32_t>(at), m, {}});
    }
    parallel_for(static_cast<int>(records.size()), [&](int begin, int end) {
        for (int k = begin; k < end; ++k) {
            SplatRecord& record = records[static_cast<std::size_t>(k)];
            record.edge = fit_surface(field, bodies, surfels, field.voxel(record.voxel),
                                      static_cast<int>(record.material), noise);
            if (quantised) record.edge = quantise(record.edge);
            const double own = field.at(field.voxel(record.voxel));
            record.material = static_cast<std::uint32_t>(surfaces.materials.material(own));
        }
    });
    return records;
}

SurfacePicture draw_surfaces(std::span<const SplatRecord> records, const Field& field, const SurfaceScene& surfaces,
                             const Scene& scene, const View& view, const Settings& settings, Payload payload) {
    const IndexClip clip = index_clip(scene.effects.clip, view.geometry);
    const std::vector<IndexPlane> rim = inner_sides(scene.rim, view.geometry);
    const double thickness = sheet_thickness(view, settings);
    std::vector<DrawnSplat> splats;
    splats.reserve(records.size());
    const bool creases =
        std::ranges::any_of(records, [](const SplatRecord& record) { return record.edge.crease.D < kCreaseReach; });
    const double before = kReach + (creases ? static_cast<double>(shader::SURFACE_CREASE) : 0);
    for (const SplatRecord& record : records)
        splats.push_back(drawn_splat(record, field, view, thickness, before));
    const double solid = solid_chord(scene, view.geometry);
    std::vector<std::uint32_t> order(splats.size());
    std::iota(order.begin(), order.end(), 0U);
    std::ranges::stable_sort(order, {}, [&](std::uint32_t i) { return splats[i].sheet; });
    const dvec3 view_z = depth_slope(view);
    const double reach = before * glm::length(view_z);
    const std::vector<std::size_t> shadowing = shadow_lights(scene);
    const bool smooth = payload == Payload::Color && smooths_outlines(settings, scene);
    geometry::FieldGeometry samples(field, surfaces.materials);
    const auto seen_by = [&](const geometry::SurfaceVotes& votes, const dvec3& at) {
        Seen seen;
        if (votes.number < shader::BEGUN_MATTER) {
            const SplatRecord& record = records[votes.number];
            seen = {{}, record.material, -record.edge.D, {}};
        } else {
            seen.material = votes.number - shader::BEGUN_MATTER;
        }
        const std::uint32_t label = surfaces.materials.labels ? samples.seen_label(at, seen.material) : 0;
        seen.color = label > 0 ? scene.label_colors[label - 1] : scene.materials[seen.material].color;
        seen.reach.ambient = geometry::arrives_at(votes);
        for (std::size_t k = 0; k < shadowing.size(); ++k)
            seen.reach.lights[shadowing[k]] = geometry::lights_at(votes)[static_cast<int>(k)];
        return seen;
    };
    SurfacePicture picture;
    picture.pixels.resize(static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height));
    picture.outlines.resize(smooth ? picture.pixels.size() : 0);
    parallel_for(view.height, [&](int begin, int end) {
        struct Pixel {
            geometry::SurfacePair pair = geometry::no_surfaces();
            std::vector<RayPart> parts;
            bool closed = false;
            std::optional<std::vector<Piece>> pieces;
            std::optional<Outline> outline;
        };
        const auto width = static_cast<std::size_t>(view.width);
        std::vector<Pixel> pixels(width * static_cast<std::size_t>(end - begin));
        for (int y = begin; y < end; ++y)
            for (int x = 0; x < view.width; ++x) {
                Pixel& pixel = pixels[static_cast<std::size_t>(y - begin) * width + static_cast<std::size_t>(x)];
                const dvec3 u = view.ray(x, y);
                pixel.parts = ray_parts(field, clip, view.eye_index, u);
                pixel.pair = begun(field, surfaces, rim, pixel.parts, view.eye_index, u);
                pixel.closed =
                    !pixel.parts.empty() && geometry::begins_and_hides(pixel.pair.front, pixel.parts[0].first, solid);
            }
        for (const std::uint32_t number : order) {
            const DrawnSplat& s = splats[number];
            for (int y = std::max(s.box.y0, begin); y < std::min(s.box.y1, end); ++y)
                for (int x = s.box.x0; x < s.box.x1; ++x) {
                    Pixel& pixel = pixels[static_cast<std::size_t>(y - begin) * width + static_cast<std::size_t>(x)];
                    if (pixel.closed) continue;
                    const dvec3 u = view.ray(x, y), from_eye = s.x - view.eye_index;
                    const double sheet = (thickness * s.sheet - reach) / glm::dot(view_z, u);
                    pixel.closed = geometry::is_decided(pixel.pair, sheet, solid);
                    if (pixel.closed) continue;
                    if (s.traced && !pixel.pieces)
                        pixel.pieces = pieces_of(field, surfaces.bodies, pixel.parts, view.eye_index, u);
                    const double ahead = glm::dot(from_eye, u);
                    const dvec3 p = ahead * u - from_eye;
                    geometry::SurfaceVote vote =
                        vote_on(pixel.pair.front, s, pixel.pieces.value_or(std::vector<Piece>{}), p, u, ahead);
                    double way = ahead + vote.z;
                    for (const RayPart& part : pixel.parts) {
                        // A face enters the matter just before the part, within its error.
                        const double early = part.first - way;
                        if (!vote.enters || part.n == dvec3(0) || early <= 0 ||
                            early >= static_cast<double>(shader::SURFACE_EARLY) ||
                            early * std::abs(glm::dot(vote.n, u)) >= kSide * glm::length(vote.n))
                            continue;
                        way = part.first;
                        vote.n = part.n;
                    }
                    const auto holds = [&](const RayPart& part) {
                        return way >= part.first - 1e-3 && way <= part.last;
                    };
                    const auto part = std::ranges::find_if(pixel.parts, holds);
                    if (part == pixel.parts.end())
                        vote.weight = 0;
                    else
                        vote.chord = std::min(vote.chord, part->last - way);
                    const bool hidden =
                        geometry::wins(pixel.pair.front) &&
                        way > geometry::way_to(pixel.pair.front) + static_cast<double>(shader::SURFACE_WINDOW);
                    if (smooth && vote.weight > 0 && !hidden) {
                        const double half = std::sqrt(std::max(s.reach * s.reach - glm::dot(p, p), 0.0));
                        keep_outer(pixel.outline,
                                   s.traced ? searched_outline(field, surfaces.bodies, pixel.parts, *pixel.pieces, view,
                                                               u, ahead - half, ahead + half)
                                            : outline_of(outlined_face(s), view, p, u, ahead, 1));
                    }
                    glm::dvec2 lights(1);
                    for (std::size_t k = 0; k < shadowing.size(); ++k)
                        lights[static_cast<int>(k)] = s.record->reach.lights[shadowing[k]];
                    geometry::count_vote(pixel.pair, vote, way, {number, s.record->reach.ambient, lights});
                }
        }
        for (int y = begin; y < end; ++y)
            for (int x = 0; x < view.width; ++x) {
                Pixel& pixel = pixels[static_cast<std::size_t>(y - begin) * width + static_cast<std::size_t>(x)];
                for (int k = 0; k < 2; ++k)
                    if (!geometry::wins(pixel.pair.front)) geometry::refuse_front(pixel.pair);
                const dvec3 u = view.ray(x, y);
                const std::size_t at = static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x);
                std::size_t kept = 0;
                for (const geometry::SurfaceVotes& votes : {pixel.pair.front, pixel.pair.behind}) {
                    if (!geometry::wins(votes)) continue;
                    const Seen seen = seen_by(votes, view.eye_index + geometry::way_to(votes) * u);
                    const double chord = geometry::mean_chord(votes);
                    const double depth = chord < 0.999 * static_cast<double>(shader::SURFACE_CHORD)
                                             ? scene.materials[seen.material].extinction * chord *
                                                   glm::length(view.geometry.index_to_world_axes * u)
                                             : kNowhere;
                    picture.pixels[at][kept++] = {
                        (1 - std::exp(-depth)) * glm::dvec4(payload_at(votes, seen, scene, view, u, payload), 1),
                        geometry::way_to(votes), chord >= solid};
                }
                if (smooth) picture.outlines[at] = pixel.outline;
            }
    });
    return picture;
}

std::vector<glm::dvec4> composited(const SurfacePicture& picture) {
    std::vector<glm::dvec4> frame;
    frame.reserve(picture.pixels.size());
    for (const auto& [front, behind] : picture.pixels)
        frame.push_back(front.value + (1 - front.value.w) * behind.value);
    return frame;
}

}  // namespace edgesplat::reference
