#include "engine/reference/5_refine_pixels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>

#include "shaders/shared/limits.h"

namespace edgesplat::reference {
namespace {

using Cell = std::array<std::array<glm::dvec4, 4>, 4>;  ///< [y][x]; the inner four are the cell's corners

glm::dvec4 pixel(const Image& image, int x, int y) {
    glm::dvec4 v;
    for (int c = 0; c < 4; ++c)
        v[c] = static_cast<double>(image.at(x, y, c));
    return v;
}

glm::dvec4 shown(const glm::dvec4& v) {
    return {glm::sqrt(glm::max(glm::dvec3(v), 0.0) + 0.0015), v.a};
}

/// Cubic interpolation half way between b and c.
glm::dvec4 between(const glm::dvec4& a, const glm::dvec4& b, const glm::dvec4& c, const glm::dvec4& d) {
    return (9.0 * (b + c) - (a + d)) / 16.0;
}

/// The largest absolute second difference of any channel: along rows, along columns, and mixed.
double bend(const Cell& cell) {
    Cell seen;
    for (std::size_t y = 0; y < 4; ++y)
        for (std::size_t x = 0; x < 4; ++x)
            seen[y][x] = shown(cell[y][x]);
    glm::dvec4 most(0);
    for (std::size_t i = 1; i < 3; ++i) {
        for (std::size_t j = 0; j < 2; ++j) {
            most = glm::max(most, glm::abs(seen[i][j] - 2.0 * seen[i][j + 1] + seen[i][j + 2]));
            most = glm::max(most, glm::abs(seen[j][i] - 2.0 * seen[j + 1][i] + seen[j + 2][i]));
        }
    }
    for (std::size_t y = 0; y < 3; ++y)
        for (std::size_t x = 0; x < 3; ++x)
            most = glm::max(most, glm::abs(seen[y][x] - seen[y][x + 1] - seen[y + 1][x] + seen[y + 1][x + 1]));
    return std::max({most.r, most.g, most.b, most.a});
}

}  // namespace

RefinedPicture refine_pixels(const Image& every) {
    RefinedPicture out{every, 0};
    const auto put = [&](int x, int y, const glm::dvec4& v) {
        if (x >= every.width || y >= every.height) return;
        for (int c = 0; c < 4; ++c)
            out.picture.at(x, y, c) = static_cast<float>(c < 3 ? std::max(v[c], 0.0) : std::clamp(v[c], 0.0, 1.0));
    };
    const auto draw = [&](int x, int y) {
        if (x >= every.width || y >= every.height) return;
        ++out.drawn;
        for (int c = 0; c < 4; ++c)
            out.picture.at(x, y, c) = every.at(x, y, c);
    };
    constexpr int kFirst = static_cast<int>(shader::REFINE_STEP);
    for (int y = 0; y < every.height; y += kFirst)
        for (int x = 0; x < every.width; x += kFirst)
            draw(x, y);
    for (int step = kFirst, half = step / 2; step > 1; step = half, half /= 2) {
        const glm::ivec2 last = (glm::ivec2(every.width, every.height) - 1) / step * step;
        for (int y = 0; y < every.height; y += step) {
            for (int x = 0; x < every.width; x += step) {
                Cell cell;
                for (int j = 0; j < 4; ++j) {
                    for (int i = 0; i < 4; ++i) {
                        const glm::ivec2 at =
                            glm::clamp(glm::ivec2(x, y) + step * (glm::ivec2(i, j) - 1), glm::ivec2(0), last);
                        cell.at(static_cast<std::size_t>(j)).at(static_cast<std::size_t>(i)) =
                            pixel(out.picture, at.x, at.y);
                    }
                }
                const bool smooth = bend(cell) <= static_cast<double>(shader::REFINE_TOLERANCE) && x + step <= last.x &&
                                    y + step <= last.y;
                if (smooth) {
                    std::array<glm::dvec4, 4> rows;
                    for (std::size_t j = 0; j < 4; ++j)
                        rows.at(j) = between(cell[j][0], cell[j][1], cell[j][2], cell[j][3]);
                    put(x + half, y, rows[1]);
                    put(x, y + half, between(cell[0][1], cell[1][1], cell[2][1], cell[3][1]));
                    put(x + half, y + half, between(rows[0], rows[1], rows[2], rows[3]));
                } else {
                    draw(x + half, y);
                    draw(x, y + half);
                    draw(x + half, y + half);
                }
            }
        }
    }
    return out;
}

}  // namespace edgesplat::reference
