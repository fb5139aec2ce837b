#include "tests/stability/hazard.h"

#include <algorithm>
#include <cmath>

#include "engine/reference/reference_renderer.h"
#include "engine/volume/filters.h"
#include "tests/passes/pass_fixture.h"

namespace edgesplat::test {

VolumePointer volume_of(const glm::ivec3& dims, const std::function<float(const glm::ivec3&)>& value,
                        const glm::dmat3& axes) {
    // Doubles represent every float, also NaN and infinities.
    return sampled(
        dims, [&](const glm::dvec3& at) { return static_cast<double>(value(glm::ivec3(at))); }, axes);
}

VolumePointer changed(const VolumePointer& volume, const std::function<float(float, const glm::ivec3&)>& change) {
    return volume_of(
        volume->geometry.dims,
        [&](const glm::ivec3& voxel) { return change(volume->at(voxel.x, voxel.y, voxel.z), voxel); },
        volume->geometry.index_to_world_axes);
}

Shot shot_of(VolumePointer volume, double iso_value, double extinction) {
    Shot shot;
    shot.volume = std::move(volume);
    shot.scene = two_tone(0, extinction);
    shot.scene.iso_values = {iso_value};
    const VolumeGeometry& g = shot.volume->geometry;
    const glm::dvec3 step = g.spacing();
    const double largest = glm::length(step * glm::dvec3(g.dims));
    shot.camera.direction = glm::normalize(glm::dvec3(0.93, 0.31, -0.2));
    shot.camera.eye = g.center() - 2.0 * largest * shot.camera.direction;
    shot.camera.fov_y = 30;
    shot.width = shot.height = 32;
    return shot;
}

const reference::VoxelEdge& Estimate::at(const glm::ivec3& voxel) const {
    const glm::ivec3 v = glm::clamp(voxel, glm::ivec3(0), dims - 1);
    return device[static_cast<std::size_t>((v.z * dims.y + v.y) * dims.x + v.x)];
}

std::size_t Estimate::edges() const {
    return static_cast<std::size_t>(
        std::ranges::count_if(device, [](const reference::VoxelEdge& edge) { return edge.has_edge && !edge.border; }));
}

double Estimate::differing() const {
    std::size_t known = 0, differ = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
        known += expected[i].has_edge ? 1U : 0U;
        differ += same_edge(device[i], expected[i]) || off_surface[i] <= 5e-3 ? 0U : 1U;
    }
    return static_cast<double>(differ) / static_cast<double>(std::max<std::size_t>(known, 1));
}

namespace {

/// Distance (voxels) and angle (radians) of an estimated point to the surface, the larger of both; 1e9 without an edge.
double off_surface_of(const reference::Field& field, const reference::ScaledScene& scene, std::size_t i,
                      const reference::VoxelEdge& edge, bool cubic) {
    if (!edge.has_edge || edge.border) return 1e9;
    const int m = scene.material(static_cast<double>(field.values[i]));
    const double iso = edge.upper ? scene.upper(m) : scene.lower(m);
    const glm::dvec3 at = glm::dvec3(field.voxel(i)) + edge.D * edge.n;
    const glm::dvec3 g = cubic ? reference::spline_gradient(field, at) : reference::point_gradient(field, at);
    const double slope = glm::length(g);
    if (!(slope > 0)) return 1e9;
    const double askew = glm::length(edge.n - (edge.upper ? 1.0 : -1.0) * g / slope);
    return std::max(std::abs(reference::sample(field, at, cubic) - iso) / slope, askew);
}

}  // namespace

Estimate estimate(const VolumePointer& volume, const std::vector<double>& iso_values, EdgeEstimator estimator) {
    PassScene s;
    s.volume = *volume;
    s.scene.iso_values = iso_values;
    s.scene.materials.assign(iso_values.size() + 1, Material{});
    for (std::size_t m = 0; m < s.scene.materials.size(); ++m)
        s.scene.materials[m].extinction = static_cast<double>(m + 1);  // visible, so that their edges are estimated
    s.settings.edges = estimator;
    s.settings.cull_buried = false;
    DeviceUnderTest& state = prepared(s);
    Estimate result;
    result.dims = volume->geometry.dims;
    result.off_surface.assign(volume->values.size(), 1e9);
    const std::vector<float> values = scaled_field(s.volume);
    std::vector<float> coefficients;
    if (estimator == EdgeEstimator::Cubic) coefficients = bspline_coefficients(values, result.dims);
    const reference::Field field{result.dims, values, coefficients};
    result.expected = reference::estimate_edges(field, s.scaled(), s.settings, true);
    result.lowest = static_cast<double>(*std::ranges::min_element(values));
    result.highest = static_cast<double>(*std::ranges::max_element(values));
    if (!state.lists().edges) {
        result.device.resize(values.size());
        return result;
    }
    result.device = device_field(state);
    const bool cubic = estimator == EdgeEstimator::Cubic;
    for (std::size_t i = 0; i < values.size(); ++i)
        result.off_surface[i] = off_surface_of(field, s.scaled(), i, result.device[i], cubic);
    return result;
}

RenderResult sound(const Shot& shot, const std::string& what) {
    RenderResult result = render(shot, {true, true, true, true});
    const double far = 1e30;
    const auto bound = static_cast<float>(far);
    EXPECT_TRUE(within(result.color, 0, 1.0001F)) << what << ": colour";
    EXPECT_TRUE(shows_its_matter(result.color, *result.tau)) << what << ": the picture is empty";
    EXPECT_TRUE(within(*result.tau, 0, bound)) << what << ": tau";
    EXPECT_TRUE(within(*result.depth, -bound, bound)) << what << ": depth";
    EXPECT_TRUE(within(*result.distance, -4, 4)) << what << ": distance";
    for (std::size_t i = 0; i + 2 < result.normal->pixels.size(); i += 3) {
        const auto& n = result.normal->pixels;
        const double length =
            std::hypot(static_cast<double>(n[i]), static_cast<double>(n[i + 1]), static_cast<double>(n[i + 2]));
        const bool unit_or_none = std::abs(length - 1) < 1e-3 || length == 0;
        EXPECT_TRUE(unit_or_none) << what << ": a normal of length " << length;
        if (!unit_or_none) break;
    }
    return result;
}

ImageDifference against_reference(const Shot& shot, const std::string& what) {
    const RenderResult device = sound(shot, what);
    reference::PreparedVolume drawn(*shot.volume, shot.scene, shot.settings, true);
    if (draws_faces(shot.settings)) {
        // Where surfaces meet, touch or end, rounding decides a voxel's face. The reference draws the device's faces.
        PassScene s;
        s.volume = *shot.volume;
        s.scene = shot.scene;
        s.settings = shot.settings;
        // An eye in the matter sees kernels even where surface splats draw the scene from outside.
        for (const OpaqueMatter opaque : {OpaqueMatter::Kernels, shot.settings.opaque}) {
            s.settings.opaque = opaque;
            DeviceUnderTest& state = prepared(s);
            const bool surfaces = state.lists().surfaces;
            for (const reference::SplatRecord& record : drawn_records(s, device_records(state)))
                surfaces ? drawn.replace_surface(record.voxel, record.edge)
                         : drawn.replace_edge(record.voxel, static_cast<int>(record.material), record.edge);
        }
    }
    return compare_images(device.color, drawn.render(shot.camera, shot.width, shot.height));
}

void expect_as_reference(const Shot& shot, const std::string& what, double most_differing, double psnr) {
    for (const EdgeEstimator estimator : kEstimators) {
        const Estimate e = estimate(shot.volume, shot.scene.iso_values, estimator);
        EXPECT_LE(e.differing(), most_differing) << what << ", " << name_of(estimator) << ", " << e.edges() << " edges";
    }
    const ImageDifference difference = against_reference(shot, what);
    EXPECT_GE(difference.psnr, psnr) << what << ": largest " << difference.max << " at " << difference.x << ", "
                                     << difference.y;
}

Middle middle_of(const Image& image, int channel) {
    Middle middle{0, 1e300, -1e300};
    int count = 0;
    for (int y = image.height / 4; y < image.height - image.height / 4; ++y) {
        for (int x = image.width / 4; x < image.width - image.width / 4; ++x) {
            const auto v = static_cast<double>(image.at(x, y, channel));
            middle.mean += v;
            middle.least = std::min(middle.least, v);
            middle.most = std::max(middle.most, v);
            ++count;
        }
    }
    middle.mean /= count;
    return middle;
}

Middle thickness_along_x(Shot shot) {
    const VolumeGeometry& g = shot.volume->geometry;
    const glm::dvec3 middle = glm::dvec3(g.dims - 1) / 2.0;
    const double extent = std::max(std::min(g.dims.y, g.dims.z) / 2.0 - 1.6, 0.5);
    const double distance = 2e3;
    shot.camera =
        look(*shot.volume, middle - glm::dvec3(distance, 0, 0), middle, 2 * glm::degrees(std::atan(extent / distance)));
    shot.width = shot.height = 24;
    const double extinction = shot.scene.materials.back().extinction;
    Middle tau = middle_of(*sound(shot, "along x").tau, 0);
    tau.mean /= extinction;
    tau.least /= extinction;
    tau.most /= extinction;
    return tau;
}

}  // namespace edgesplat::test
