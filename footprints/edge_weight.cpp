#include "footprints/edge_weight.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <mutex>
#include <utility>
#include <vector>

#include "footprints/gauss_legendre.h"
#include "footprints/kernel.h"

namespace edgesplat {

namespace {

constexpr std::size_t kUnknowns = kEdgeWeightSteps;  // the weight at the reach is 1
constexpr int kRays = 1000;
constexpr double kPi = 3.14159265358979323846;
// Of squared second differences, against a mean square excess: enough to keep bands of little influence smooth.
constexpr double kSmoothness = 1e-5;

using Vector = std::array<double, kUnknowns>;

/// Numbers in [0, 1) that are the same on every machine (Steele et al. 2014, SplitMix64).
class Uniform {
  public:
    double operator()() {
        std::uint64_t z = state_ += 0x9e3779b97f4a7c15U;
        z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
        z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
        return static_cast<double>((z ^ (z >> 31U)) >> 11U) * 0x1p-53;
    }
    glm::dvec3 in_cube() {
        const double x = (*this)(), y = (*this)(), z = (*this)();
        return glm::dvec3(x, y, z) - 0.5;
    }

  private:
    std::uint64_t state_ = 1;
};

/// A half space n.x < 0 with the lattice anywhere, and a ray through its face at the origin.
struct HalfSpace {
    glm::dvec3 n, u;  ///< unit; u.n > 0
    glm::dvec3 lattice;
};

HalfSpace half_space(int number, Uniform& uniform) {
    // Faces next to the lattice's own planes have terraces many voxels wide, that no kernel evens out.
    HalfSpace h;
    const double z = 2 * uniform() - 1, turn = 2 * kPi * uniform(), r = std::sqrt(1 - z * z);
    h.n = {r * std::cos(turn), r * std::sin(turn), z};
    const glm::dvec3 tilt = 0.2 * uniform.in_cube();
    if (number % 4 == 0) h.n = glm::normalize(glm::dvec3(0, 0, 1) + tilt);
    if (number % 8 == 1) h.n = glm::normalize(glm::dvec3(1, 1, 0) + tilt);
    if (number % 16 == 3) h.n = glm::normalize(glm::dvec3(1, 1, 1) + tilt);
    h.u = glm::normalize(h.n + uniform() * uniform.in_cube());
    h.lattice = uniform.in_cube();
    return h;
}

/// Ends of the panels of the integral, in distance to the face; finest where the warp is steepest.
std::vector<double> panels(const EdgeBand& band) {
    std::vector<double> ends{0};
    for (const double share : {0.02, 0.06, 0.15, 0.3, 0.6, 1.0}) {
        ends.push_back(share * band.half_width);
        ends.push_back(-share * band.half_width);
    }
    const double inmost = -(kEdgeWeightReach + kKernelRadius);
    for (double s = -band.half_width - 0.7; s > inmost; s -= 0.7)
        ends.push_back(s);
    if (inmost < -band.half_width) ends.push_back(inmost);
    if (band.half_width < kKernelRadius) ends.push_back(kKernelRadius);
    std::sort(ends.begin(), ends.end());
    return ends;
}

/// Excess of the ray's integral with all weights one, and what each weight adds to it; in voxels across the face.
double excess(const HalfSpace& h, const EdgeBand& band, const std::vector<double>& ends, Vector& shares) {
    static const QuadratureRule rule = gauss_legendre(8);
    shares.fill(0);
    double sum = 0;
    const double along = 1 / glm::dot(h.u, h.n);
    for (std::size_t panel = 0; panel + 1 < ends.size(); ++panel) {
        const double width = ends[panel + 1] - ends[panel];
        for (std::size_t node = 0; node < rule.size(); ++node) {
            const double s = ends[panel] + width * rule.nodes[node], share = width * rule.weights[node];
            if (s < 0) sum -= share;
            const glm::dvec3 x = s * along * h.u + (edge_warp(s, band) - s) * h.n - h.lattice;
            const glm::ivec3 low(glm::ceil(x - kKernelRadius)), high(glm::floor(x + kKernelRadius));
            for (int k = low.z; k <= high.z; ++k)
                for (int j = low.y; j <= high.y; ++j)
                    for (int i = low.x; i <= high.x; ++i) {
                        const glm::dvec3 voxel(i, j, k);
                        const double distance = -glm::dot(h.n, voxel + h.lattice);
                        const glm::dvec3 r = x - voxel;
                        const double value = distance > 0 ? share * kernel(glm::dot(r, r)) : 0;
                        if (!(value > 0)) continue;
                        sum += value;
                        const double at = distance * (kEdgeWeightSteps / kEdgeWeightReach);
                        const auto cell = static_cast<std::size_t>(at);
                        const double part = at - static_cast<double>(cell);
                        if (cell < kUnknowns) shares[cell] += value * (1 - part);
                        if (cell + 1 < kUnknowns) shares[cell + 1] += value * part;
                    }
        }
    }
    return sum;
}

/// Gauss-Jordan; the matrix is symmetric and positive definite.
Vector solved(std::array<Vector, kUnknowns> matrix, Vector right) {
    for (std::size_t p = 0; p < kUnknowns; ++p) {
        const double pivot = 1 / matrix[p][p];
        for (double& v : matrix[p])
            v *= pivot;
        right[p] *= pivot;
        for (std::size_t row = 0; row < kUnknowns; ++row) {
            const double factor = row == p ? 0 : matrix[row][p];
            for (std::size_t column = 0; column < kUnknowns; ++column)
                matrix[row][column] -= factor * matrix[p][column];
            right[row] -= factor * right[p];
        }
    }
    return right;
}

EdgeWeights fitted(const EdgeBand& band) {
    const std::vector<double> ends = panels(band);
    std::array<Vector, kUnknowns> matrix{};
    Vector right{}, shares{};
    Uniform uniform;
    for (int ray = 0; ray < kRays; ++ray) {
        const double missed = -excess(half_space(ray, uniform), band, ends, shares);
        for (std::size_t i = 0; i < kUnknowns; ++i) {
            right[i] += shares[i] * missed / kRays;
            for (std::size_t j = 0; j < kUnknowns; ++j)
                matrix[i][j] += shares[i] * shares[j] / kRays;
        }
    }
    // Second differences, of weights that go on as 1 beyond the reach.
    constexpr std::array<double, 3> difference{1, -2, 1};
    for (std::size_t first = 0; first < kUnknowns; ++first)
        for (std::size_t p = 0; p < 3; ++p)
            for (std::size_t q = 0; q < 3; ++q)
                if (first + std::max(p, q) < kUnknowns)
                    matrix[first + p][first + q] += kSmoothness * difference[p] * difference[q];
    const Vector change = solved(matrix, right);
    EdgeWeights weights;
    weights.fill(1);
    for (std::size_t i = 0; i < kUnknowns; ++i)
        weights[i] = std::clamp(1 + change[i], 0.0, 2.0);
    return weights;
}

}  // namespace

EdgeWeights edge_weights(const EdgeBand& band) {
    static std::mutex guard;
    static std::map<std::pair<double, double>, EdgeWeights> known;
    const std::lock_guard lock(guard);
    const auto [found, is_new] = known.try_emplace({band.half_width, band.strength});
    if (is_new) found->second = fitted(band);
    return found->second;
}

double edge_weight(double distance, const EdgeWeights& weights) {
    if (!(distance < kEdgeWeightReach)) return 1;
    const double at = std::max(distance, 0.0) * (kEdgeWeightSteps / kEdgeWeightReach);
    const auto cell = std::min(static_cast<std::size_t>(at), weights.size() - 2);
    return weights[cell] + (weights[cell + 1] - weights[cell]) * (at - static_cast<double>(cell));
}

double edge_weight(double distance, double second_distance, const EdgeBand& band, const EdgeWeights& weights) {
    const double one = edge_weight(distance, weights);
    if (!(second_distance < kKernelRadius + band.half_width)) return one;
    const double both = one * edge_weight(second_distance, weights);
    return 1 + (both - 1) * std::clamp(2 * (distance + second_distance) - 5, 0.0, 1.0);
}

}  // namespace edgesplat
