// A device with validation, small scenes, and the passes' results converted to the reference's types.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "engine/gpu/read_back.h"
#include "engine/reference/1_estimate_edges.h"
#include "engine/reference/2_collect_splats.h"
#include "engine/reference/5_draw_splats.h"
#include "engine/scene/transfer_function.h"
#include "engine/volume/analytic_volumes.h"
#include "engine/volume/filters.h"
#include "tests/passes/device_under_test.h"

namespace edgesplat::test {

template <typename T>
std::vector<T> download(DeviceUnderTest& state, const gpu::Buffer& buffer, std::size_t count) {
    return gpu::read_back<T>(state.device(), state.commands(), buffer, 0, count);
}

template <typename T>
std::vector<T> download(DeviceUnderTest& state, const gpu::GpuImage& image) {
    const auto& shape = image.shape();
    const glm::uvec3 size(shape.size);
    const auto layers = static_cast<std::uint32_t>(shape.layers);
    const std::size_t count = std::size_t{size.x} * size.y * size.z * layers;
    const gpu::Buffer host(state.device(), count * sizeof(T), gpu::Buffer::Place::Host, "readback");
    const vk::BufferImageCopy copy(0, 0, 0, {image.aspect(), 0, 0, layers}, {}, {size.x, size.y, size.z});
    state.commands().run([&] { state.commands().copy(image, host, copy); });
    const auto mapped = host.mapped<T>(count);
    return {mapped.begin(), mapped.end()};
}

/// Decodes a voxel's edge from its two stored words (shaders/shared/scene_params.h).
inline reference::VoxelEdge decode_edge(std::uint32_t normal, std::uint32_t code) {
    reference::VoxelEdge edge;
    const std::uint32_t state = code >> 26U & 3U;
    edge.has_normal = state != shader::EDGE_NONE;
    edge.has_edge = state >= shader::EDGE_LOWER;
    edge.upper = state == shader::EDGE_UPPER;
    const auto snorm = [](std::uint32_t bits) {
        return std::max(static_cast<std::int16_t>(bits & 0xffffU) / 32767.0, -1.0);
    };
    glm::dvec3 n(snorm(normal), snorm(normal >> 16U), 0);
    n.z = 1 - std::abs(n.x) - std::abs(n.y);
    const double fold = std::max(-n.z, 0.0);
    n.x += n.x >= 0 ? -fold : fold;
    n.y += n.y >= 0 ? -fold : fold;
    if (edge.has_normal) edge.n = glm::normalize(n);
    if (edge.has_edge) edge.D = snorm(code) * static_cast<double>(shader::EDGE_DISTANCE_UNIT);
    const std::uint32_t d2 = code >> 16U & 1023U;
    if (edge.has_edge && d2 != shader::FACE_NONE)
        edge.D2 = d2 / 1022.0 * static_cast<double>(shader::FACE_DISTANCE_UNIT);
    return edge;
}

/// Whether a device's edge equals the reference's. D is stored in steps of 1.2e-4; float32 sampling and normalisation
/// add less than 1e-3 voxel.
inline bool same_edge(const reference::VoxelEdge& got, const reference::VoxelEdge& want) {
    constexpr double kDistanceBound = 2e-3;
    constexpr double kNormalBound = 2e-3;
    bool same = got.has_edge == want.has_edge && got.has_normal == want.has_normal;
    if (same && want.has_normal) same = glm::length(got.n - want.n) <= kNormalBound;
    if (same && want.has_edge) {
        same = std::abs(got.D - want.D) <= kDistanceBound && got.upper == want.upper;
        const bool far = got.D2 > 3.9 && want.D2 > 3.9;
        same = same && (far || std::abs(got.D2 - want.D2) <= 0.01);
    }
    return same;
}

/// One scene for the passes on the device.
struct PassScene {
    std::string name;
    Volume volume;
    Scene scene;
    Camera camera;
    Settings settings;

    reference::ScaledScene scaled() const { return reference::scale_scene(scene, volume); }
};

inline void look_at(PassScene& s, const glm::dvec3& eye, const glm::dvec3& target, double fov) {
    s.camera.eye = s.volume.geometry.to_world(eye);
    s.camera.direction = s.volume.geometry.to_world(target) - s.camera.eye;
    s.camera.up = {0.1, 0.05, 1};
    s.camera.fov_y = fov;
}

/// Drawn by kernels, also where surface splats would draw them; tests/passes/surfaces_test.cpp draws those.
/// An opaque torus; an orbital with two materials, one translucent, on an oblique left-handed anisotropic grid; a wall.
inline std::vector<PassScene> pass_scenes() {
    std::vector<PassScene> scenes(3);
    auto& torus = scenes[0];
    torus.name = "torus";
    torus.volume = sample(torus_scene({28, 26, 20}, {13.3, 12.6, 9.4}, 7.2, 3.6));
    torus.scene.iso_values = {0.5};
    torus.scene.materials = {{{0, 0, 0}, 0}, {{1, 0.85, 0.75}, 4}};
    look_at(torus, {13, -14, 24}, {13, 12, 9}, 40);

    auto& orbital = scenes[1];
    orbital.name = "oblique orbital";
    orbital.volume = sample(resized(analytic_scene("orbital"), {22, 20, 24}));
    auto& geometry = orbital.volume.geometry;
    geometry.index_to_world_axes =
        glm::dmat3(glm::dvec3(0.9, 0.2, 0.1), glm::dvec3(0.2, -1.1, 0.15), glm::dvec3(0.1, 0.3, 1.7));
    geometry.origin = {-40, 12, 7};
    const double top = static_cast<double>(orbital.volume.max_value);
    orbital.scene.iso_values = {0.08 * top, 0.4 * top};
    orbital.scene.materials = {{{0, 0, 0}, 0}, {{0.3, 0.5, 1}, 0.15}, {{1, 0.8, 0.3}, 3}};
    orbital.scene.lights = {directional_light({0.3, -1, 0.5})};
    look_at(orbital, {40, -18, 12}, {10, 10, 12}, 35);

    auto& wall = scenes[2];
    wall.name = "wall from inside";
    wall.volume = sample(slab_scene({24, 24, 24}, {0.3, 1, 0.2}, {11.5, 13, 11.5}, 1.6));
    wall.scene.iso_values = {0.5};
    wall.scene.materials = {{{0, 0, 0}, 0}, {{1, 1, 1}, 2}};
    look_at(wall, {11, 8, 11}, {13, 13, 12}, 70);
    for (PassScene& scene : scenes)
        scene.settings.opaque = OpaqueMatter::Kernels;
    return scenes;
}

/// The edge field of pass 1. The bits of D2 are ignored: they contain the neighbouring materials.
inline std::vector<reference::VoxelEdge> device_field(DeviceUnderTest& state) {
    std::vector<reference::VoxelEdge> edges;
    for (const auto& words : download<glm::uvec2>(state, state.lists().edges)) {
        edges.push_back(decode_edge(words.x, words.y | shader::FACE_NONE << 16U));
        edges.back().border = (words.y & shader::EDGE_BORDER) != 0;
    }
    return edges;
}

/// Returns the device with the scene's volume; passes 1 and 2 have run.
inline DeviceUnderTest& prepared(const PassScene& s) {
    DeviceUnderTest& state = device_under_test();
    state.drawer.set_culling({.bricks = false});  // a splat's number is its slot's
    state.level = LevelStore(state.session);
    state.level.volume.hold(std::make_shared<Volume>(s.volume), 0);
    state.collect(s.scene, s.settings);
    return state;
}

/// Decodes a face's second derivatives from their two stored words (shaders/footprints/face_record.glsl).
inline glm::dmat3 decode_bending(const glm::uvec2& code) {
    const auto part = [](std::uint32_t word, int k) {
        const int bits = static_cast<int>(word << (22 - 10 * k)) >> 22;
        const double root = bits / 511.0;
        return root * std::abs(root) * static_cast<double>(shader::BENDING_UNIT);
    };
    const double xx = part(code.x, 0), yy = part(code.x, 1), zz = part(code.x, 2);
    const double yz = part(code.y, 0), xz = part(code.y, 1), xy = part(code.y, 2);
    return {glm::dvec3(xx, xy, xz), glm::dvec3(xy, yy, yz), glm::dvec3(xz, yz, zz)};
}

/// The device's splat list in the reference's format, with second derivatives and classification if the device has
/// them.
inline std::vector<reference::SplatRecord> device_records(DeviceUnderTest& state) {
    std::vector<reference::SplatRecord> records;
    for (const auto& splat : download<shader::Splat>(state, state.lists().splats, state.lists().splat_count)) {
        records.push_back({splat.voxel, splat.edge >> 28U, decode_edge(splat.normal, splat.edge)});
    }
    if (state.lists().values) {
        std::vector<TransferPoint> points;
        for (const shader::TransferRow& row : state.level.splats.collected()->transfer) {
            const glm::dvec4 matter(row.matter);
            if (row.value < 3e38F) points.push_back({static_cast<double>(row.value), glm::dvec3(matter), matter.a});
        }
        const auto values = download<float>(state, state.lists().values, records.size());
        for (std::size_t i = 0; i < records.size(); ++i)
            records[i].classified = transfer_at(points, static_cast<double>(values[i]));
    }
    if (!state.lists().traits) return records;
    const auto traits = download<glm::uvec2>(state, state.lists().traits, records.size());
    for (std::size_t i = 0; i < records.size(); ++i) {
        reference::VoxelEdge& edge = records[i].edge;
        if (traits[i].x >> 31U != 0) {
            const auto plane = decode_edge(traits[i].y, (traits[i].x & 0xffffU) | shader::EDGE_LOWER << 26U);
            edge.crease = {plane.n, plane.D};
            const std::uint32_t third = traits[i].x >> 16U & 8191U;
            const bool turned = (traits[i].x >> 29U & 1U) != 0;
            if (third != 8191U) edge.corner = reference::square_to(edge.n, plane.n, third / 8190.0 * 4, turned);
            continue;
        }
        edge.bending = decode_bending(traits[i]);
        edge.mixed = (traits[i].x >> 30U & 1U) != 0;
        edge.traced = (traits[i].y >> 30U & 1U) != 0;
    }
    return records;
}

/// Sorts records like the device: brick by brick.
inline void sort_by_brick(std::vector<reference::SplatRecord>& records, const glm::ivec3& dims) {
    std::ranges::stable_sort(records, {}, [&](const reference::SplatRecord& record) {
        const auto voxel = static_cast<int>(record.voxel);
        const glm::ivec3 brick = glm::ivec3(voxel % dims.x, voxel / dims.x % dims.y, voxel / dims.x / dims.y) / 8;
        return std::tuple(brick.z, brick.y, brick.x);
    });
}

/// The share of the light that reaches each splat: two unorm16.
struct Reaches {
    std::vector<reference::SplatRecord> records;
    std::vector<double> first, second;
};

inline Reaches reaches_of(const PassScene& s, gpu::Buffer SplatLists::*buffer) {
    DeviceUnderTest& state = prepared(s);
    Reaches out{device_records(state), {}, {}};
    for (const std::uint32_t word : download<std::uint32_t>(state, state.lists().*buffer, out.records.size())) {
        out.first.push_back((word & 0xffffU) / 65535.0);
        out.second.push_back((word >> 16U) / 65535.0);
    }
    return out;
}

/// The settings with sheets in layers, which tests can read.
inline Settings layered(Settings settings) {
    settings.sheet_format = SheetFormat::Layers;
    return settings;
}

/// The sheets of a picture's last group: all sheets if there is only one group.
struct DrawnSheets {
    std::vector<reference::SplatRecord> records;
    std::vector<glm::vec4> pixels;  ///< (sheet, y, x)
    glm::ivec4 rect;                ///< pixels that the group touches; other pixels are undefined
};

inline DrawnSheets drawn_sheets(DeviceUnderTest& state, const PassScene& s, const glm::ivec2& size) {
    state.draw(s.scene, s.camera, layered(s.settings), size, shader::PAYLOAD_COLOR);
    return {device_records(state), download<glm::vec4>(state, state.targets().sheets),
            state.targets().groups.mapped<shader::SheetGroup>(1)[0].rect};
}

/// Adds to the records how the scene draws them: translucent or opaque.
inline std::vector<reference::SplatRecord> drawn_records(const PassScene& s,
                                                         std::vector<reference::SplatRecord> records) {
    const reference::ScaledScene scaled = s.scaled();
    for (reference::SplatRecord& record : records) {
        const auto material = static_cast<int>(record.material);
        const bool through = scaled.is_translucent[record.material] && draws_faces(s.settings);
        if (through) record.edge.deepest = 0;
        const reference::Field field{s.volume.geometry.dims, {}, {}};
        record.weight = reference::border_weight(field, scaled, s.settings, field.voxel(record.voxel), material);
    }
    return records;
}

/// The reference's passes 3 and 5 on the device's splat list. Not copyable: members refer to one another.
struct Oracle {
    Oracle(const PassScene& s, const std::vector<reference::SplatRecord>& listed, const glm::ivec2& size)
        : values(scaled_field(s.volume)),
          coefficients(bspline_coefficients(values, s.volume.geometry.dims)),
          field{s.volume.geometry.dims, values, coefficients},
          records(drawn_records(s, listed)),
          view(s.camera, s.volume.geometry, size.x, size.y),
          footprints(s.settings, table_depth(s.scene, s.volume.geometry),
                     has_single_piece(s.settings, s.scene, s.volume.geometry) ? FacePieces::Longer : FacePieces::Both),
          selected(reference::select_footprints(records, field, view, s.settings, footprints,
                                                reference::sheets_of(records, field, view, s.settings, footprints))),
          drawer(records, selected, field, s.scene, view, s.settings, footprints) {}
    Oracle(const Oracle&) = delete;
    Oracle& operator=(const Oracle&) = delete;

    std::vector<float> values, coefficients;
    reference::Field field;
    std::vector<reference::SplatRecord> records;
    reference::View view;
    reference::Footprints footprints;
    std::vector<reference::Selected> selected;
    reference::SplatDrawer drawer;
};

}  // namespace edgesplat::test
