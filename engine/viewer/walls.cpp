#include "engine/viewer/walls.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/error.h"
#include "engine/viewer/walls_internal.h"
#include "engine/volume/grid.h"
#include "engine/volume/packed_volume.h"
#include "engine/volume/sample_source.h"

namespace edgesplat::viewer {
namespace {

/// Diagonals of a cell within which the surface itself is searched. Further away, the distance to its crossings with
/// edges of the grid is at most a tenth of a diagonal too large.
constexpr double kNear = 1.25;

std::shared_ptr<const Volume> limited_resolution(std::shared_ptr<const Volume> volume) {
    if (!volume) fail("walls: no volume");
    if (volume->packed) {
        const int level = finest_level_within(*volume->packed, Walls::kMaxVoxelsPacked);
        return std::make_shared<const Volume>(load_level(*volume, level));
    }
    const glm::ivec3 dims = volume->geometry.dims;
    if (glm::any(glm::lessThan(dims, glm::ivec3(1))) || volume->values.size() != volume->geometry.voxel_count())
        fail("walls: {}: {} samples for {} x {} x {} voxels", volume->name, volume->values.size(), dims.x, dims.y,
             dims.z);
    while (volume->geometry.voxel_count() > Walls::kMaxVoxelsInMemory)
        volume = std::make_shared<const Volume>(halved(*volume));
    return volume;
}

/// The volume with samples that are not solid where it has no data, if its smallest value is solid; `values` changes to
/// match.
std::shared_ptr<const Volume> without_missing(std::shared_ptr<const Volume> volume, SolidValues& values) {
    const auto low = static_cast<double>(volume->min_value), high = static_cast<double>(volume->max_value);
    if (!volume->no_data || !values.solid(low)) return volume;
    const double range = high > low ? high - low : 1;
    const double below = (values.flips.empty() ? low : std::min(low, values.flips.front())) - range;
    if (values.solid_below) {
        values.flips.insert(values.flips.begin(), below + range / 2);
        values.solid_below = false;
    }
    auto changed = std::make_shared<Volume>(*volume);
    for (std::size_t i = 0; i < changed->values.size(); ++i)
        if (!changed->has_data(i)) changed->values[i] = static_cast<float>(below);
    return changed;
}

Clip with_unit_normals(Clip clip) {
    for (auto* planes : {&clip.keep, &clip.remove})
        for (Plane& plane : *planes)
            plane.normal = unit(plane.normal);
    return clip;
}

}  // namespace

struct Walls::Matter {
    std::shared_ptr<const Volume> volume;
    SolidValues values;
    VolumeGeometry geometry;
    CellField field;
    std::vector<float> distances;  ///< signed, mm, at the voxels' centres
    std::vector<bool> crossed;
    glm::dvec3 thickness{1};  ///< mm between neighbouring planes of voxels
    double voxel = 1, diagonal = 1;
    bool any = false, all = false;

    Matter(const std::shared_ptr<const Volume>& given, const Scene& scene)
        : volume(limited_resolution(given)),
          values(solid_values(scene, given->geometry.mean_spacing())),
          geometry(volume->geometry),
          field(*(volume = without_missing(volume, values))) {
        const glm::dmat3 rows = glm::transpose(field.to_index);
        for (int axis = 0; axis < 3; ++axis)
            thickness[axis] = 1 / glm::length(rows[axis]);
        voxel = shortest_spacing(geometry);
        diagonal = glm::length(geometry.spacing());
        distances = distances_to_crossings(*volume, values);
        crossed = crossed_cells(*volume, values);
        all = true;
        for (std::size_t i = 0; i < distances.size(); ++i) {
            const bool inside = values.solid(static_cast<double>(volume->values[i]));
            if (inside) distances[i] = -distances[i];
            any |= inside || std::isfinite(distances[i]);
            all &= inside && !std::isfinite(distances[i]);
        }
    }

    double at(const glm::ivec3& i) const { return static_cast<double>(distances[voxel_offset(geometry.dims, i)]); }

    glm::dvec3 to_index(const glm::dvec3& world) const { return field.to_index * (world - geometry.origin); }

    /// Signed distance to matter that the outermost samples continue without end; `index` in the box of the volume.
    double distance(const glm::dvec3& index) const {
        if (all) return -std::numeric_limits<double>::infinity();
        const glm::dvec3 last(geometry.dims - 1), inner = glm::clamp(index, glm::dvec3(0), last);
        const glm::ivec3 cell = glm::max(glm::min(glm::ivec3(inner), geometry.dims - 2), glm::ivec3(0));
        double mean = 0, radius = std::numeric_limits<double>::infinity();
        for (int k = 0; k < 8; ++k) {
            const glm::ivec3 step{k & 1, (k >> 1) & 1, (k >> 2) & 1}, i = glm::min(cell + step, geometry.dims - 1);
            const glm::dvec3 t = inner - glm::dvec3(cell), w = glm::mix(1.0 - t, t, glm::dvec3(step));
            const double d = at(i);
            mean += w.x * w.y * w.z * d;
            const glm::dvec3 to_node = geometry.index_to_world_axes * (index - glm::dvec3(i));
            radius = std::min(radius, glm::length(to_node) + std::abs(d));
        }
        if (std::abs(mean) > kNear * diagonal) return mean;
        const auto nearest = nearest_on_surface(field, values, crossed, index, radius * (1 + 1e-9));
        const double size = nearest ? glm::length(*nearest - geometry.index_to_world_axes * index) : std::abs(mean);
        return values.solid(field.value(index)) ? -size : size;
    }
};

Walls::Walls(const std::shared_ptr<const Volume>& volume, const Scene& scene) {
    validate(scene);
    matter_ = std::make_shared<const Matter>(volume, scene);
    clip_ = with_unit_normals(scene.effects.clip);
}

Walls::Walls(const Walls& walls, const Clip& clip) : matter_(walls.matter_), clip_(with_unit_normals(clip)) {}

/// Signed distance, mm, to the part that the clip planes keep: above 0 outside it.
double Walls::cut(const glm::dvec3& world) const {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    double beyond = -infinity;
    double within = beyond;
    for (const Plane& plane : clip_.keep)
        beyond = std::max(beyond, glm::dot(plane.normal, world - plane.point));
    for (const Plane& plane : clip_.remove)
        within = std::max(within, glm::dot(plane.normal, world - plane.point));
    return clip_.remove.empty() ? beyond : std::max(beyond, -within);
}

bool Walls::solid(const glm::dvec3& world) const {
    const glm::dvec3 index = matter_->to_index(world);
    const bool in_box = glm::all(glm::greaterThanEqual(index, glm::dvec3(-0.5))) &&
                        glm::all(glm::lessThanEqual(index, glm::dvec3(matter_->geometry.dims) - 0.5));
    return in_box && !(cut(world) > 0) && matter_->values.solid(matter_->field.value(index));
}

double Walls::distance(const glm::dvec3& world) const {
    const Matter& m = *matter_;
    if (!m.any) return std::numeric_limits<double>::infinity();
    const glm::dvec3 index = m.to_index(world), first(-0.5), last = glm::dvec3(m.geometry.dims) - 0.5;
    const glm::dvec3 inside = glm::clamp(index, first, last);
    const double outside = glm::length(m.geometry.index_to_world_axes * (index - inside));
    double d = m.distance(inside);
    if (outside > 0) {
        // The box is convex: all matter lies behind the plane through its nearest point, perpendicular to the way
        // there.
        d = d > 0 ? std::hypot(outside, d) : outside;
    } else {
        const glm::dvec3 to_side = glm::min(index - first, last - index) * m.thickness;
        d = std::max(d, -std::min({to_side.x, to_side.y, to_side.z}));
    }
    return std::max(d, cut(world));
}

glm::dvec3 Walls::away(const glm::dvec3& world) const {
    const glm::dvec3 any(0, 0, 1);
    if (!matter_->any) return any;
    const double h = voxel() / 2;
    glm::dvec3 g(0);
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 step(0);
        step[axis] = h;
        g[axis] = distance(world + step) - distance(world - step);
    }
    if (glm::length(g) > 0.1 * h) return glm::normalize(g);
    // Between walls: the direction with the largest distance.
    glm::dvec3 best = any;
    double most = -std::numeric_limits<double>::infinity();
    for (int k = 0; k < 27; ++k) {
        const glm::dvec3 way(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
        if (k == 13) continue;
        const double d = distance(world + glm::normalize(way) * (2 * h));
        if (d > most) best = glm::normalize(way);
        most = std::max(most, d);
    }
    return best;
}

double Walls::free_distance(const glm::dvec3& world, const glm::dvec3& direction, double limit) const {
    if (!matter_->any || !(limit > 0)) return std::max(limit, 0.0);
    const glm::dvec3 way = unit(direction);
    const VolumeGeometry& g = matter_->geometry;
    // Beyond this length every ray has left the volume.
    const double end = glm::length(world - g.center()) + glm::length(g.index_to_world_axes * glm::dvec3(g.dims));
    const double shortest = 0.1 * voxel();
    double t = 0, d = distance(world), before = 0;
    if (d <= 0) return 0;
    while (d > 0) {
        before = t;
        t += std::max(0.8 * d, shortest);
        if (t >= std::min(limit, end)) return limit;
        d = distance(world + t * way);
    }
    for (int i = 0; i < 40; ++i) {
        const double middle = (before + t) / 2;
        (distance(world + middle * way) > 0 ? before : t) = middle;
    }
    return before;
}

double Walls::voxel() const {
    return matter_->voxel;
}

bool Walls::any() const {
    return matter_->any;
}

glm::ivec3 Walls::dims() const {
    return matter_->geometry.dims;
}

const VolumeGeometry& Walls::geometry() const {
    return matter_->geometry;
}

double Walls::distance_at(const glm::ivec3& voxel) const {
    return std::max(matter_->at(voxel), cut(matter_->geometry.to_world(glm::dvec3(voxel))));
}

}  // namespace edgesplat::viewer
