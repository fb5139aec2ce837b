#include "engine/measure/extents.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <set>

#include "engine/error.h"
#include "engine/measure/field_lines.h"
#include "engine/scene/clip_planes.h"
#include "engine/viewer/contour.h"
#include "engine/volume/filters.h"
#include "engine/volume/labels.h"
#include "engine/volume/packed_volume.h"
#include "engine/volume/parallel.h"

namespace edgesplat::measure {
namespace {

constexpr int kLines = 2;           ///< lines along each side of a voxel
constexpr int kEstimateStride = 4;  ///< one in so many lines along either side estimates the uncertainty of values
constexpr double kShift = 0.1;  ///< share of the values' uncertainty by which iso-values are shifted to find its effect

/// Sums over the lines of one axis, for one iso-value.
struct Sums {
    double above = 0;           ///< length with values from the iso-value up, voxels
    double surface = 0;         ///< mm^2, area with the slope over a voxel
    double rough = 0;           ///< mm^2, area of the spline's contour itself
    double uncertainty = 0;     ///< uncertainty of values, weighted by area
    double estimated_area = 0;  ///< area where the uncertainty was estimated
    void add(const Sums& other) {
        above += other.above;
        surface += other.surface;
        rough += other.rough;
        uncertainty += other.uncertainty;
        estimated_area += other.estimated_area;
    }
};

/// Sums over all lines: [iso-value][axis].
using AxisSums = std::vector<std::array<Sums, 3>>;

/// Length of [first, last].
double kept_length(const std::array<KeptPiece, 2>& pieces, double first, double last) {
    double length = 0;
    for (const KeptPiece& piece : pieces)
        length += std::max(0.0, std::min(last, piece.last) - std::max(first, piece.first));
    return length;
}

/// Whether the voxel nearest to a position in index space contains data.
bool has_data_at(const Volume& volume, const glm::dvec3& at) {
    return volume.has_data(glm::clamp(glm::ivec3(glm::round(at)), glm::ivec3(0), volume.geometry.dims - 1));
}

/// The part of [first, last] on a line along an axis that is kept and whose samples contain data.
double matter_length(const Volume& volume, const std::array<KeptPiece, 2>& pieces, glm::dvec3 at, int axis,
                     double first, double last) {
    if (!volume.no_data) return kept_length(pieces, first, last);
    double length = 0;
    for (double from = first; from < last;) {
        const double to = std::min(last, std::floor(from + 0.5) + 0.5);
        at[axis] = (from + to) / 2;
        if (has_data_at(volume, at)) length += kept_length(pieces, from, to);
        from = to;
    }
    return length;
}

class Measurement {
  public:
    Measurement(const Volume& volume, const Clip& clip)
        : volume_(volume),
          geometry_(volume.geometry),
          samples_{volume.geometry.dims, volume.values, {}},
          clip_(index_clip(clip, volume.geometry)) {
        to_world_normal_ = glm::transpose(glm::inverse(geometry_.index_to_world_axes));
        cell_ = std::abs(glm::determinant(geometry_.index_to_world_axes)) / (kLines * kLines);
    }

    /// `estimate`: also estimates the uncertainty of values.
    AxisSums along_all_lines(const reference::Field& field, std::span<const double> iso_values, bool estimate,
                             const std::function<void(double)>& progress) const {
        AxisSums sums(iso_values.size());
        for (int axis = 0; axis < 3; ++axis) {
            // Adjacent lines along the faster of the other two axes share cached samples.
            const int fast = axis == 0 ? 1 : 0, slow = axis == 2 ? 1 : 2;
            const int rows = geometry_.dims[slow] * kLines;
            std::vector<std::vector<Sums>> of_row(static_cast<std::size_t>(rows));
            parallel_for(rows, [&](int begin, int end) {
                FieldLine line(field, axis);
                const viewer::Samples samples(volume_);
                for (int row = begin; row < end; ++row) {
                    std::vector<Sums> found(iso_values.size());
                    for (int i = 0; i < geometry_.dims[fast] * kLines; ++i) {
                        glm::dvec3 start(0);
                        start[fast] = (i + 0.5) / kLines - 0.5;
                        start[slow] = (row + 0.5) / kLines - 0.5;
                        line.move_to(start);
                        const bool estimates = estimate && i % kEstimateStride == 0 && row % kEstimateStride == 0;
                        add_line(line, iso_values, estimates ? &samples : nullptr, found);
                    }
                    of_row[static_cast<std::size_t>(row)] = std::move(found);
                }
            });
            for (const auto& row : of_row)
                for (std::size_t j = 0; j < iso_values.size(); ++j)
                    sums[j][static_cast<std::size_t>(axis)].add(row[j]);
            progress((axis + 1) / 3.0);
        }
        return sums;
    }

    /// Volume with values from the iso-value up, mm^3; the uncertainty is half the range of the three axes.
    Quantity above(const std::array<Sums, 3>& sums) const {
        const auto [least, most] = std::minmax({sums[0].above, sums[1].above, sums[2].above});
        return {cell_ * (sums[0].above + sums[1].above + sums[2].above) / 3, cell_ * (most - least) / 2};
    }

    double kept_volume() const {
        double length = 0;
        for (int y = 0; y < geometry_.dims.y * kLines; ++y)
            for (int z = 0; z < geometry_.dims.z * kLines; ++z) {
                const glm::dvec3 start(0, (y + 0.5) / kLines - 0.5, (z + 0.5) / kLines - 0.5);
                length +=
                    matter_length(volume_, clip_.kept_along(start, {1, 0, 0}), start, 0, -0.5, geometry_.dims.x - 0.5);
            }
        return cell_ * length;
    }

  private:
    void add_line(FieldLine& line, std::span<const double> iso_values, const viewer::Samples* samples,
                  std::vector<Sums>& found) const {
        const int axis = line.axis();
        glm::dvec3 u(0);
        u[axis] = 1;
        const auto pieces = clip_.kept_along(line.at(0), u);
        const double last = geometry_.dims[axis] - 0.5;
        for (std::size_t j = 0; j < iso_values.size(); ++j) {
            Sums& sums = found[j];
            double from = -0.5;
            bool inside = line.starts_from(iso_values[j]);
            line.for_crossings(iso_values[j], [&](double t) {
                if (inside) sums.above += matter_length(volume_, pieces, line.at(0), axis, from, t);
                from = t;
                inside = !inside;
                if (std::ranges::any_of(pieces, [&](const KeptPiece& p) { return p.first <= t && t < p.last; }) &&
                    between_data(line, t))
                    add_crossing(line, t, samples, sums);
            });
            if (inside) sums.above += matter_length(volume_, pieces, line.at(0), axis, from, last);
        }
    }

    /// The end of the data is no surface.
    bool between_data(const FieldLine& line, double t) const {
        return !volume_.no_data ||
               (has_data_at(volume_, line.at(std::floor(t))) && has_data_at(volume_, line.at(std::floor(t) + 1)));
    }

    void add_crossing(const FieldLine& line, double t, const viewer::Samples* samples, Sums& sums) const {
        const double area = area_of_crossing(point_gradient(samples_, line.at(t)), line.axis());
        sums.surface += area;
        if (line.follows_spline()) sums.rough += area_of_crossing(line.slope(t), line.axis());
        if (samples == nullptr) return;
        sums.estimated_area += area;
        sums.uncertainty += area * viewer::value_uncertainty(*samples, line.at(t));
    }

    /// A surface with gradient g is crossed by |g_axis| / (|S^-T g| cell) lines along the axis per mm^2. Each axis is
    /// weighted by g_axis^2 / |g|^2, so that grazing lines have little weight. The number of crossings cannot
    /// distinguish steps from slopes: the slope over a voxel ignores the voxel steps of binary data.
    double area_of_crossing(const glm::dvec3& g, int axis) const {
        const double square = glm::dot(g, g);
        return square > 0 ? cell_ * std::abs(g[axis]) * glm::length(to_world_normal_ * g) / square : 0;
    }

    const Volume& volume_;
    const VolumeGeometry& geometry_;
    reference::Field samples_;
    IndexClip clip_;
    glm::dmat3 to_world_normal_{1};
    double cell_ = 1;  ///< mm^3 per voxel length of a line
};

double surface_of(const std::array<Sums, 3>& sums) {
    return sums[0].surface + sums[1].surface + sums[2].surface;
}

double roughness_of(const std::array<Sums, 3>& sums) {
    return std::abs(sums[0].rough + sums[1].rough + sums[2].rough - surface_of(sums));
}

}  // namespace

Extents measure_extents(const Volume& volume, std::span<const double> iso_values, const Clip& clip,
                        const reference::Progress& progress) {
    require_samples(volume, "measuring volumes and surfaces");
    const std::vector<float> coefficients = bspline_coefficients(volume.values, volume.geometry.dims);
    const reference::Field linear{volume.geometry.dims, volume.values, {}};
    const reference::Field cubic{volume.geometry.dims, volume.values, coefficients};
    const auto part = [&](double first) {
        return [&progress, first](double done) {
            if (progress && !progress(first + done / 3)) throw reference::Cancelled("measuring was stopped");
        };
    };
    const Measurement measurement(volume, clip);
    const AxisSums cubic_sums = measurement.along_all_lines(cubic, iso_values, false, part(0));
    const AxisSums linear_sums = measurement.along_all_lines(linear, iso_values, true, part(1.0 / 3));

    std::vector<double> shifted;
    for (std::size_t j = 0; j < iso_values.size(); ++j) {
        Sums all;
        for (const Sums& sums : linear_sums[j])
            all.add(sums);
        const double shift = all.estimated_area > 0 ? kShift * all.uncertainty / all.estimated_area : 0;
        shifted.insert(shifted.end(), {iso_values[j] - shift, iso_values[j] + shift});
    }
    const AxisSums shifted_sums = measurement.along_all_lines(linear, shifted, false, part(2.0 / 3));

    const double whole = measurement.kept_volume();
    Extents extents;
    Quantity beyond{whole, 0};  // volume from the previous iso-value up
    for (std::size_t j = 0; j < iso_values.size(); ++j) {
        const std::array<Sums, 3>&low = shifted_sums[2 * j], &high = shifted_sums[2 * j + 1];
        const double shift_volume = measurement.above(low).value - measurement.above(high).value;
        Quantity above = measurement.above(cubic_sums[j]);
        above.uncertainty +=
            2 * std::abs(above.value - measurement.above(linear_sums[j]).value) + std::abs(shift_volume) / (2 * kShift);
        extents.volumes.push_back({beyond.value - above.value, beyond.uncertainty + above.uncertainty});
        beyond = above;
        const double surface = surface_of(cubic_sums[j]);
        extents.surfaces.push_back({surface, 2 * std::abs(surface - surface_of(linear_sums[j])) +
                                                 std::abs(surface_of(low) - surface_of(high)) / (2 * kShift) +
                                                 roughness_of(cubic_sums[j])});
    }
    extents.volumes.push_back(beyond);
    return extents;
}

namespace {

/// The share of a voxel that clip planes keep.
class KeptShare {
  public:
    explicit KeptShare(const IndexClip& clip) : clip_(clip) {}

    double of(const glm::dvec3& voxel) const {
        if (clip_.empty()) return 1;
        const IndexPlane* cutting = nullptr;
        int cuts = 0;
        const auto look = [&](const std::vector<IndexPlane>& planes) {
            for (const IndexPlane& plane : planes)
                if (std::abs(plane.distance(voxel)) < half_width(plane)) {
                    cutting = &plane;
                    ++cuts;
                }
        };
        look(clip_.keep);
        look(clip_.remove);
        if (cuts == 0) return clip_.cuts_away(voxel) ? 0 : 1;
        if (cuts == 1 && clip_.remove.empty()) {
            const bool kept = std::ranges::all_of(
                clip_.keep, [&](const IndexPlane& plane) { return &plane == cutting || plane.distance(voxel) <= 0; });
            return kept ? share_below(*cutting, voxel) : 0;
        }
        constexpr int kPoints = 8;  // along each side
        int kept = 0;
        for (int z = 0; z < kPoints; ++z)
            for (int y = 0; y < kPoints; ++y)
                for (int x = 0; x < kPoints; ++x)
                    kept += clip_.cuts_away(voxel + (glm::dvec3(x, y, z) + 0.5) / double{kPoints} - 0.5) ? 0 : 1;
        return kept / std::pow(kPoints, 3);
    }

  private:
    static double half_width(const IndexPlane& plane) {
        const glm::dvec3 n = glm::abs(plane.normal);
        return 0.5 * (n.x + n.y + n.z);
    }

    /// Share of the unit cube on the near side of a plane that cuts it: by inclusion and exclusion of corners.
    static double share_below(const IndexPlane& plane, const glm::dvec3& voxel) {
        constexpr double kSmall = 1e-9;
        const glm::dvec3 n = glm::max(glm::abs(plane.normal), kSmall);
        const double d = 0.5 * (n.x + n.y + n.z) - plane.distance(voxel);
        const bool flat = std::min({n.x, n.y, n.z}) < 1e-4;
        if (flat) {
            // Nearly parallel to an axis, where the formula below cancels: a mean over lines along the largest
            // component.
            const int axis = n.x >= n.y && n.x >= n.z ? 0 : n.y >= n.z ? 1 : 2;
            constexpr int kLinesAcross = 32;
            double sum = 0;
            for (int i = 0; i < kLinesAcross; ++i)
                for (int j = 0; j < kLinesAcross; ++j)
                    sum += std::clamp((d - n[(axis + 1) % 3] * (i + 0.5) / kLinesAcross -
                                       n[(axis + 2) % 3] * (j + 0.5) / kLinesAcross) /
                                          n[axis],
                                      0.0, 1.0);
            return sum / (kLinesAcross * kLinesAcross);
        }
        const auto cube = [](double v) { return v > 0 ? v * v * v : 0; };
        double sum = 0;
        for (int corner = 0; corner < 8; ++corner) {
            const glm::dvec3 c(corner & 1, corner >> 1 & 1, corner >> 2);
            const int bits = (corner & 1) + (corner >> 1 & 1) + (corner >> 2);
            sum += (bits % 2 == 0 ? 1 : -1) * cube(d - glm::dot(n, c));
        }
        return std::clamp(sum / (6 * n.x * n.y * n.z), 0.0, 1.0);
    }

    const IndexClip& clip_;
};

/// A table of all distinct samples.
std::shared_ptr<const LabelTable> table_of_values(const Volume& volume) {
    const std::set<float> values(volume.values.begin(), volume.values.end());
    auto table = std::make_shared<LabelTable>();
    for (const float value : values)
        table->labels.push_back({0, value, {}, {}});
    return table;
}

}  // namespace

std::vector<LabelExtent> measure_labels(const Volume& volume, const Clip& clip) {
    if (volume.packed && volume.labels) return measure_labels(load_level(volume, 0), clip);
    require_samples(volume, "measuring labels");
    const glm::ivec3 dims = volume.geometry.dims;
    const double voxel = std::abs(glm::determinant(volume.geometry.index_to_world_axes));
    const auto known = labels_of(volume);
    const auto table = known ? known : table_of_values(volume);
    std::vector<std::uint32_t> drawn;
    if (!volume.shown_labels) {
        for (std::size_t at = 0; at < volume.values.size(); ++at)
            drawn.push_back(volume.no_data && (*volume.no_data)[at]
                                ? 0
                                : static_cast<std::uint32_t>(place_of_label(*table, volume.values[at])) + 1);
    }
    const bool of_scan = volume.has_segmentation();
    const auto low = static_cast<double>(volume.min_value);
    const std::vector<std::uint32_t>& numbers = volume.shown_labels ? volume.shown_labels->at : drawn;
    struct Count {
        std::size_t voxels = 0;
        double kept = 0, beside_others = 0;
        double with_data = 0, sum = 0, squares = 0;  // of samples, relative to the volume's smallest
    };
    std::vector<Count> counts(table->labels.size() + 1);
    const IndexClip planes = index_clip(clip, volume.geometry);
    const KeptShare share(planes);
    const auto row = static_cast<std::size_t>(dims.x), slice = row * static_cast<std::size_t>(dims.y);
    std::size_t at = 0;
    for (int z = 0; z < dims.z; ++z)
        for (int y = 0; y < dims.y; ++y)
            for (int x = 0; x < dims.x; ++x, ++at) {
                const std::uint32_t number = numbers[at];
                if (number == 0) continue;
                const double kept = share.of({x, y, z});
                if (!(kept > 0)) continue;
                Count& count = counts[number];
                count.kept += kept;
                if (!planes.cuts_away({x, y, z})) ++count.voxels;
                if (of_scan && volume.has_data(at)) {
                    const double value = static_cast<double>(volume.values[at]) - low;
                    count.with_data += kept;
                    count.sum += kept * value;
                    count.squares += kept * value * value;
                }
                const bool beside =
                    (x > 0 && numbers[at - 1] != number) || (x + 1 < dims.x && numbers[at + 1] != number) ||
                    (y > 0 && numbers[at - row] != number) || (y + 1 < dims.y && numbers[at + row] != number) ||
                    (z > 0 && numbers[at - slice] != number) || (z + 1 < dims.z && numbers[at + slice] != number);
                if (beside) count.beside_others += kept;
            }
    std::vector<LabelExtent> extents;
    for (std::size_t place = 0; place < table->labels.size(); ++place) {
        const Count& count = counts[place + 1];
        if (!(count.kept > 0)) continue;
        const Label& label = table->labels[place];
        extents.push_back({label,
                           known ? table->number_of(label) : fmt::format("{}", label.value),
                           count.voxels,
                           {voxel * count.kept, voxel * count.beside_others / 2},
                           {}});
        if (!(count.with_data > 0)) continue;
        const double mean = count.sum / count.with_data;
        const double deviation = std::sqrt(std::max(count.squares / count.with_data - mean * mean, 0.0));
        extents.back().values = {volume.in_file_unit(low + mean), volume.in_file_unit(deviation)};
    }
    return extents;
}

}  // namespace edgesplat::measure
