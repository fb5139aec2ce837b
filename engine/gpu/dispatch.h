// Compute passes as data: a frame records them, its description lists them.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <variant>
#include <vector>

#include "engine/gpu/pipelines.h"

namespace edgesplat::gpu {

/// Sizes of a dispatch. Workgroups follow from the shader's own local size. A long line is folded into rows along y,
/// where the shader numbers it by shaders/common/groups.glsl.
struct Invocations {
    std::uint64_t count = 0;  ///< along a line
};
struct Workgroups {
    std::uint64_t count = 0;  ///< along a line
};
struct Grid {
    glm::uvec3 invocations{1};  ///< along each axis
};
/// As many workgroups as the shader counts with itself, at most 65535 along x.
struct Columns {
    std::uint32_t workgroups = 1;
};
inline Invocations per_pixel(const glm::ivec2& size) {
    return {static_cast<std::uint64_t>(size.x) * static_cast<std::uint64_t>(size.y)};
}
using DispatchSize = std::variant<Invocations, Workgroups, Grid, Columns>;

/// A dispatch of a compute shader; a barrier follows.
struct Dispatch {
    const char* shader;
    Specialization constants;
    DispatchSize size;
    std::uint32_t number = 0;  ///< the push constant
};

/// A pass: its name, and its dispatches in order. Without dispatches it does not run.
struct Pass {
    const char* name;  ///< a span of device time, e.g. "3_select_footprints"
    std::vector<Dispatch> dispatches;
};

}  // namespace edgesplat::gpu
