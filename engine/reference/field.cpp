#include "engine/reference/field.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/scene/transfer_function.h"
#include "engine/volume/filters.h"
#include "engine/volume/grid.h"

namespace edgesplat::reference {

namespace {

/// Value of the spline, or with `along` its derivative along that axis. Beyond the outermost samples it is linear,
/// without products of the axes' ways beyond.
double spline(const Field& field, const glm::dvec3& p, int along = -1) {
    const glm::dvec3 q = glm::clamp(p, glm::dvec3(0), glm::dvec3(field.dims - 1));
    std::array<SplineTaps, 3> taps;
    std::array<std::array<double, 4>, 3> beyond{};
    for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        taps[a] = spline_taps(q[axis], field.dims[axis]);
        if (axis == along)
            taps[a].weights = taps[a].slopes;
        else
            for (std::size_t k = 0; k < 4; ++k)
                beyond[a][k] = (p[axis] - q[axis]) * taps[a].slopes[k];
    }
    double sum = 0;
    for (std::size_t z = 0; z < 4; ++z) {
        for (std::size_t y = 0; y < 4; ++y) {
            for (std::size_t x = 0; x < 4; ++x) {
                const glm::ivec3 i{taps[0].places[x], taps[1].places[y], taps[2].places[z]};
                const double wx = taps[0].weights[x], wy = taps[1].weights[y], wz = taps[2].weights[z];
                const double more = beyond[0][x] * wy * wz + wx * beyond[1][y] * wz + wx * wy * beyond[2][z];
                sum += (wx * wy * wz + more) * static_cast<double>(field.coefficients[field.offset(i)]);
            }
        }
    }
    return sum;
}

}  // namespace

std::size_t Field::offset(const glm::ivec3& i) const {
    return voxel_offset(dims, i);
}

glm::ivec3 Field::voxel(std::size_t at) const {
    const auto nx = static_cast<std::size_t>(dims.x);
    const auto ny = static_cast<std::size_t>(dims.y);
    return {static_cast<int>(at % nx), static_cast<int>(at / nx % ny), static_cast<int>(at / (nx * ny))};
}

int ScaledScene::material(double f) const {
    return static_cast<int>(std::count_if(iso.begin(), iso.end(), [f](double j) { return j <= f; }));
}

double ScaledScene::lower(int m) const {
    return m == 0 ? -std::numeric_limits<double>::infinity() : iso[static_cast<std::size_t>(m) - 1];
}

double ScaledScene::upper(int m) const {
    return static_cast<std::size_t>(m) == iso.size() ? std::numeric_limits<double>::infinity()
                                                     : iso[static_cast<std::size_t>(m)];
}

ScaledScene scale_scene(const Scene& scene, const Volume& volume) {
    ScaledScene scaled;
    for (const double iso : scene.iso_values)
        scaled.iso.push_back(static_cast<double>(static_cast<float>(scaled_iso_value(volume, iso))));
    for (std::size_t m = 0; m < scene.materials.size(); ++m)
        scaled.drawn.push_back(extinctions_of(scene, m).most > 0);
    const std::uint32_t translucent_mask = translucent_materials(scene, volume.geometry);
    for (std::size_t m = 0; m < scene.materials.size(); ++m)
        scaled.is_translucent.push_back((translucent_mask >> m & 1U) != 0);
    scaled.transfer = scaled_transfer(scene, volume);
    if (!scene.label_colors.empty()) scaled.labels = volume.shown_labels.get();
    scaled.two_values = volume.two_values;
    scaled.light = !scene.lights.empty() || scene.effects.silhouette;
    return scaled;
}

double sample(const Field& field, const glm::dvec3& p, bool cubic) {
    if (cubic) return spline(field, p);
    const glm::dvec3 q = glm::clamp(p, glm::dvec3(0), glm::dvec3(field.dims - 1));
    const glm::ivec3 cell = glm::max(glm::min(glm::ivec3(glm::floor(q)), field.dims - 2), glm::ivec3(0));
    const glm::dvec3 t = q - glm::dvec3(cell);
    const auto row = [&](int y, int z) {
        const double a = field.at(cell + glm::ivec3(0, y, z));
        return a + t.x * (field.at(cell + glm::ivec3(1, y, z)) - a);
    };
    const auto slice = [&](int z) {
        const double a = row(0, z);
        return a + t.y * (row(1, z) - a);
    };
    const double a = slice(0);
    return a + t.z * (slice(1) - a);
}

glm::dvec3 spline_gradient(const Field& field, const glm::dvec3& p) {
    return {spline(field, p, 0), spline(field, p, 1), spline(field, p, 2)};
}

glm::dvec3 voxel_gradient(const Field& field, const glm::ivec3& i) {
    glm::dvec3 g(0);
    for (int axis = 0; axis < 3; ++axis) {
        glm::ivec3 before = i;
        glm::ivec3 after = i;
        before[axis] = std::max(i[axis] - 1, 0);
        after[axis] = std::min(i[axis] + 1, field.dims[axis] - 1);
        const int span = after[axis] - before[axis];
        if (span > 0) g[axis] = (field.at(after) - field.at(before)) / span;
    }
    return g;
}

glm::dvec3 field_gradient(const Field& field, const glm::ivec3& i) {
    return field.coefficients.empty() ? voxel_gradient(field, i) : spline_gradient(field, glm::dvec3(i));
}

glm::dvec3 point_gradient(const Field& field, const glm::dvec3& p, bool cubic) {
    // Differences along the three axes alone turn the normal of a blurred edge by up to 5 degrees, because each of them
    // flattens the edge's profile by a different amount. The 14 directions of a Lebedev rule flatten it evenly.
    constexpr double kFace = 1.0 / 15;
    constexpr double kCorner = 3.0 / 40;
    const double diagonal = 1 / std::sqrt(3.0);
    // One voxel inside the border, so that no sample of the sphere is lost.
    const glm::dvec3 last(field.dims - 1);
    const glm::dvec3 centre = glm::clamp(p, glm::min(glm::dvec3(1), last / 2.0), glm::max(last - 1.0, last / 2.0));
    glm::dvec3 g(0);
    const auto add = [&](const glm::dvec3& e, double weight) {
        g += 3 * weight * (sample(field, centre + e, cubic) - sample(field, centre - e, cubic)) * e;
    };
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 e(0);
        e[axis] = 1;
        add(e, kFace);
    }
    for (int corner = 0; corner < 4; ++corner) {
        add(diagonal * glm::dvec3((corner & 1) != 0 ? -1 : 1, (corner & 2) != 0 ? -1 : 1, 1), kCorner);
    }
    return g;
}

}  // namespace edgesplat::reference
