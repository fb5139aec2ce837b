// The files of this folder in double precision.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "shaders/shared/limits.h"

namespace edgesplat::geometry {

using Real = double;
using uint = std::uint32_t;
using vec3 = glm::dvec3;
using ivec3 = glm::ivec3;
using vec2 = glm::dvec2;
using mat3 = glm::dmat3;
using Bending = glm::dmat3;
using glm::abs;
using glm::acos;
using glm::ceil;
using glm::clamp;
using glm::cos;
using glm::cross;
using glm::dot;
using glm::length;
using glm::max;
using glm::min;
using glm::normalize;
using glm::sign;
using glm::sin;
using glm::sqrt;

constexpr Real SHADOW_STEP = static_cast<Real>(shader::SHADOW_STEP);
constexpr Real SURFACE_CERTAIN = static_cast<Real>(shader::SURFACE_CERTAIN);
using shader::BEGUN_MATTER;
constexpr Real SURFACE_CHORD = static_cast<Real>(shader::SURFACE_CHORD);
constexpr Real SURFACE_ERROR = static_cast<Real>(shader::SURFACE_ERROR);
constexpr Real SURFACE_NOISE = static_cast<Real>(shader::SURFACE_NOISE);
constexpr Real SURFACE_RIPPLE = static_cast<Real>(shader::SURFACE_RIPPLE);
constexpr Real SURFACE_RING = static_cast<Real>(shader::SURFACE_RING);
constexpr Real SURFACE_SMOOTH = static_cast<Real>(shader::SURFACE_SMOOTH);
constexpr Real SURFACE_SURE = static_cast<Real>(shader::SURFACE_SURE);
constexpr Real SURFACE_TURN = static_cast<Real>(shader::SURFACE_TURN);
constexpr Real SURFACE_WINDOW = static_cast<Real>(shader::SURFACE_WINDOW);

inline vec3 bent(const Bending& h, const vec3& v) {
    return h * v;
}

// Functions of the files are not inline, since GLSL has no such word: each source file has its own.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
namespace {  // NOLINT(google-build-namespaces)
#define INOUT(type) type&
#include "engine/geometry/light_ray.glsl"
#include "engine/geometry/surface_votes.glsl"
// After what it uses.
#include "engine/geometry/surface_check.glsl"
#undef INOUT
}  // namespace
#pragma GCC diagnostic pop

}  // namespace edgesplat::geometry
