// Access to the SPIR-V that is compiled at build time and embedded (cmake/CompileShaders.cmake).
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string_view>

namespace edgesplat::gpu {

struct EmbeddedShader {
    std::string_view name;  ///< file name in shaders/, e.g. "3_select_footprints.comp"
    std::span<const std::uint32_t> words;
};

/// Every shader of the engine, by file name.
std::span<const EmbeddedShader> embedded_shaders();

/// The SPIR-V of a shader. Throws std::logic_error for a name that was not compiled in.
std::span<const std::uint32_t> find_shader(std::string_view name);

/// Invocations of a compute shader's workgroup along each axis. Throws std::logic_error if constants set them.
glm::uvec3 local_size(std::string_view name);

}  // namespace edgesplat::gpu
