#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/scene/transfer_function.h"
#include "engine/viewer/walls_internal.h"
#include "engine/volume/grid.h"

namespace edgesplat::viewer {
namespace {

/// Kuhn's six tetrahedra of a cell around its diagonal 0-7; their faces match between neighbouring cells.
constexpr int kTetrahedra[6][4] = {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}};

glm::ivec3 corner(int k) {
    return {k & 1, (k >> 1) & 1, (k >> 2) & 1};
}

/// Closest point of a triangle to the origin (Ericson 2005, 5.1.5); a degenerate triangle counts as its edges.
glm::dvec3 closest_to_origin(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    const glm::dvec3 ab = b - a, ac = c - a;
    const double d1 = -glm::dot(ab, a), d2 = -glm::dot(ac, a);
    if (d1 <= 0 && d2 <= 0) return a;
    const double d3 = -glm::dot(ab, b), d4 = -glm::dot(ac, b);
    if (d3 >= 0 && d4 <= d3) return b;
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return d1 - d3 > 0 ? a + ab * (d1 / (d1 - d3)) : a;
    const double d5 = -glm::dot(ab, c), d6 = -glm::dot(ac, c);
    if (d6 >= 0 && d5 <= d6) return c;
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return d2 - d6 > 0 ? a + ac * (d2 / (d2 - d6)) : a;
    const double va = d3 * d6 - d5 * d4;
    const double e1 = d4 - d3, e2 = d5 - d6;
    if (va <= 0 && e1 >= 0 && e2 >= 0) return e1 + e2 > 0 ? b + (c - b) * (e1 / (e1 + e2)) : b;
    const double sum = va + vb + vc;
    return sum > 0 ? a + ab * (vb / sum) + ac * (vc / sum) : a;
}

/// Keeps the point nearest to the origin of all triangles added to it.
struct Nearest {
    double square;
    glm::dvec3 point{0};
    double flip = 0;
    bool found = false;

    void triangle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, double at_flip) {
        const glm::dvec3 p = closest_to_origin(a, b, c);
        const double s = glm::dot(p, p);
        if (s > square) return;
        square = s;
        point = p;
        flip = at_flip;
        found = true;
    }
};

/// Adds the surface value = flip of a cell, linear in each tetrahedron. `places`: of the corners.
void add_cell(const std::array<double, 8>& values, const std::array<glm::dvec3, 8>& places, double flip,
              Nearest& nearest) {
    for (const auto& tetrahedron : kTetrahedra) {
        std::array<std::size_t, 4> low{}, high{};
        std::size_t lows = 0, highs = 0;
        for (const int k : tetrahedron) {
            const auto at = static_cast<std::size_t>(k);
            if (values[at] < flip)
                low[lows++] = at;
            else
                high[highs++] = at;
        }
        if (lows == 0 || highs == 0) continue;
        const auto between = [&](std::size_t a, std::size_t b) {
            return glm::mix(places[a], places[b], (flip - values[a]) / (values[b] - values[a]));
        };
        if (lows == 2) {
            const glm::dvec3 p = between(low[0], high[0]), q = between(low[1], high[1]);
            nearest.triangle(p, between(low[0], high[1]), q, flip);
            nearest.triangle(p, between(low[1], high[0]), q, flip);
        } else {
            const auto& single = lows == 1 ? low : high;
            const auto& others = lows == 1 ? high : low;
            nearest.triangle(between(single[0], others[0]), between(single[0], others[1]),
                             between(single[0], others[2]), flip);
        }
    }
}

}  // namespace

SolidValues solid_values(const Scene& scene, double voxel) {
    const double limit = std::log(2.0) / voxel;
    SolidValues out;
    bool solid = false;
    const auto next = [&](double from, bool is_solid) {
        if (is_solid != solid) out.flips.push_back(from);
        solid = is_solid;
    };
    if (scene.transfer.empty()) {
        out.solid_below = solid = scene.materials[0].extinction >= limit;
        for (std::size_t m = 1; m < scene.materials.size(); ++m)
            next(scene.iso_values[m - 1], scene.materials[m].extinction >= limit);
        return out;
    }
    out.solid_below = solid = scene.transfer.front().extinction >= limit;
    for (std::size_t i = 0; i + 1 < scene.transfer.size(); ++i) {
        const TransferPoint &a = scene.transfer[i], &b = scene.transfer[i + 1];
        const bool ends_solid = b.extinction >= limit;
        if (ends_solid == solid) continue;
        const double t = (limit - a.extinction) / (b.extinction - a.extinction);
        next(std::lerp(a.value, b.value, std::clamp(t, 0.0, 1.0)), ends_solid);
    }
    return out;
}

double CellField::sample(const glm::ivec3& i) const {
    const glm::ivec3 c = glm::clamp(i, glm::ivec3(0), volume.geometry.dims - 1);
    return static_cast<double>(volume.at(c.x, c.y, c.z));
}

std::array<double, 8> CellField::corners(const glm::ivec3& cell) const {
    std::array<double, 8> v{};
    for (int k = 0; k < 8; ++k)
        v[static_cast<std::size_t>(k)] = sample(cell + corner(k));
    return v;
}

double CellField::value(const glm::dvec3& index) const {
    const glm::ivec3 cell(glm::floor(index));
    const glm::dvec3 t = index - glm::dvec3(cell);
    const std::array<double, 8> v = corners(cell);
    const auto x = [&](std::size_t k) { return std::lerp(v[k], v[k + 1], t.x); };
    return std::lerp(std::lerp(x(0), x(2), t.y), std::lerp(x(4), x(6), t.y), t.z);
}

glm::dvec3 CellField::gradient(const glm::dvec3& index) const {
    const glm::ivec3 cell(glm::floor(index));
    const glm::dvec3 t = index - glm::dvec3(cell), s = 1.0 - t;
    const std::array<double, 8> v = corners(cell);
    const glm::dvec3 g{
        (v[1] - v[0]) * s.y * s.z + (v[3] - v[2]) * t.y * s.z + (v[5] - v[4]) * s.y * t.z + (v[7] - v[6]) * t.y * t.z,
        (v[2] - v[0]) * s.x * s.z + (v[3] - v[1]) * t.x * s.z + (v[6] - v[4]) * s.x * t.z + (v[7] - v[5]) * t.x * t.z,
        (v[4] - v[0]) * s.x * s.y + (v[5] - v[1]) * t.x * s.y + (v[6] - v[2]) * s.x * t.y + (v[7] - v[3]) * t.x * t.y};
    return glm::transpose(to_index) * g;
}

std::vector<bool> crossed_cells(const Volume& volume, const SolidValues& values) {
    const glm::ivec3 dims = volume.geometry.dims;
    const std::size_t row = static_cast<std::size_t>(dims.x), slice = row * static_cast<std::size_t>(dims.y);
    std::vector<int> ids(volume.values.size());
    std::transform(volume.values.begin(), volume.values.end(), ids.begin(),
                   [&](float v) { return values.interval(static_cast<double>(v)); });
    std::vector<bool> crossed(volume.values.size());
    for (int z = 0; z + 1 < dims.z; ++z)
        for (int y = 0; y + 1 < dims.y; ++y)
            for (int x = 0; x + 1 < dims.x; ++x) {
                const std::size_t at = static_cast<std::size_t>(z) * slice + static_cast<std::size_t>(y) * row +
                                       static_cast<std::size_t>(x);
                const int* p = &ids[at];
                const int id = p[0];
                crossed[at] = p[1] != id || p[row] != id || p[row + 1] != id || p[slice] != id || p[slice + 1] != id ||
                              p[slice + row] != id || p[slice + row + 1] != id;
            }
    return crossed;
}

std::optional<glm::dvec3> nearest_on_surface(const CellField& field, const SolidValues& values,
                                             const std::vector<bool>& crossed, const glm::dvec3& index, double radius) {
    const VolumeGeometry& geometry = field.volume.geometry;
    const glm::ivec3 dims = geometry.dims;
    const glm::dmat3 rows = glm::transpose(field.to_index);
    // Cells beyond the border repeat the outermost samples; one layer of them suffices.
    const glm::dvec3 reach = radius * glm::dvec3(glm::length(rows[0]), glm::length(rows[1]), glm::length(rows[2]));
    const glm::ivec3 low = glm::max(glm::ivec3(glm::floor(index - reach)), glm::ivec3(-1));
    const glm::ivec3 high = glm::min(glm::ivec3(glm::floor(index + reach)), dims - 1);
    const glm::dvec3 thickness = 1.0 / glm::dvec3(glm::length(rows[0]), glm::length(rows[1]), glm::length(rows[2]));
    const glm::dmat3& axes = geometry.index_to_world_axes;
    const double skew = std::abs(glm::dot(axes[0], axes[1])) + std::abs(glm::dot(axes[1], axes[2])) +
                        std::abs(glm::dot(axes[2], axes[0]));
    const bool orthogonal = skew < 1e-6 * glm::dot(thickness, thickness);
    Nearest nearest{radius * radius};
    glm::ivec3 c;
    for (c.z = low.z; c.z <= high.z; ++c.z)
        for (c.y = low.y; c.y <= high.y; ++c.y)
            for (c.x = low.x; c.x <= high.x; ++c.x) {
                const bool inner =
                    glm::all(glm::greaterThanEqual(c, glm::ivec3(0))) && glm::all(glm::lessThan(c, dims - 1));
                if (inner && !crossed[voxel_offset(dims, c)]) continue;
                const glm::dvec3 gap =
                    glm::max(glm::max(glm::dvec3(c) - index, index - glm::dvec3(c + 1)), glm::dvec3(0)) * thickness;
                // If the axes are not orthogonal, only the largest gap is a lower bound.
                const double widest = std::max({gap.x, gap.y, gap.z});
                if ((orthogonal ? glm::dot(gap, gap) : widest * widest) > nearest.square) continue;
                const std::array<double, 8> v = field.corners(c);
                const auto [least, most] = std::minmax_element(v.begin(), v.end());
                const int first = values.interval(*least), last = values.interval(*most);
                if (first == last) continue;
                std::array<glm::dvec3, 8> places;
                for (int k = 0; k < 8; ++k)
                    places[static_cast<std::size_t>(k)] =
                        geometry.index_to_world_axes * (glm::dvec3(c + corner(k)) - index);
                for (int flip = first; flip < last; ++flip)
                    add_cell(v, places, values.flips[static_cast<std::size_t>(flip)], nearest);
            }
    if (!nearest.found) return std::nullopt;
    // Correct from the tetrahedra's surface to that of the trilinear field.
    const glm::dvec3 at = index + field.to_index * nearest.point, slope = field.gradient(at);
    const double steep = glm::dot(slope, slope);
    glm::dvec3 point = nearest.point;
    if (steep > 0) {
        const glm::dvec3 correction = slope * ((nearest.flip - field.value(at)) / steep);
        const double length = glm::length(correction);
        const double most = std::min({thickness.x, thickness.y, thickness.z}) / 2;
        if (length <= most) point += correction;
    }
    return geometry.index_to_world_axes * index + point;
}

}  // namespace edgesplat::viewer
