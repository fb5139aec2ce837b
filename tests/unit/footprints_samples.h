// Rays and error statistics that the footprint tests share.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <string>
#include <vector>

#include "footprints/footprint_integral.h"
#include "footprints/kernel.h"

namespace edgesplat::samples {

inline const double kPeak = kernel_footprint(0);

struct Sample {
    double distance;
    Ray ray;
};

/// Random rays near a voxel, with edges at D in [low, high]. Every fourth ray is nearly edge-on, where warps are
/// sharpest; some rays are exactly edge-on or along the normal.
inline std::vector<Sample> rays(std::size_t count, double low, double high, unsigned seed = 1) {
    std::mt19937 random(seed);
    const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<>(a, b)(random); };
    std::vector<Sample> all;
    for (std::size_t i = 0; i < count; ++i) {
        const double c = i % 50 == 0 ? 0 : i % 50 == 1 ? 1 : i % 4 == 0 ? uniform(0, 0.15) : uniform(0, 1);
        all.push_back({uniform(low, high), ray_through(uniform(-2.2, 2.2), uniform(0, 1.6), c)});
    }
    return all;
}

/// Errors relative to the isotropic footprint's peak.
class Errors {
  public:
    void add(double value, double truth) { all_.push_back(std::abs(value - truth) / kPeak); }
    double largest() const { return *std::max_element(all_.begin(), all_.end()); }
    double percentile(double p) const {
        std::vector<double> sorted = all_;
        std::sort(sorted.begin(), sorted.end());
        return sorted[static_cast<std::size_t>(p / 100 * static_cast<double>(sorted.size() - 1))];
    }

  private:
    std::vector<double> all_;
};

}  // namespace edgesplat::samples
