// Which way to the picture.
#pragma once

#include <array>
#include <string_view>

namespace edgesplat {

/// Splatting; rays cast through the field between the samples; the sum of all kernels itself; a builtin volume's exact
/// surfaces.
enum class RendererKind { Splat, Raycast, Reference, Truth };

inline constexpr std::array<std::string_view, 4> kRendererNames{"splat", "raycast", "reference", "truth"};

/// What the ray caster takes the field between the voxels for: trilinear interpolation, or the cubic B-spline through
/// the samples.
enum class RaycastFilter { Trilinear, Cubic };

inline constexpr std::array<std::string_view, 2> kRaycastFilterNames{"trilinear", "cubic"};

/// Whether it computes on the processor alone and needs no Vulkan device.
constexpr bool on_processor(RendererKind kind) {
    return kind == RendererKind::Reference || kind == RendererKind::Truth;
}

constexpr std::string_view name_of(RendererKind kind) {
    return kRendererNames[static_cast<std::size_t>(kind)];
}

}  // namespace edgesplat
