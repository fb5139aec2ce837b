#include "footprints/kernel_fit.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

namespace edgesplat {
namespace {

constexpr std::size_t kUnknowns = 7;  // six coefficients and the ripple
using Row = std::array<double, kUnknowns>;

// minimise the last unknown subject to a_i . x >= b_i, x free. Solved as its dual: maximise b . y subject to sum_i y_i
// a_i = (0, ..., 0, 1), y >= 0, which has only seven rows, by the revised simplex method; x are its multipliers.
class SmallestRipple {
  public:
    void require(const Row& a, double b) {
        rows_.push_back(a);
        bounds_.push_back(b);
    }

    Row solve() {
        // The first basis consists of artificial columns +-e_r, whose price no real column reaches.
        const double penalty = 1e4;
        const std::size_t real = rows_.size();
        std::vector<std::size_t> basis;
        for (std::size_t r = 0; r < kUnknowns; ++r) {
            Row unit{};
            unit[r] = 1;
            require(unit, -penalty);
            basis.push_back(real + r);
        }
        std::array<Row, kUnknowns> inverse{};
        for (std::size_t r = 0; r < kUnknowns; ++r)
            inverse[r][r] = 1;
        Row value{};
        value[kUnknowns - 1] = 1;

        for (int step = 0; step < 20000; ++step) {
            Row x{};
            for (std::size_t r = 0; r < kUnknowns; ++r)
                for (std::size_t c = 0; c < kUnknowns; ++c)
                    x[c] += bounds_[basis[r]] * inverse[r][c];
            // The constraint that is violated most, in units of its own length, enters the basis.
            std::size_t entering = rows_.size();
            double worst = 1e-11;
            for (std::size_t i = 0; i < real; ++i) {
                const double violation = bounds_[i] - dot(rows_[i], x);
                if (violation > worst) worst = violation, entering = i;
            }
            if (entering == rows_.size()) return x;
            Row column{};
            for (std::size_t r = 0; r < kUnknowns; ++r)
                column[r] = dot(inverse[r], rows_[entering]);
            std::size_t leaving = kUnknowns;
            double smallest = 0;
            for (std::size_t r = 0; r < kUnknowns; ++r) {
                if (column[r] <= 1e-12) continue;
                const double ratio = value[r] / column[r];
                const bool better = leaving == kUnknowns || ratio < smallest - 1e-15 ||
                                    (ratio <= smallest && column[r] > column[leaving]);
                if (better) leaving = r, smallest = ratio;
            }
            if (leaving == kUnknowns) throw std::runtime_error("fit_kernel: the linear program has no solution");
            pivot(inverse, value, column, leaving);
            basis[leaving] = entering;
        }
        throw std::runtime_error("fit_kernel: the simplex method did not finish");
    }

  private:
    static double dot(const Row& a, const Row& b) {
        double sum = 0;
        for (std::size_t i = 0; i < kUnknowns; ++i)
            sum += a[i] * b[i];
        return sum;
    }

    static void pivot(std::array<Row, kUnknowns>& inverse, Row& value, const Row& column, std::size_t leaving) {
        for (double& v : inverse[leaving])
            v /= column[leaving];
        value[leaving] /= column[leaving];
        for (std::size_t r = 0; r < kUnknowns; ++r) {
            if (r == leaving) continue;
            for (std::size_t c = 0; c < kUnknowns; ++c)
                inverse[r][c] -= column[r] * inverse[leaving][c];
            value[r] = std::max(0.0, value[r] - column[r] * value[leaving]);
        }
    }

    std::vector<Row> rows_;
    std::vector<double> bounds_;
};

Row negative(Row row) {
    for (double& v : row)
        v = -v;
    return row;
}

}  // namespace

Kernel fit_kernel(int steps, double radius) {
    if (steps < 4 || steps > 64) throw std::invalid_argument("fit_kernel: steps must be in [4, 64]");
    if (!(radius >= 1 && radius <= 2)) throw std::invalid_argument("fit_kernel: the radius must be in [1, 2]");
    const double radius2 = radius * radius;
    SmallestRipple program;

    // |sum_n c_n S_n(x) - 1| <= ripple, S_n the lattice sum of w^n, at points of the cell's smallest symmetric part.
    for (int ix = 0; ix <= steps; ++ix)
        for (int iy = 0; iy <= ix; ++iy)
            for (int iz = 0; iz <= iy; ++iz) {
                Row sums{};
                for (int cell = 0; cell < 125; ++cell) {
                    const double x = 0.5 * ix / steps - (cell % 5 - 2), y = 0.5 * iy / steps - (cell / 5 % 5 - 2),
                                 z = 0.5 * iz / steps - (cell / 25 - 2);
                    const double w = std::max(0.0, 1 - (x * x + y * y + z * z) / radius2);
                    double power = w * w;
                    for (std::size_t n = 0; n + 1 < kUnknowns; ++n, power *= w)
                        sums[n] += power;
                }
                sums[kUnknowns - 1] = 1;
                program.require(sums, 1);
                Row minus = negative(sums);
                minus[kUnknowns - 1] = 1;
                program.require(minus, -1);
            }

    // dK/dw >= 0, divided by w so that the constraint keeps its weight near the border.
    constexpr int kSlopes = 100;
    for (int i = 0; i <= kSlopes; ++i) {
        Row slope{};
        double power = 1;
        for (std::size_t n = 0; n + 1 < kUnknowns; ++n, power *= static_cast<double>(i) / kSlopes)
            slope[n] = (static_cast<double>(n) + 2) * power;
        program.require(slope, 0);
    }

    // Integral over space, term by term: of w^n it is 4 pi R^3 times the integral of s^2 (1-s^2)^n over [0, 1].
    Row volume{};
    double integral = 1.0 / 3;
    for (int n = 1; n <= 7; ++n) {
        integral *= 2.0 * n / (2.0 * n + 3);
        if (n >= 2) volume[static_cast<std::size_t>(n) - 2] = 4 * std::numbers::pi * radius2 * radius * integral;
    }
    program.require(volume, 1);
    program.require(negative(volume), -1);

    const Row x = program.solve();
    Kernel kernel{radius, {}};
    std::copy_n(x.begin(), kernel.coefficients.size(), kernel.coefficients.begin());
    return kernel;
}

}  // namespace edgesplat
