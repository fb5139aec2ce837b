// The rendering methods.
#pragma once

#include <array>
#include <string_view>

namespace edgesplat {

/// Splatting; ray casting of the interpolated field; the exact sum of all kernels (reference); the exact surfaces of a
/// builtin volume (truth).
enum class RendererKind { Splat, Raycast, Reference, Truth };

inline constexpr std::array<std::string_view, 4> kRendererNames{"splat", "raycast", "reference", "truth"};

/// The ray caster's interpolation between samples: trilinear, or the cubic B-spline through them.
enum class RaycastFilter { Trilinear, Cubic };

inline constexpr std::array<std::string_view, 2> kRaycastFilterNames{"trilinear", "cubic"};

/// Whether the method runs on the processor and needs no Vulkan device.
constexpr bool on_processor(RendererKind kind) {
    return kind == RendererKind::Reference || kind == RendererKind::Truth;
}

constexpr std::string_view name_of(RendererKind kind) {
    return kRendererNames[static_cast<std::size_t>(kind)];
}

}  // namespace edgesplat
