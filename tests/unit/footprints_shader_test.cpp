// Runs the footprints of the shaders as C++ in float and compares them with those in double precision.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <glm/glm.hpp>
#include <limits>
#include <random>

#include "footprints/face.h"
#include "footprints/footprint_table.h"
#include "shaders/shared/footprint_params.h"
#include "shaders/shared/footprint_table.h"
#include "shaders/shared/limits.h"
#include "tests/unit/footprints_samples.h"

// GLSL's built-in float functions.
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
inline float mix(float a, float b, bool second) {
    return second ? b : a;
}
inline float mix(float a, float b, float t) {
    return a + (b - a) * t;
}
inline float inversesqrt(float v) {
    return 1 / std::sqrt(v);
}
inline float acos(float v) {
    return std::acos(v);
}

// GLSL literals are float, C++ literals are double: results are rounded to float when they are stored.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wdouble-promotion"
#undef EDGESPLAT_FACE_TYPES_GLSL
#undef EDGESPLAT_KERNEL_GLSL
#define EDGESPLAT_IN_FLOAT_GLSL
#define Real float
#define CONSTANT const
// The including shader sets the number of nodes per piece of a footprint: one copy of the source for each number.
namespace nodes4 {
const uint NODES = 4;
uint NARROW = 0;
#include "shaders/footprints/footprint.glsl"

// Included after its dependencies.
const uint FACE_PIECES = 2;
#include "footprints/face.glsl"

// The table's layers, and the bilinear lookup of a sampler with linear filter.
const std::uint16_t* layers = nullptr;
using namespace edgesplat::shader;
inline float table_texel(float x, float y, float layer) {
    const auto texel = [&](float column, float row) {
        const auto at = ((static_cast<std::size_t>(layer) * TABLE_ROWS + static_cast<std::size_t>(row)) * TABLE_WIDTH);
        return edgesplat::float_from_half(layers[at + static_cast<std::size_t>(column)]);
    };
    const float i = min(floor(x), TABLE_WIDTH - 2.0f), j = min(floor(y), TABLE_ROWS - 2.0f);
    return mix(mix(texel(i, j), texel(i + 1, j), x - i), mix(texel(i, j + 1), texel(i + 1, j + 1), x - i), y - j);
}
#include "shaders/footprints/footprint_layer.glsl"

// Included after its dependencies.
#include "footprints/table_lookup.glsl"
}  // namespace nodes4
#undef EDGESPLAT_FOOTPRINT_GLSL
#undef EDGESPLAT_SLICE_GLSL
#undef EDGESPLAT_KERNELS_GLSL
#undef EDGESPLAT_KERNEL_GLSL
#undef EDGESPLAT_PAPER_KNOTS_GLSL
#undef EDGESPLAT_PAPER_FOOTPRINT_GLSL
namespace nodes10 {
const uint NODES = 10;
const uint NARROW = 0;
#include "shaders/footprints/footprint.glsl"
}  // namespace nodes10
#undef CONSTANT
#undef Real
#pragma GCC diagnostic pop

}  // namespace glsl

namespace edgesplat {
namespace {

using samples::Errors;
using samples::rays;
namespace ten = glsl::nodes10;

const ten::Slice kWhole{-1e9F, 1e9F};

struct Float {
    float rho2, pn, un, d;
    Float(const Ray& ray, double distance)
        : rho2(static_cast<float>(ray.rho2)),
          pn(static_cast<float>(ray.pn)),
          un(static_cast<float>(ray.un)),
          d(static_cast<float>(distance)) {}
};

/// Reverses every second ray.
Ray turned(const Ray& ray, std::size_t i) {
    return {ray.rho2, ray.pn, i % 2 == 0 ? ray.un : -ray.un};
}

glsl::FootprintParams params_of(const PaperShape& shape) {
    return {static_cast<float>(shape.inset), static_cast<float>(shape.rise), shape.curve == PaperCurve::Smooth,
            static_cast<float>(kPaperReach)};
}

TEST(FootprintShader, RoundsFaces) {
    namespace four = glsl::nodes4;
    std::mt19937 random(31);
    const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<>(a, b)(random); };
    const auto f = [](double v) { return static_cast<float>(v); };
    const auto quadratic = [&](const Quadratic& q) { return four::Quadratic{f(q.c), f(q.b), f(q.a)}; };
    Errors error;
    int entries = 0, cut = 0;
    for (int i = 0; i < 20000; ++i) {
        // A quadric around a foot point on the x axis, and a random ray.
        const double distance = uniform(-1.5, 2.3), bend = uniform(-1, 1);
        const glm::dmat3 h = bend * glm::dmat3(0.3, 0.1, 0.05, 0.1, uniform(-1, 1), 0.1, 0.05, 0.1, uniform(-1, 1));
        const glm::dvec3 u = glm::normalize(glm::dvec3(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)));
        const glm::dvec3 any(uniform(-1.5, 1.5), uniform(-1.5, 1.5), uniform(-1.5, 1.5));
        const glm::dvec3 p = any - glm::dot(any, u) * u, foot(distance, 0, 0), n(1, 0, 0);
        const glm::dvec3 own = n - h * foot, slope = own + h * p, turn = h * u;
        const double value = -distance + 0.5 * glm::dot(foot, h * foot);
        const FaceRay ray{glm::dot(p, p),
                          {value + 0.5 * glm::dot(own + slope, p), glm::dot(slope, u), 0.5 * glm::dot(u, turn)},
                          {glm::dot(slope, slope), 2 * glm::dot(slope, turn), glm::dot(turn, turn)},
                          glm::dot(p, slope),
                          glm::dot(p, turn)};
        const double thickness =
            i % 3 == 0 ? std::max(distance, -0.5) + uniform(0.6, 2) : std::numeric_limits<double>::infinity();
        const double deepest = i % 2 == 0 ? FACE_DEPTH : 0.0;
        four::NARROW = i % 4 < 2 ? 1 : 0;
        const Kernel& kernel = four::NARROW == 1 ? kNarrowKernel : kKernel;
        FaceCut want = face_cut(distance, h[0][0], 2 * std::abs(bend), thickness, deepest, kernel);
        four::FaceCut got = four::face_cut(f(distance), f(h[0][0]), f(2 * std::abs(bend)),
                                           thickness < 1e8 ? f(thickness) : 1e9F, f(deepest));
        const auto plane = [&] { return glm::normalize(glm::dvec3(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1))); };
        const glm::dvec3 normal = plane();
        const double beside = i % 4 == 1 ? uniform(0.1, 2) : 9;
        const glm::dvec3 square = plane();
        const bool cuts = beside < kernel.radius + want.depth;
        FaceCrease want_crease = kNoCrease;
        if (cuts)
            want_crease = {glm::dot(normal, p),
                           glm::dot(normal, u),
                           beside,
                           glm::dot(normal, own),
                           glm::dot(square, p),
                           glm::dot(square, u),
                           i % 8 == 1 ? beside + uniform(0, 1) : FACE_NOWHERE};
        want = with_crease(want, beside, kernel);
        got = four::with_crease(got, f(beside));
        const four::FaceCrease crease{
            f(want_crease.p),        f(want_crease.u),        f(want_crease.distance),       f(want_crease.facing),
            f(want_crease.corner_p), f(want_crease.corner_u), f(want_crease.corner_distance)};
        EXPECT_NEAR(static_cast<double>(got.depth), want.depth, 1e-5);
        EXPECT_NEAR(std::sqrt(static_cast<double>(got.reach2)), std::sqrt(want.reach2), 1e-4);
        EXPECT_GE(static_cast<double>(got.shift + got.radius), kernel.radius - 0.01);
        const FaceFootprint a = FacePath(ray, want, want_crease, kernel).footprint(4);
        const four::FaceFootprint b =
            four::footprint_face({f(ray.rho2), quadratic(ray.phi), quadratic(ray.slope2), f(ray.across), f(ray.turn)},
                                 got, true, crease, {-1e9F, 1e9F});
        error.add(static_cast<double>(b.integral), a.integral);
        if (!(a.integral > 1e-3)) continue;
        ++cut;
        const auto differ = [](const four::FaceEnd& got_end, const FaceEnd& want_end) {
            return std::abs(static_cast<double>(got_end.z) - want_end.z) > 1e-3 ||
                   (got_end.side < 0) != (want_end.side < 0) || got_end.plane != want_end.plane;
        };
        entries += differ(b.entry, a.entry) || differ(b.leave, a.leave) ? 1 : 0;
    }
    EXPECT_GT(cut, 5000);
    // If a ray only touches a face, rounding decides whether it meets the face.
    EXPECT_LE(entries, cut / 500);
    EXPECT_LE(error.percentile(99.5), 1e-3);
}

TEST(FootprintShader, BorderWeightReplacesMissingKernels) {
    // An outermost voxel lies half a voxel inside the border. `beyond`: the part of its kernel beyond the border.
    constexpr int kSteps = 4000;
    double beyond = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double t = 0.5 + (kKernelRadius - 0.5) * (i + 0.5) / kSteps;
        beyond += kernel_plane_integral(t * t) * (kKernelRadius - 0.5) / kSteps;
    }
    EXPECT_NEAR(static_cast<double>(shader::BORDER_WEIGHT), 1 / (1 - beyond), 1e-4);
}

TEST(FootprintShader, MirrorsTheTable) {
    namespace four = glsl::nodes4;
    const auto f = [](double v) { return static_cast<float>(v); };
    for (const double depth : {FACE_DEPTH, 0.0}) {
        const FootprintTable& table = kept_footprint_table(depth);
        four::NARROW = depth > 0 ? 1 : 0;
        four::layers = table.texels().data();
        Errors error;
        int other = 0;
        for (const auto& [distance, ray] : rays(20000, -1, 3.2, 25)) {
            const FootprintLayer want = select_footprint_layer(distance, ray.un, depth);
            // A blend close to the midpoint between two steps may round either way.
            other += four::select_footprint_layer(f(distance), f(ray.un), f(depth)) != want.code ? 1 : 0;
            const four::FootprintLayer got = four::decode_footprint_layer(want.code, f(depth));
            EXPECT_NEAR(static_cast<double>(got.middle), want.middle, 1e-6);
            EXPECT_NEAR(static_cast<double>(got.cosine), want.cosine, 1e-6);
            EXPECT_NEAR(static_cast<double>(got.rim2), want.rim2, 3e-6);
            const double sine = std::sqrt(1 - ray.un * ray.un), x = sine > 0 ? ray.pn / sine : 0;
            const double y = std::sqrt(std::max(ray.rho2 - x * x, 0.0));
            error.add(static_cast<double>(four::footprint_looked_up(got, f(x), f(x * x + y * y))),
                      table.lookup(want, x, y));
        }
        std::printf("table, float32 against double, %% of the peak: 99.5 %% %.4f, largest %.4f\n",
                    100 * error.percentile(99.5), 100 * error.largest());
        EXPECT_LE(other, 60);
        EXPECT_LE(error.percentile(99.5), 1e-4);
    }
}

TEST(FootprintShader, MirrorsThePapersWarp) {
    for (PaperCurve curve : {PaperCurve::Cosine, PaperCurve::Smooth}) {
        const PaperShape shape = {0.3, 0.05, curve};
        const auto params = params_of(shape);
        Errors procedural, warp2d;
        for (const auto& [d, ray] : rays(20000, -0.5, 1.8, 22)) {
            const Float f(ray, d);
            const PaperEdge edge = {d, shape};
            procedural.add(
                static_cast<double>(ten::footprint_paper_procedural(f.rho2, f.pn, f.un, f.d, kWhole, params)),
                procedural_footprint(ray, edge));
            warp2d.add(static_cast<double>(ten::footprint_paper_warp2d(f.rho2, f.pn, f.un, f.d, kWhole, params)),
                       warp2d_footprint(ray, edge));
        }
        EXPECT_LE(procedural.largest(), 5e-4);
        EXPECT_LE(warp2d.largest(), 3e-3);  // map's slope is infinite at its knots
    }
}

TEST(FootprintShader, MirrorsSlicesOfEveryFootprint) {
    namespace four = glsl::nodes4;
    four::NARROW = 0;
    const PaperShape shape = {0.3, 0.05, PaperCurve::Smooth};
    const auto params = params_of(shape);
    std::mt19937 random(24);
    std::uniform_real_distribution<> place(-3, 2.75);
    Errors plain, warp2d, paper;
    std::size_t i = 0;
    for (const auto& [d, plain_ray] : rays(20000, -0.5, 1.8, 24)) {
        const Ray ray = turned(plain_ray, i++);
        const Float f(ray, d);
        const float low = static_cast<float>(place(random));
        const four::Slice s{low, low + 0.25F};
        const Slice slice = {static_cast<double>(s.low), static_cast<double>(s.high)};
        const PaperEdge edge{d, shape};
        const auto value = [](float v) { return static_cast<double>(v); };
        plain.add(value(four::footprint_isotropic(f.rho2, s)), sliced_kernel_footprint(ray.rho2, slice));
        warp2d.add(value(four::footprint_paper_warp2d(f.rho2, f.pn, f.un, f.d, s, params)),
                   warp2d_footprint(ray, edge, slice));
        paper.add(value(four::footprint_paper_procedural(f.rho2, f.pn, f.un, f.d, s, params)),
                  procedural_footprint(ray, edge, 4, slice));
    }
    std::printf("slices, float32 against double, %% of the peak: plain %.4f, warp2d %.4f, paper %.4f\n",
                100 * plain.largest(), 100 * warp2d.largest(), 100 * paper.largest());
    EXPECT_LE(plain.largest(), 1e-5);
    EXPECT_LE(warp2d.largest(), 1e-4);
    EXPECT_LE(paper.largest(), 5e-4);
}

TEST(FootprintShader, IsFiniteForEveryInput) {
    const auto params = params_of({});
    for (float rho2 : {0.0f, 1e-12f, 2.56f, 9.0f})
        for (float pn : {-3.0f, 0.0f, 1e-9f, 1.6f})  // including |pn| > rho
            for (float un : {-1.0f, -1e-8f, 0.0f, 1.0f, 1.0000001f})
                for (float d : {-2.9f, -0.5f, 0.0f, 1.0f, 2.9f, 4.0f})
                    for (const ten::Slice s : {kWhole, ten::Slice{-0.1f, 0.15f}, ten::Slice{0.0f, 0.0f},
                                               ten::Slice{5.0f, 5.25f}, ten::Slice{-1e9f, 0.0f}}) {
                        const auto check = [&](float f) {
                            EXPECT_TRUE(f >= 0 && f < 4) << f << " at " << rho2 << " " << pn << " " << un << " " << d
                                                         << " slice " << s.low << " " << s.high;
                        };
                        check(ten::footprint_isotropic(rho2, s));
                        check(ten::footprint_paper_warp2d(rho2, pn, un, d, s, params));
                        check(ten::footprint_paper_procedural(rho2, pn, un, d, s, params));
                    }
}

}  // namespace
}  // namespace edgesplat
