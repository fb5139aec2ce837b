#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/viewer/walls_internal.h"
#include "engine/volume/parallel.h"

namespace edgesplat::viewer {
namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();
constexpr std::size_t kBlock = 16;  // lines at a time: their samples fill a cache line

/// Memory layout of a grid's lines along an axis: `outer` groups of `inner` neighbouring lines.
struct Lines {
    std::size_t length, stride, inner, outer, outer_stride;
    Lines(const glm::ivec3& dims, int axis) {
        const glm::u64vec3 n(dims);
        const std::size_t strides[] = {1, n.x, n.x * n.y};
        length = n[axis];
        stride = strides[axis];
        inner = axis == 0 ? 1 : n.x;
        outer = axis == 0 ? n.y * n.z : axis == 1 ? n.z : n.y;
        outer_stride = axis == 1 ? n.x * n.y : n.x;
    }
    /// Calls `work(first, count)` for up to kBlock lines that begin next to each other.
    template <typename Work>
    void each_block(const Work& work) const {
        const std::size_t blocks = (inner + kBlock - 1) / kBlock;
        parallel_for(static_cast<int>(outer * blocks), [&](int begin, int end) {
            auto own = work;  // a copy with its own buffers
            for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k) {
                const std::size_t at = k % blocks * kBlock;
                own(k / blocks * outer_stride + at, std::min(kBlock, inner - at));
            }
        });
    }
};

/// Squared distances along the lines of an axis to the nearest crossing of a flip, by linear interpolation.
std::vector<float> along_lines(const Volume& volume, const SolidValues& values, int axis) {
    const Lines lines(volume.geometry.dims, axis);
    const double spacing = volume.geometry.spacing()[axis];
    std::vector<float> out(volume.values.size(), kFar);
    lines.each_block([&, position = std::vector<double>()](std::size_t first, std::size_t count) mutable {
        for (std::size_t line = first; line < first + count; ++line) {
            const auto sample = [&](std::size_t i) {
                return static_cast<double>(volume.values[line + i * lines.stride]);
            };
            position.clear();
            int before = values.interval(sample(0));
            for (std::size_t i = 0; i + 1 < lines.length; ++i) {
                const double a = sample(i), b = sample(i + 1);
                const int after = values.interval(b);
                const auto add = [&](int flip) {
                    const double t = (values.flips[static_cast<std::size_t>(flip)] - a) / (b - a);
                    position.push_back(static_cast<double>(i) + std::clamp(t, 0.0, 1.0));
                };
                for (int flip = before; flip < after; ++flip)
                    add(flip);
                for (int flip = before - 1; flip >= after; --flip)
                    add(flip);
                before = after;
            }
            if (position.empty()) continue;
            std::size_t next = 0;
            for (std::size_t i = 0; i < lines.length; ++i) {
                const auto x = static_cast<double>(i);
                while (next + 1 < position.size() && std::abs(position[next + 1] - x) <= std::abs(position[next] - x))
                    ++next;
                const double mm = (position[next] - x) * spacing;
                out[line + i * lines.stride] = static_cast<float>(mm * mm);
            }
        }
    });
    return out;
}

/// Lower envelope of the parabolas (s (x - i))^2 + f(i), for all x: Felzenszwalb and Huttenlocher's algorithm 1.
class Envelope {
  public:
    Envelope(std::size_t length, double spacing)
        : square_(spacing * spacing), f_(length), at_(length), from_(length + 1), out_(length) {}

    template <typename Get, typename Set>
    void run(const Get& get, const Set& set) {
        const std::size_t n = f_.size();
        std::size_t count = 0;
        for (std::size_t i = 0; i < n; ++i) {
            f_[i] = static_cast<double>(get(i));
            if (!(f_[i] < static_cast<double>(kFar))) continue;
            double from = -std::numeric_limits<double>::infinity();
            while (count > 0) {
                const std::size_t k = at_[count - 1];
                const auto a = static_cast<double>(k), b = static_cast<double>(i);
                from = ((f_[i] - f_[k]) / square_ + b * b - a * a) / (2 * (b - a));
                if (from > from_[count - 1]) break;
                --count;
            }
            from_[count] = count == 0 ? -std::numeric_limits<double>::infinity() : from;
            at_[count++] = i;
        }
        if (count == 0) return;
        std::size_t k = 0;
        for (std::size_t i = 0; i < n; ++i) {
            const auto x = static_cast<double>(i);
            while (k + 1 < count && from_[k + 1] < x)
                ++k;
            const double step = x - static_cast<double>(at_[k]);
            out_[i] = static_cast<float>(square_ * step * step + f_[at_[k]]);
        }
        for (std::size_t i = 0; i < n; ++i)
            set(i, out_[i]);
    }

  private:
    double square_;
    std::vector<double> f_;
    std::vector<std::size_t> at_;
    std::vector<double> from_;
    std::vector<float> out_;
};

/// One pass of the separable transform, in place.
void spread(std::vector<float>& squares, const VolumeGeometry& geometry, int axis) {
    const Lines lines(geometry.dims, axis);
    const std::size_t length = lines.length;
    lines.each_block([&, envelope = Envelope(length, geometry.spacing()[axis]),
                      block = std::vector<float>(length * kBlock)](std::size_t first, std::size_t count) mutable {
        for (std::size_t i = 0; i < length; ++i)
            std::copy_n(&squares[first + i * lines.stride], count, &block[i * kBlock]);
        for (std::size_t k = 0; k < count; ++k)
            envelope.run([&](std::size_t i) { return block[i * kBlock + k]; },
                         [&](std::size_t i, float v) { block[i * kBlock + k] = v; });
        for (std::size_t i = 0; i < length; ++i)
            std::copy_n(&block[i * kBlock], count, &squares[first + i * lines.stride]);
    });
}

void keep_less(std::vector<float>& a, const std::vector<float>& b) {
    std::transform(a.begin(), a.end(), b.begin(), a.begin(), [](float x, float y) { return std::min(x, y); });
}

/// Lower bound of a vector's length in the world if its length by spacings alone is 1: below 1 for axes that are not
/// orthogonal (Gershgorin's bound of the least singular value).
double least_stretch(const VolumeGeometry& geometry) {
    const glm::dvec3 spacing = geometry.spacing();
    double bound = 1;
    for (int i = 0; i < 3; ++i) {
        double others = 0;
        for (int k = 0; k < 3; ++k)
            if (k != i)
                others += std::abs(glm::dot(geometry.index_to_world_axes[i], geometry.index_to_world_axes[k])) /
                          (spacing[i] * spacing[k]);
        bound = std::min(bound, 1 - (others > 1e-6 ? others : 0));
    }
    return std::sqrt(std::max(bound, 0.01));
}

}  // namespace

std::vector<float> distances_to_crossings(const Volume& volume, const SolidValues& values) {
    const VolumeGeometry& geometry = volume.geometry;
    // Crossings on x and y edges are merged before the pass along z, which both need.
    std::vector<float> nearest = along_lines(volume, values, 0);
    spread(nearest, geometry, 1);
    {
        std::vector<float> of_y = along_lines(volume, values, 1);
        spread(of_y, geometry, 0);
        keep_less(nearest, of_y);
    }
    spread(nearest, geometry, 2);
    std::vector<float> of_z = along_lines(volume, values, 2);
    spread(of_z, geometry, 0);
    spread(of_z, geometry, 1);
    keep_less(nearest, of_z);
    const auto stretch = static_cast<float>(least_stretch(geometry));
    for (float& d : nearest)
        d = stretch * std::sqrt(d);
    return nearest;
}

}  // namespace edgesplat::viewer
