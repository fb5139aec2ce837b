// Runs shaders/lib/footprint.glsl as C++ and compares it with the double-precision functions it mirrors.
#include <gtest/gtest.h>

#include <cmath>

#include "footprints/footprint_table.h"
#include "shaders/shared/footprint_params.h"
#include "tests/unit/footprints_samples.h"

// What GLSL brings: float functions, a sampler with hardware filtering, the types it needs.
namespace glsl {

using edgesplat::shader::FootprintParams;
using uint = std::uint32_t;

inline float min(float a, float b) {
    return a < b ? a : b;
}
inline float max(float a, float b) {
    return a > b ? a : b;
}
inline float clamp(float v, float low, float high) {
    return min(max(v, low), high);
}
inline float abs(float v) {
    return std::fabs(v);
}
inline float sign(float v) {
    return static_cast<float>((v > 0) - (v < 0));
}
inline float sqrt(float v) {
    return std::sqrt(v);
}
inline float floor(float v) {
    return std::floor(v);
}
inline float acos(float v) {
    return std::acos(v);
}

struct vec3 {
    float x, y, z;
    template <typename X, typename Y, typename Z>
    vec3(X a, Y b, Z c) : x(static_cast<float>(a)), y(static_cast<float>(b)), z(static_cast<float>(c)) {}
};
struct Texel {
    float r;
};
using sampler2DArray = const edgesplat::FootprintTable*;

inline Texel textureLod(sampler2DArray table, const vec3& at, double) {
    const auto& size = table->size();
    const float u = clamp(at.x * static_cast<float>(size.width) - 0.5f, 0, static_cast<float>(size.width - 1));
    const float v = clamp(at.y * static_cast<float>(size.height) - 0.5f, 0, static_cast<float>(size.height - 1));
    const int i = std::min(static_cast<int>(u), size.width - 2), j = std::min(static_cast<int>(v), size.height - 2);
    const int layer = static_cast<int>(at.z + 0.5f);
    EXPECT_GE(layer, 0);
    EXPECT_LT(layer, size.distances * size.directions);
    const auto texel = [&](int x, int y) {
        return edgesplat::float_from_half(
            table->texels()[static_cast<std::size_t>((layer * size.height + y) * size.width + x)]);
    };
    const float fu = u - static_cast<float>(i), fv = v - static_cast<float>(j);
    return {(1 - fv) * ((1 - fu) * texel(i, j) + fu * texel(i + 1, j)) +
            fv * ((1 - fu) * texel(i, j + 1) + fu * texel(i + 1, j + 1))};
}

// GLSL's literals are float, C++'s are double: results are rounded to float wherever they are stored.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wdouble-promotion"
#include "shaders/lib/footprint.glsl"
#pragma GCC diagnostic pop

}  // namespace glsl

namespace edgesplat {
namespace {

using samples::Errors;
using samples::rays;

struct Float {
    float rho2, pn, un, d;
    Float(const Ray& ray, double distance)
        : rho2(static_cast<float>(ray.rho2)),
          pn(static_cast<float>(ray.pn)),
          un(static_cast<float>(ray.un)),
          d(static_cast<float>(distance)) {}
};

glsl::FootprintParams params_of(const FootprintTable& table, const PaperShape& shape = {}) {
    glsl::FootprintParams p{};
    p.half_width = static_cast<float>(table.band().half_width);
    p.strength = static_cast<float>(table.band().strength);
    p.table_extent = static_cast<float>(table.extent());
    p.table_width = static_cast<float>(table.size().width);
    p.table_height = static_cast<float>(table.size().height);
    p.table_distances = static_cast<float>(table.size().distances);
    p.table_directions = static_cast<float>(table.size().directions);
    p.paper_inset = static_cast<float>(shape.inset);
    p.paper_rise = static_cast<float>(shape.rise);
    p.paper_smooth = shape.curve == PaperCurve::Smooth;
    return p;
}

const FootprintTable& table() {
    static const FootprintTable built = FootprintTable::build({1.3, 12});
    return built;
}

TEST(FootprintShader, MirrorsTheTable) {
    const auto params = params_of(table());
    Errors nearest, lerp;
    int jumps = 0;
    for (const auto& [d, ray] : rays(20000, -3.2, 3.2, 20)) {
        const Float f(ray, d);
        lerp.add(static_cast<double>(glsl::footprint_table_lerp(&table(), f.rho2, f.pn, f.un, f.d, params)),
                 table().lerp(ray, d));
        // Rounding may pick the neighbouring layer where two are equally near.
        const double error =
            std::abs(static_cast<double>(glsl::footprint_table_nearest(&table(), f.rho2, f.pn, f.un, f.d, params)) -
                     table().nearest(ray, d));
        if (error > 1e-4) ++jumps;
    }
    EXPECT_LE(lerp.largest(), 3e-4);
    EXPECT_LE(jumps, 5);
}

TEST(FootprintShader, MirrorsTheQuadratureAndTheShortCut) {
    const auto params = params_of(table());
    Errors single, wall, warp2d;
    for (const auto& [d, ray] : rays(20000, -3.2, 3.2, 21)) {
        const Float f(ray, d);
        const Edge edge = {d, {1.3, 12}};
        const int faces = glsl::footprint_faces(f.d, 100.0f, params);
        EXPECT_EQ(faces, std::abs(d) < 2.9 ? 1 : 0);
        single.add(static_cast<double>(glsl::footprint_procedural(f.rho2, f.pn, f.un, f.d, 100.0f, faces, params)),
                   procedural_footprint(ray, edge));
        warp2d.add(static_cast<double>(glsl::footprint_warp2d(f.rho2, f.pn, f.un, f.d, params)),
                   warp2d_footprint(ray, edge));
        if (d < 0 || d > 2.8) continue;
        const float second = f.pn * f.pn + 0.2f;
        const Edge two = wall_edge(d, static_cast<double>(second), {1.3, 12});
        wall.add(static_cast<double>(glsl::footprint_procedural(f.rho2, f.pn, f.un, f.d, second,
                                                                glsl::footprint_faces(f.d, second, params), params)),
                 procedural_footprint(ray, two));
    }
    EXPECT_LE(single.largest(), 1e-4);
    EXPECT_LE(wall.largest(), 1e-4);
    EXPECT_LE(warp2d.largest(), 1e-4);
}

TEST(FootprintShader, MirrorsThePapersWarp) {
    for (PaperCurve curve : {PaperCurve::Cosine, PaperCurve::Smooth}) {
        const PaperShape shape = {0.3, 0.05, curve};
        const auto params = params_of(table(), shape);
        Errors procedural, warp2d;
        for (const auto& [d, ray] : rays(20000, -0.5, 1.8, 22)) {
            const Float f(ray, d);
            const PaperEdge edge = {d, shape};
            procedural.add(static_cast<double>(glsl::footprint_paper_procedural(f.rho2, f.pn, f.un, f.d, params)),
                           procedural_footprint(ray, edge));
            warp2d.add(static_cast<double>(glsl::footprint_paper_warp2d(f.rho2, f.pn, f.un, f.d, params)),
                       warp2d_footprint(ray, edge));
        }
        EXPECT_LE(procedural.largest(), 5e-4);
        EXPECT_LE(warp2d.largest(), 3e-3);  // map's slope is infinite at its knots
    }
}

TEST(FootprintShader, GivesNumbersForEveryInput) {
    const auto params = params_of(table());
    for (float rho2 : {0.0f, 1e-12f, 2.56f, 9.0f})
        for (float pn : {-3.0f, 0.0f, 1e-9f, 1.6f})  // also beyond what rho allows
            for (float un : {-1.0f, -1e-8f, 0.0f, 1.0f, 1.0000001f})
                for (float d : {-2.9f, -0.5f, 0.0f, 1.0f, 2.9f, 4.0f}) {
                    const auto check = [&](float f) {
                        EXPECT_TRUE(f >= 0 && f < 4) << f << " at " << rho2 << " " << pn << " " << un << " " << d;
                    };
                    for (float second : {0.0f, 0.6f, 1.5f, 100.0f})
                        check(glsl::footprint_procedural(rho2, pn, un, d, second,
                                                         glsl::footprint_faces(d, second, params), params));
                    check(glsl::footprint_warp2d(rho2, pn, un, d, params));
                    check(glsl::footprint_table_nearest(&table(), rho2, pn, un, d, params));
                    check(glsl::footprint_table_lerp(&table(), rho2, pn, un, d, params));
                    check(glsl::footprint_paper_warp2d(rho2, pn, un, d, params));
                    check(glsl::footprint_paper_procedural(rho2, pn, un, d, params));
                }
}

}  // namespace
}  // namespace edgesplat
