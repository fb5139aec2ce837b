// Prints the errors of estimated edges: a table of docs/accuracy.md. Uses only the double-precision reference, so these
// are the estimators' own errors. A program without pass or fail.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/reference/reference_renderer.h"
#include "footprints/kernel.h"
#include "tests/properties/measuring.h"

namespace edgesplat::test {
namespace {

constexpr int kOrientations = 24;

/// Errors of D and n, for voxels with an edge and |D| < R, away from the border.
void estimates(double sd) {
    constexpr int kSize = 22;
    fmt::print(
        "Estimated edges, blur {}: error of D (voxel) and of n (degrees), and voxels within R of the edge without "
        "one\n",
        sd);
    fmt::print("\n| estimator  | shape   |  D rms |    max |  n rms |    max | without |\n");
    fmt::print("|------------|---------|-------:|-------:|-------:|-------:|--------:|\n");
    for (const auto e : {EdgeEstimator::Taylor, EdgeEstimator::March, EdgeEstimator::Cubic}) {
        for (const double radius : {0.0, 10.0, 5.0, 3.0}) {
            double squares = 0, most = 0, angles = 0, widest = 0, count = 0, without = 0;
            for (const Pose& pose : poses(kOrientations)) {
                const glm::dvec3 center =
                    glm::dvec3((kSize - 1) / 2.0) + pose.shift - (radius > 6 ? 6.0 : 0.0) * pose.n;
                const auto distance = [&](const glm::dvec3& x) {
                    return radius > 0 ? glm::length(x - center) - radius : glm::dot(pose.n, x - center);
                };
                const VolumePointer volume =
                    sampled(glm::ivec3(kSize), [&](const glm::dvec3& x) { return blurred_step(distance(x), sd); });
                Settings settings;
                settings.edges = e;
                const reference::PreparedVolume prepared(*volume, two_tone(1, 1), settings);
                for (std::size_t i = 0; i < volume->values.size(); ++i) {
                    const glm::ivec3 v = prepared.field().voxel(i);
                    const glm::dvec3 x(v);
                    const double d = distance(x);
                    if (std::abs(d) >= kKernelRadius || glm::any(glm::lessThan(v, glm::ivec3(4))) ||
                        glm::any(glm::greaterThan(v, glm::ivec3(kSize - 5)))) {
                        continue;
                    }
                    ++count;
                    const auto& edge = prepared.edges()[i];
                    if (!edge.has_edge) {
                        ++without;
                        continue;
                    }
                    const glm::dvec3 outward = radius > 0 ? glm::normalize(x - center) : pose.n;
                    const double error = (edge.upper ? edge.D : -edge.D) - d;
                    const double angle = glm::degrees(
                        std::acos(std::clamp(glm::dot(edge.upper ? -edge.n : edge.n, outward), -1.0, 1.0)));
                    squares += error * error;
                    angles += angle * angle;
                    most = std::max(most, std::abs(error));
                    widest = std::max(widest, angle);
                }
            }
            const double n = count - without;
            fmt::print("| {:<10} | {:<7} | {:6.4f} | {:6.4f} | {:6.3f} | {:6.3f} | {:6.2f}% |\n", name_of(e),
                       radius > 0 ? fmt::format("r={}", radius) : "plane", std::sqrt(squares / n), most,
                       std::sqrt(angles / n), widest, 100 * without / count);
        }
    }
}

}  // namespace
}  // namespace edgesplat::test

int main() {
    edgesplat::test::estimates(0.7);
    return 0;
}
