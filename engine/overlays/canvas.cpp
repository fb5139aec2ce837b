#include "engine/overlays/canvas.h"

#include <algorithm>
#include <cmath>

#include "engine/error.h"
#include "engine/files/picture_library_internal.h"
#include "engine/overlays/font.h"

namespace edgesplat {
namespace {

constexpr float kRimOpacity = 0.85F;

/// Uses the font's path, because the names and folders that OpenImageIO searches depend on its version. If no path is
/// known, OpenImageIO searches by name.
const char* font() {
    static const std::string file = font_file().value_or("DejaVuSans");
    return file.c_str();
}

/// The result of a text function; throws Error if the font is missing.
template <typename Found>
Found found(std::optional<Found> of_text) {
    if (!of_text)
        fail(
            "overlays: the font DejaVu Sans cannot be found (Debian: fonts-dejavu-core), or OpenImageIO draws no text");
    return std::move(*of_text);
}

}  // namespace

glm::ivec2 text_size(std::string_view text, int height) {
    if (text.empty()) return {0, 0};
    return found(picture_library().text_size(std::string(text), height, font()));
}

Canvas::Canvas(const PixelBox& box, int rim)
    : box_(box),
      rim_(rim),
      width_(std::max(0, box.x1 - box.x0)),
      height_(std::max(0, box.y1 - box.y0)),
      pixels_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), glm::vec4(0)) {}

void Canvas::cover(int x, int y, double share, const glm::dvec3& color) {
    if (!(share > 0) || !box_.contains(x, y)) return;
    const auto a = static_cast<float>(std::min(share, 1.0));
    glm::vec4& pixel = pixels_[static_cast<std::size_t>(y - box_.y0) * static_cast<std::size_t>(width_) +
                               static_cast<std::size_t>(x - box_.x0)];
    pixel = pixel * (1 - a) + glm::vec4(glm::vec3(color), 1) * a;
}

void Canvas::line(const glm::dvec2& from, const glm::dvec2& to, double width, const glm::dvec3& color) {
    const double reach = width / 2 + 1;
    const glm::ivec2 low(glm::floor(glm::min(from, to) - reach)), high(glm::ceil(glm::max(from, to) + reach));
    const glm::dvec2 along = to - from;
    const double length2 = glm::dot(along, along);
    for (int y = std::max(low.y, box_.y0); y < std::min(high.y, box_.y1); ++y) {
        for (int x = std::max(low.x, box_.x0); x < std::min(high.x, box_.x1); ++x) {
            const glm::dvec2 p = glm::dvec2(x, y) + 0.5 - from;
            const double t = length2 > 0 ? std::clamp(glm::dot(p, along) / length2, 0.0, 1.0) : 0.0;
            cover(x, y, width / 2 + 0.5 - glm::length(p - t * along), color);
        }
    }
}

void Canvas::rectangle(const glm::dvec2& low, const glm::dvec2& high, const glm::dvec3& color) {
    const glm::ivec2 first(glm::floor(low)), last(glm::ceil(high));
    const auto share = [](double a, double b, int i) { return std::min(b, i + 1.0) - std::max(a, double(i)); };
    for (int y = std::max(first.y, box_.y0); y < std::min(last.y, box_.y1); ++y)
        for (int x = std::max(first.x, box_.x0); x < std::min(last.x, box_.x1); ++x)
            cover(x, y, std::max(0.0, share(low.x, high.x, x)) * std::max(0.0, share(low.y, high.y, y)), color);
}

void Canvas::text(std::string_view text, const glm::dvec2& center, int height, const glm::dvec3& color) {
    if (text.empty()) return;
    const TextMask mask = found(picture_library().text(std::string(text), height, font()));
    const glm::ivec2 corner(glm::round(center - glm::dvec2(mask.width, mask.height) / 2.0));
    std::size_t pixel = 0;
    for (int y = 0; y < mask.height; ++y)
        for (int x = 0; x < mask.width; ++x)
            cover(corner.x + x, corner.y + y, static_cast<double>(mask.coverage[pixel++]), color);
}

void Canvas::blend_into(Image& image) const {
    const auto at = [&](int x, int y) {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
    };
    std::vector<float> rim(pixels_.size(), 0);  // maximum coverage within reach
    for (int y = 0; y < height_; ++y) {
        for (int x = 0; x < width_; ++x) {
            const float covered = pixels_[at(x, y)].a;
            if (covered == 0) continue;
            for (int py = std::max(0, y - rim_); py <= std::min(height_ - 1, y + rim_); ++py)
                for (int px = std::max(0, x - rim_); px <= std::min(width_ - 1, x + rim_); ++px)
                    if ((px - x) * (px - x) + (py - y) * (py - y) <= rim_ * rim_)
                        rim[at(px, py)] = std::max(rim[at(px, py)], covered);
        }
    }
    for (int y = std::max(0, box_.y0); y < std::min(image.height, box_.y1); ++y) {
        for (int x = std::max(0, box_.x0); x < std::min(image.width, box_.x1); ++x) {
            const std::size_t i = at(x - box_.x0, y - box_.y0);
            if (rim[i] == 0) continue;
            const glm::vec4& over = pixels_[i];
            const float dark = (1 - over.a) * kRimOpacity * rim[i], left = (1 - over.a) - dark;
            for (int c = 0; c < std::min(image.channels, 3); ++c)
                image.at(x, y, c) = over[c] + left * image.at(x, y, c);
            if (image.channels == 4) image.at(x, y, 3) = over.a + dark + left * image.at(x, y, 3);
        }
    }
}

}  // namespace edgesplat
