// The files of this folder in double precision.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "shaders/shared/limits.h"
#include "shaders/shared/scene_params.h"

namespace edgesplat::geometry {

using Real = double;
using uint = std::uint32_t;
using vec2 = glm::dvec2;
using vec3 = glm::dvec3;
using vec4 = glm::dvec4;
using ivec2 = glm::ivec2;
using ivec3 = glm::ivec3;
using mat3 = glm::dmat3;
// GLSL's functions.
using glm::abs;
using glm::acos;
using glm::all;
using glm::ceil;
using glm::clamp;
using glm::cos;
using glm::cross;
using glm::dot;
using glm::exp;
using glm::findLSB;
using glm::greaterThan;
using glm::greaterThanEqual;
using glm::inverse;
using glm::inversesqrt;
using glm::length;
using glm::lessThan;
using glm::lessThanEqual;
using glm::max;
using glm::min;
using glm::mix;
using glm::normalize;
using glm::outerProduct;
using glm::pow;
using glm::roundEven;
using glm::sign;
using glm::sin;
using glm::smoothstep;
using glm::sqrt;
using glm::transpose;

using shader::BEGUN_MATTER;
using shader::CREASE_STEPS;
using shader::EDGE_LOWER;
using shader::EDGE_NONE;
using shader::EDGE_NORMAL;
using shader::EDGE_UPPER;
using shader::FOOT_STEPS;
using shader::SURFEL_STEPS;
using shader::WALL_STEPS;

#define EDGESPLAT_IN_DOUBLE(name) constexpr Real name = static_cast<Real>(shader::name);
EDGESPLAT_IN_DOUBLE(BORDER_BEHIND)
EDGESPLAT_IN_DOUBLE(CARRIES_NOTHING)
EDGESPLAT_IN_DOUBLE(CORNER_SQUARE)
EDGESPLAT_IN_DOUBLE(CREASE_ALIKE)
EDGESPLAT_IN_DOUBLE(CREASE_BEHIND)
EDGESPLAT_IN_DOUBLE(CREASE_BLUNT)
EDGESPLAT_IN_DOUBLE(CREASE_BLUNT_LEFT)
EDGESPLAT_IN_DOUBLE(CREASE_RADIUS)
EDGESPLAT_IN_DOUBLE(CREASE_REACH)
EDGESPLAT_IN_DOUBLE(CREASE_ROUNDED)
EDGESPLAT_IN_DOUBLE(CREASE_ROUNDED_LEFT)
EDGESPLAT_IN_DOUBLE(CREASE_SPREAD)
EDGESPLAT_IN_DOUBLE(CREASE_TURNED)
EDGESPLAT_IN_DOUBLE(FACE_SEARCH)
EDGESPLAT_IN_DOUBLE(FIT_BADLY)
EDGESPLAT_IN_DOUBLE(FIT_OWN)
EDGESPLAT_IN_DOUBLE(FIT_RADIUS)
EDGESPLAT_IN_DOUBLE(FIT_RIDGE)
EDGESPLAT_IN_DOUBLE(FIT_THINNEST)
EDGESPLAT_IN_DOUBLE(FIT_WALL)
EDGESPLAT_IN_DOUBLE(FIT_WELL)
EDGESPLAT_IN_DOUBLE(GRADIENT_MIN)
EDGESPLAT_IN_DOUBLE(KERNEL_RADIUS)
EDGESPLAT_IN_DOUBLE(LABEL_VIEW)
EDGESPLAT_IN_DOUBLE(LIT_FACES)
EDGESPLAT_IN_DOUBLE(LIT_WITHIN)
EDGESPLAT_IN_DOUBLE(MADE_UP)
EDGESPLAT_IN_DOUBLE(OUTLINE_FAR2)
EDGESPLAT_IN_DOUBLE(OUTLINE_NEAR2)
EDGESPLAT_IN_DOUBLE(OUTLINE_TAU)
EDGESPLAT_IN_DOUBLE(SHADOW_STEP)
EDGESPLAT_IN_DOUBLE(STEEP_FROM)
EDGESPLAT_IN_DOUBLE(STEEP_OVER)
EDGESPLAT_IN_DOUBLE(SURFACE_CERTAIN)
EDGESPLAT_IN_DOUBLE(SURFACE_CHORD)
EDGESPLAT_IN_DOUBLE(SURFACE_ERROR)
EDGESPLAT_IN_DOUBLE(SURFACE_FIT)
EDGESPLAT_IN_DOUBLE(SURFACE_NOISE)
EDGESPLAT_IN_DOUBLE(SURFACE_REACH)
EDGESPLAT_IN_DOUBLE(SURFACE_RING)
EDGESPLAT_IN_DOUBLE(SURFACE_RIPPLE)
EDGESPLAT_IN_DOUBLE(SURFACE_SHEET)
EDGESPLAT_IN_DOUBLE(SURFACE_SIDE)
EDGESPLAT_IN_DOUBLE(SURFACE_SMOOTH)
EDGESPLAT_IN_DOUBLE(SURFACE_SURE)
EDGESPLAT_IN_DOUBLE(SURFACE_TURN)
EDGESPLAT_IN_DOUBLE(SURFACE_WINDOW)
EDGESPLAT_IN_DOUBLE(SURFEL_REACH)
EDGESPLAT_IN_DOUBLE(TURN_FROM)
EDGESPLAT_IN_DOUBLE(WALL_BENT)
EDGESPLAT_IN_DOUBLE(WALL_LEVEL)
EDGESPLAT_IN_DOUBLE(WALL_TILTED)
#undef EDGESPLAT_IN_DOUBLE

// Functions of the files are not inline, since GLSL has no such word: each source file has its own.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
namespace {  // NOLINT(google-build-namespaces)
#define INOUT(type) type&
#include "engine/geometry/bending.glsl"
// After what it uses.
#include "engine/geometry/edge.glsl"
#include "engine/geometry/light_ray.glsl"
#include "engine/geometry/low_pass.glsl"
#include "engine/geometry/outline_place.glsl"
#include "engine/geometry/quadric.glsl"
#include "engine/geometry/surface_votes.glsl"
// After what it uses.
#include "engine/geometry/surface_check.glsl"
#undef INOUT
}  // namespace
#pragma GCC diagnostic pop

}  // namespace edgesplat::geometry
