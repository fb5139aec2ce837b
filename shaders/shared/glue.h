// Makes a header readable by C++ and GLSL. Structs use scalar layout, so glm's vec3 and GLSL's have the same bytes.
#ifndef EDGESPLAT_GLUE_H
#define EDGESPLAT_GLUE_H

#ifdef __cplusplus
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
namespace edgesplat::shader {
using uint = std::uint32_t;
using glm::ivec2;
using glm::ivec3;
using glm::ivec4;
using glm::mat3;
using glm::uvec2;
using glm::vec2;
using glm::vec3;
using glm::vec4;
/// Device address of a buffer in two words; GLSL's uvec2 that converts to a buffer reference.
struct Address {
    uint low = 0, high = 0;
    Address() = default;
    Address(std::uint64_t address) : low(static_cast<uint>(address)), high(static_cast<uint>(address >> 32)) {}
};
#define EDGESPLAT_CONSTANT constexpr
#define EDGESPLAT_SHARED_BEGIN namespace edgesplat::shader {
#define EDGESPLAT_SHARED_END }
}  // namespace edgesplat::shader
#else
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#define Address uvec2
#define EDGESPLAT_CONSTANT const
#define EDGESPLAT_SHARED_BEGIN
#define EDGESPLAT_SHARED_END
#endif

#endif
