// Supersampling: the mean of several pictures with subpixel ray offsets.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "engine/image/image.h"

namespace edgesplat {

/// Offsets of the n x n samples of a pixel from its centre, in pixels, row by row. n = 1: the centre.
inline std::vector<glm::dvec2> sample_offsets(int n) {
    std::vector<glm::dvec2> offsets;
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x)
            offsets.emplace_back((x + 0.5) / n - 0.5, (y + 0.5) / n - 0.5);
    return offsets;
}

/// Accumulates RGBA pictures of one size in double.
class SampleMean {
  public:
    explicit SampleMean(const glm::ivec2& size) : size_(size) {}

    /// `pixels`: (height, width, 4).
    void add(std::span<const float> pixels) {
        sums_.resize(pixels.size());
        for (std::size_t i = 0; i < pixels.size(); ++i)
            sums_[i] += static_cast<double>(pixels[i]);
        ++count_;
    }

    /// The mean; needs at least one picture.
    Image image() const {
        Image mean(size_.x, size_.y, 4);
        for (std::size_t i = 0; i < sums_.size(); ++i)
            mean.pixels[i] = static_cast<float>(sums_[i] / count_);
        return mean;
    }

  private:
    glm::ivec2 size_;
    std::vector<double> sums_;
    int count_ = 0;
};

}  // namespace edgesplat
