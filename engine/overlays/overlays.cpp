#include "engine/overlays/overlays.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/scene/label_choice.h"
#include "engine/scene/views.h"
#include "engine/volume/value_text.h"

namespace edgesplat {
namespace {

const glm::dvec3 kInk(0.95);
const std::array<glm::dvec3, 3> kAxisColors{{{1, 0.16, 0.12}, {0.2, 0.85, 0.2}, {0.25, 0.5, 1}}};

/// Sizes of all overlay elements, in pixels.
struct Measures {
    int letters;  ///< height of the text
    int margin, rim;
    double stroke;  ///< width of a line
    explicit Measures(const Image& image)
        : letters(std::max(10, static_cast<int>(std::lround(0.035 * image.height)))),
          margin(std::max(2, letters / 2)),
          rim(std::max(1, letters / 10)),
          stroke(std::max(1.5, 0.13 * letters)) {}
};

void draw_marker(Canvas& canvas, const glm::dvec2& center, double radius, const Measures& size,
                 const std::array<MarkerAxis, 3>& axes) {
    struct End {
        double towards_eye;
        glm::dvec2 along;
        glm::dvec3 color;
        const std::string* letter;
        bool positive;
    };
    std::vector<End> ends;
    for (std::size_t i = 0; i < 3; ++i) {
        ends.push_back({axes[i].towards_eye, axes[i].along, kAxisColors[i], &axes[i].positive, true});
        ends.push_back({-axes[i].towards_eye, -axes[i].along, kAxisColors[i], &axes[i].negative, false});
    }
    std::sort(ends.begin(), ends.end(), [](const End& a, const End& b) { return a.towards_eye < b.towards_eye; });
    for (const End& end : ends) {
        const double faded = 0.65 + 0.35 * end.towards_eye;  // ends that point away are darker
        canvas.line(center, center + radius * end.along, (end.positive ? 1.0 : 0.5) * size.stroke, end.color * faded);
    }
    for (const End& end : ends) {
        // The letters of an axis seen end-on would overlap: only the nearer one is drawn.
        const double length = glm::length(end.along);
        if (end.letter->empty() || (length < 0.3 && end.towards_eye < 0)) continue;
        const glm::dvec2 outwards = length > 1e-9 ? end.along / length : glm::dvec2(0);
        canvas.text(*end.letter, center + radius * end.along + 0.62 * size.letters * outwards, size.letters, kInk);
    }
}

std::string range_text(const std::vector<std::string>& iso, std::size_t material) {
    if (iso.empty()) return "";
    if (material == 0) return fmt::format("below {}", iso.front());
    if (material == iso.size()) return fmt::format("from {}", iso.back());
    return fmt::format("{} to {}", iso[material - 1], iso[material]);
}

/// Range of the volume's values in the file's unit.
double range_of(const Volume& volume) {
    return volume.in_file_unit(static_cast<double>(volume.max_value) - static_cast<double>(volume.min_value));
}

struct LegendRow {
    glm::dvec3 color;
    std::string text;
};

std::vector<LegendRow> material_rows(const Scene& scene, const Volume& volume) {
    std::vector<double> values = scene.iso_values;
    for (double& value : values)
        value = volume.in_file_unit(value);
    const std::vector<std::string> iso = value_texts(values, range_of(volume));
    std::vector<LegendRow> rows;
    for (std::size_t m = scene.materials.size(); m-- > 0;) {
        const Material& material = scene.materials[m];
        if (!(material.extinction > 0)) continue;
        const std::string range = range_text(iso, m);
        rows.push_back({material.color, material.name.empty() ? range : material.name + "  " + range});
    }
    return rows;
}

/// The largest labels, by number and name, as many as fit into `most` rows.
std::vector<LegendRow> label_rows(const Scene& scene, const Volume& volume, std::size_t most) {
    std::vector<LegendRow> rows;
    const LabelTable& table = *volume.labels;
    const std::vector<std::uint32_t>& largest = volume.shown_labels->largest;
    const std::size_t shown = largest.size() > most ? most - 1 : largest.size();
    for (std::size_t i = 0; i < shown; ++i)
        rows.push_back({scene.label_colors[largest[i] - 1], text_of(table, table.labels[largest[i] - 1])});
    if (shown < largest.size()) rows.push_back({glm::dvec3(0), fmt::format("and {} more", largest.size() - shown)});
    return rows;
}

Canvas swatch_legend(const std::vector<LegendRow>& rows, const Measures& size) {
    int widest = 0;
    for (const LegendRow& row : rows)
        widest = std::max(widest, text_size(row.text, size.letters).x);
    const int step = size.letters * 3 / 2, left = size.margin + size.rim, gap = size.letters / 2;
    Canvas canvas({0, 0, 2 * left + size.letters + gap + widest + 4, 2 * left + step * static_cast<int>(rows.size())},
                  size.rim);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const double middle = left + step * (static_cast<double>(i) + 0.5);
        canvas.rectangle({left, middle - 0.5 * size.letters}, {left + size.letters, middle + 0.5 * size.letters},
                         rows[i].color);
        canvas.text(rows[i].text,
                    {left + size.letters + gap + text_size(rows[i].text, size.letters).x / 2.0 + 1, middle},
                    size.letters, kInk);
    }
    return canvas;
}

/// Plots extinction over value in the transfer function's colours, with ticks at round values.
Canvas transfer_legend(const Scene& scene, const Volume& volume, const Measures& size) {
    std::vector<TransferPoint> points = scene.transfer;
    for (TransferPoint& point : points)
        point.value = volume.in_file_unit(point.value);
    const double first = points.front().value, last = points.back().value, range = std::max(last - first, 1e-300);
    double most = 0;
    for (const TransferPoint& p : points)
        most = std::max(most, p.extinction);
    const int left = size.margin + size.rim + size.letters, width = 9 * size.letters, height = 2 * size.letters;
    Canvas canvas({0, 0, 2 * left + width, left + height + 2 * size.letters + size.margin}, size.rim);
    const double bottom = left + height;
    for (int x = 0; x < width; ++x) {
        const double value = first + range * (x + 0.5) / width;
        std::size_t i = 1;
        while (i + 1 < points.size() && points[i].value < value)
            ++i;
        const TransferPoint &a = points[points.size() > 1 ? i - 1 : 0], &b = points[points.size() > 1 ? i : 0];
        const double t = b.value > a.value ? std::clamp((value - a.value) / (b.value - a.value), 0.0, 1.0) : 0.0;
        const double extinction = glm::mix(a.extinction, b.extinction, t);
        const double tall = std::max(most > 0 ? extinction / most * height : 0.0, size.stroke);
        canvas.rectangle({left + x, bottom - tall}, {left + x + 1, bottom}, glm::mix(a.color, b.color, t));
    }
    // Round steps, about three of them.
    double step = std::pow(10.0, std::floor(std::log10(range / 2)));
    for (const double factor : {5.0, 2.0})
        if (range / (step * factor) >= 2) {
            step *= factor;
            break;
        }
    for (double value = std::ceil(first / step - 1e-9) * step; value <= last + 1e-9 * range; value += step) {
        const double x = left + (value - first) / range * width;
        canvas.line({x, bottom}, {x, bottom + size.letters / 3.0}, size.stroke / 2, kInk);
        const std::string label = value_text(std::abs(value) < 1e-9 * step ? 0.0 : value, range);
        canvas.text(label, {x, bottom + 1.1 * size.letters}, size.letters * 3 / 4, kInk);
    }
    return canvas;
}

}  // namespace

std::array<MarkerAxis, 3> marker_axes(const Volume& volume, const Camera& camera) {
    const CameraFrame frame = camera_frame(camera);
    const glm::dmat3 axes = volume.in_patient ? glm::dmat3(1) : volume_axes(volume.geometry);
    std::array<MarkerAxis, 3> marker;
    for (int i = 0; i < 3; ++i) {
        MarkerAxis& axis = marker[static_cast<std::size_t>(i)];
        axis.along = {glm::dot(axes[i], frame.right), -glm::dot(axes[i], frame.up)};
        axis.towards_eye = -glm::dot(axes[i], frame.forward);
        axis.positive = std::string(1, volume.in_patient ? patient_letter(axes[i]) : "XYZ"[i]);
        if (volume.in_patient) axis.negative = std::string(1, patient_letter(-axes[i]));
    }
    return marker;
}

std::optional<ScaleBar> scale_bar(const Volume& volume, const Camera& camera, int height, double most) {
    const CameraFrame frame = camera_frame(camera);
    const glm::dvec3 center = volume.geometry.center();
    const double depth = glm::dot(center - frame.eye, frame.forward);
    if (!(depth > 0)) return {};
    return scale_bar(2 * depth * frame.tan_half_y / height, most);
}

std::optional<ScaleBar> scale_bar(double mm_per_pixel, double most) {
    const double pixels_per_mm = 1 / mm_per_pixel, longest = most * mm_per_pixel;
    if (!(longest > 0) || !std::isfinite(longest)) return {};
    const double power = std::pow(10.0, std::floor(std::log10(longest)));
    for (const double factor : {5.0, 2.0, 1.0})
        if (factor * power <= longest) return ScaleBar{factor * power, factor * power * pixels_per_mm};
    return ScaleBar{power / 2, power / 2 * pixels_per_mm};  // if the logarithm was rounded up
}

std::vector<PixelBox> draw_overlays(Image& image, const Volume& volume, const Scene& scene, const Camera& camera) {
    const Overlays& overlays = scene.effects.overlays;
    const Measures size(image);
    std::vector<PixelBox> boxes;
    const auto lay = [&](const Canvas& canvas) {
        canvas.blend_into(image);
        const PixelBox& b = canvas.box();
        boxes.push_back(
            {std::max(b.x0, 0), std::max(b.y0, 0), std::min(b.x1, image.width), std::min(b.y1, image.height)});
    };
    if (overlays.orientation) {
        const int radius = std::max(14, static_cast<int>(std::lround(0.08 * image.height)));
        const int half = radius + 3 * size.letters / 2 + size.rim;
        Canvas canvas({0, image.height - 2 * half, 2 * half, image.height}, size.rim);
        draw_marker(canvas, glm::dvec2(half, image.height - half), radius, size, marker_axes(volume, camera));
        lay(canvas);
    }
    if (overlays.scale_bar) {
        const double most = 0.25 * std::min(image.width, 2 * image.height);
        if (const auto bar = scale_bar(volume, camera, image.height, most)) {
            const std::string label = fmt::format("{:g} mm", bar->millimetres);
            const glm::ivec2 text = text_size(label, size.letters);
            const int width = std::max(static_cast<int>(std::ceil(bar->pixels)), text.x + 2);
            const int inset = size.margin + size.rim + 1;
            const double right = image.width - inset - (width - bar->pixels) / 2,
                         y = image.height - inset - size.stroke;
            const double tick = 0.3 * size.letters;
            Canvas canvas({image.width - width - 2 * inset, image.height - 2 * inset - 2 * size.letters, image.width,
                           image.height},
                          size.rim);
            canvas.rectangle({right - bar->pixels, y - size.stroke / 2}, {right, y + size.stroke / 2}, kInk);
            for (const double x : {right - bar->pixels, right - size.stroke / 2})
                canvas.rectangle({x, y - tick}, {x + size.stroke / 2, y + size.stroke / 2}, kInk);
            canvas.text(label, {right - bar->pixels / 2, y - tick - 0.6 * size.letters - size.rim}, size.letters, kInk);
            lay(canvas);
        }
    }
    if (overlays.legend && volume.shown_labels && !scene.label_colors.empty()) {
        constexpr double kMostHeight = 0.8;  // of the picture
        const double rows = kMostHeight * image.height / (size.letters * 1.5);
        lay(swatch_legend(label_rows(scene, volume, static_cast<std::size_t>(std::max(rows, 2.0))), size));
    } else if (overlays.legend) {
        lay(scene.transfer.empty() ? swatch_legend(material_rows(scene, volume), size)
                                   : transfer_legend(scene, volume, size));
    }
    return boxes;
}

}  // namespace edgesplat
