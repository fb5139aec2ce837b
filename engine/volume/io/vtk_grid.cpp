#include "engine/volume/io/vtk_grid.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <type_traits>

#include "engine/volume/io/samples.h"

namespace edgesplat::detail {
namespace {

constexpr std::string_view kVtkBlanks = " \t\r\n\v\f";

std::string vtk_full_name(const VtkArray& array) {
    return fmt::format("{}/{}", array.of_cells ? "CellData" : "PointData", array.name);
}

// "'density' (float32), 'velocity' (float32, 3 components)".
std::string vtk_list(const std::vector<VtkArray>& arrays, const std::vector<std::size_t>& chosen) {
    std::string text;
    for (std::size_t i = 0; i < chosen.size() && i < 20; ++i) {
        const VtkArray& array = arrays[chosen[i]];
        text += fmt::format("{}{} ({}{}{})", i == 0 ? "" : ", ", array.name,
                            array.type ? name_of(*array.type) : std::string_view(array.type_name),
                            array.components > 1 ? fmt::format(", {} components", array.components) : "",
                            array.of_cells ? ", of cells" : "");
    }
    if (chosen.size() > 20) text += fmt::format(" and {} more", chosen.size() - 20);
    return text;
}

template <typename T>
bool vtk_store(std::string_view word, std::byte* to) {
    T value{};
    if constexpr (std::is_floating_point_v<T>) {
        double number = 0;
        if (!vtk_number(word, number)) return false;
        value = static_cast<T>(number);
    } else {
        if (word.starts_with('+')) word.remove_prefix(1);
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
        if (error != std::errc() || end != word.data() + word.size()) return false;
    }
    std::memcpy(to, &value, sizeof(T));
    return true;
}

using VtkStore = bool (*)(std::string_view word, std::byte* to);

VtkStore vtk_store_of(SampleType type) {
    switch (type) {
        case SampleType::Int8:
            return vtk_store<std::int8_t>;
        case SampleType::UInt8:
            return vtk_store<std::uint8_t>;
        case SampleType::Int16:
            return vtk_store<std::int16_t>;
        case SampleType::UInt16:
            return vtk_store<std::uint16_t>;
        case SampleType::Int32:
            return vtk_store<std::int32_t>;
        case SampleType::UInt32:
            return vtk_store<std::uint32_t>;
        case SampleType::Int64:
            return vtk_store<std::int64_t>;
        case SampleType::UInt64:
            return vtk_store<std::uint64_t>;
        case SampleType::Float32:
            return vtk_store<float>;
        case SampleType::Float64:
            return vtk_store<double>;
    }
    return vtk_store<double>;
}

template <typename T>
double vtk_double(const std::byte* from, bool swapped) {
    std::array<std::byte, sizeof(T)> raw{};
    std::memcpy(raw.data(), from, sizeof(T));
    if (swapped) std::reverse(raw.begin(), raw.end());
    T value{};
    std::memcpy(&value, raw.data(), sizeof(T));
    return static_cast<double>(value);
}

}  // namespace

bool is_vtk_mask(const VtkArray& array) {
    const bool bytes = array.type && size_of(*array.type) == 1 && array.components == 1;
    return bytes &&
           (array.name == "vtkGhostType" || array.name == "vtkGhostLevels" || array.name == "vtkValidPointMask");
}

bool vtk_mask_hides(const VtkArray& mask, unsigned char value) {
    constexpr unsigned kHiddenPoint = 2, kHiddenCell = 32;
    if (mask.name == "vtkValidPointMask") return value == 0;
    return mask.name == "vtkGhostType" && (value & (mask.of_cells ? kHiddenCell : kHiddenPoint)) != 0;
}

std::size_t chosen_vtk_array(const std::string& path, const LoadOptions& options, const std::vector<VtkArray>& arrays,
                             Volume& volume) {
    std::vector<std::size_t> found, scalars, shown;
    for (std::size_t i = 0; i < arrays.size(); ++i) {
        const VtkArray& array = arrays[i];
        if (options.inner == array.name || options.inner == vtk_full_name(array)) found.push_back(i);
        if (is_vtk_mask(array) || !array.type) continue;
        shown.push_back(i);
        if (array.is_scalars) scalars.push_back(i);
    }
    if (!options.inner.empty()) {
        if (found.empty() && shown.empty())
            fail("{}:{}: no such array; the file has no arrays that can be read", path, options.inner);
        if (found.empty())
            fail("{}:{}: no such array; expected one of {}", path, options.inner, vtk_list(arrays, shown));
        if (found.size() > 1)
            fail("{}:{}: {} arrays have this name; expected {}:{} or {}:{}", path, options.inner, found.size(), path,
                 vtk_full_name(arrays[found[0]]), path, vtk_full_name(arrays[found[1]]));
        // cppcheck-suppress containerOutOfBounds; fail() does not return
        return found[0];
    }
    if (shown.empty() && arrays.empty()) fail("{}: a grid without samples at its points or in its cells", path);
    if (shown.empty())
        fail("{}: array {} of type {} cannot be read; expected numbers", path, arrays[0].name, arrays[0].type_name);
    // Points go before cells, as in VTK, whatever their order in the file. ParaView marks none in the fields that it
    // writes and shows the first.
    for (auto* list : {&scalars, &shown})
        std::stable_partition(list->begin(), list->end(), [&](std::size_t i) { return !arrays[i].of_cells; });
    const std::size_t chosen = scalars.empty() ? shown[0] : scalars[0];
    const bool marked = shown.size() == 1 || !scalars.empty();
    std::erase(shown, chosen);
    if (!shown.empty())
        (marked ? volume.notes : volume.warnings)
            .push_back(fmt::format("{}The array '{}' is shown. PATH:NAME chooses another: {}.",
                                   marked ? "" : "No array is marked as the scalars. ", arrays[chosen].name,
                                   vtk_list(arrays, shown)));
    return chosen;
}

std::vector<std::size_t> vtk_dims(const std::string& path, const std::array<std::int64_t, 6>& extent, bool of_cells) {
    std::vector<std::size_t> dims;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        constexpr std::int64_t kMost = std::int64_t{1} << 31;
        const std::int64_t first = extent[2 * axis], last = extent[2 * axis + 1];
        if (first < -kMost || last > kMost || last < first)
            fail("{}: extent {} {} along {}: expected first <= last, below 2^31 in magnitude", path, first, last,
                 "xyz"[axis]);
        const auto points = static_cast<std::size_t>(last - first + 1);
        dims.push_back(of_cells ? std::max<std::size_t>(points - 1, 1) : points);
    }
    return dims;
}

void check_vtk_spacing(const std::string& path, VtkGrid& grid, Volume& volume) {
    const auto points = vtk_dims(path, grid.extent, false);
    for (int axis = 0; axis < 3; ++axis) {
        double& spacing = grid.spacing[axis];
        if (spacing == 0 && points[static_cast<std::size_t>(axis)] == 1) {
            spacing = 1;
            volume.notes.push_back(fmt::format("One slice along {} with spacing 0: 1 mm thick is assumed.",
                                               "xyz"[static_cast<std::size_t>(axis)]));
        }
        if (!(spacing > 0) || !std::isfinite(spacing))
            fail("{}: spacing {} {} {}: expected lengths above 0", path, grid.spacing.x, grid.spacing.y,
                 grid.spacing.z);
        if (!std::isfinite(grid.origin[axis]))
            fail("{}: origin {} {} {}: expected finite numbers", path, grid.origin.x, grid.origin.y, grid.origin.z);
    }
}

void set_vtk_place(const std::string& path, const VtkGrid& grid, bool of_cells, Volume& volume) {
    const auto points = vtk_dims(path, grid.extent, false), dims = vtk_dims(path, grid.extent, of_cells);
    const double volume_of_voxel = glm::determinant(grid.direction);
    if (!std::isfinite(volume_of_voxel) || std::abs(volume_of_voxel) < 1e-9)
        fail("{}: Direction with determinant {}: expected three axes that do not lie in one plane", path,
             volume_of_voxel);
    volume.geometry.dims = glm::ivec3(dims[0], dims[1], dims[2]);
    glm::dmat3 axes;
    glm::dvec3 first;
    for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        axes[axis] = grid.direction[axis] * grid.spacing[axis];
        first[axis] = static_cast<double>(grid.extent[2 * a]) + (of_cells && points[a] > 1 ? 0.5 : 0.0);
    }
    set_place(volume, axes, grid.origin + axes * first, 1, grid.source);
}

void set_vtk_coordinates(const std::string& path, int axis, const std::vector<double>& coordinates, double precision,
                         VtkGrid& grid, Volume& volume) {
    const char letter = "xyz"[static_cast<std::size_t>(axis)];
    const std::size_t count = coordinates.size();
    double most = 0;
    for (const double c : coordinates) {
        if (!std::isfinite(c)) fail("{}: coordinate {} along {}: expected finite numbers", path, c, letter);
        most = std::max(most, std::abs(c));
    }
    double step = 1;
    if (count > 1) {
        step = (coordinates.back() - coordinates.front()) / static_cast<double>(count - 1);
        // Coordinates differ from even ones by rounding alone, which is far below a voxel.
        const double tolerance = std::min(4 * precision * most + 1e-4 * std::abs(step), 0.02 * std::abs(step));
        if (step == 0 || !std::isfinite(step))
            fail("{}: coordinates along {} from {} to {}: expected ascending ones", path, letter, coordinates.front(),
                 coordinates.back());
        for (std::size_t i = 0; i < count; ++i) {
            const double even = coordinates.front() + step * static_cast<double>(i);
            if (std::abs(coordinates[i] - even) > tolerance)
                fail(
                    "{}: uneven coordinates along {}: number {} is {}, expected {} for even steps of {}; resample it "
                    "to an image, e.g. with ParaView's filter Resample To Image",
                    path, letter, i, coordinates[i], even, step);
        }
    } else {
        volume.notes.push_back(fmt::format("One slice along {}: 1 mm thick is assumed.", letter));
    }
    grid.spacing[axis] = step;
    grid.origin[axis] =
        coordinates.front() - step * static_cast<double>(grid.extent[2 * static_cast<std::size_t>(axis)]);
}

bool vtk_number(std::string_view text, double& value) {
    if (text.starts_with('+')) text.remove_prefix(1);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (end != text.data() + text.size() || text.empty()) return false;
    if (error == std::errc::result_out_of_range) value = std::strtod(std::string(text).c_str(), nullptr);
    return error == std::errc() || error == std::errc::result_out_of_range;
}

bool vtk_number(std::string_view text, std::int64_t& value) {
    if (text.starts_with('+')) text.remove_prefix(1);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size();
}

std::string_view next_vtk_word(std::string_view& text) {
    const auto is_blank = [](char c) { return kVtkBlanks.find(c) != std::string_view::npos; };
    std::size_t begin = 0;
    while (begin < text.size() && is_blank(text[begin]))
        ++begin;
    std::size_t end = begin;
    while (end < text.size() && !is_blank(text[end]))
        ++end;
    const auto word = text.substr(begin, end - begin);
    text.remove_prefix(end);
    return word;
}

std::vector<std::byte> vtk_text_samples(const std::string& path, const std::string& what, SampleType type,
                                        std::size_t count, std::string_view& text) {
    // A number and its blank take two characters.
    if (count / 2 > text.size())
        fail("{}: {}: truncated: {} characters for {} numbers", path, what, text.size(), count);
    const std::size_t size = size_of(type);
    const VtkStore store = vtk_store_of(type);
    std::vector<std::byte> samples(count * size);
    for (std::size_t i = 0; i < count; ++i) {
        const auto word = next_vtk_word(text);
        if (word.empty()) fail("{}: {}: truncated: {} of {} numbers", path, what, i, count);
        if (!store(word, samples.data() + i * size))
            fail("{}: {}: '{}' is no {}", path, what, tidy(word.substr(0, 40)), name_of(type));
    }
    return samples;
}

std::vector<double> vtk_doubles(SampleType type, const std::byte* samples, std::size_t count, bool swapped) {
    const auto all = [&](auto convert) {
        std::vector<double> numbers(count);
        for (std::size_t i = 0; i < count; ++i)
            numbers[i] = convert(samples + i * size_of(type), swapped);
        return numbers;
    };
    switch (type) {
        case SampleType::Int8:
            return all(vtk_double<std::int8_t>);
        case SampleType::UInt8:
            return all(vtk_double<std::uint8_t>);
        case SampleType::Int16:
            return all(vtk_double<std::int16_t>);
        case SampleType::UInt16:
            return all(vtk_double<std::uint16_t>);
        case SampleType::Int32:
            return all(vtk_double<std::int32_t>);
        case SampleType::UInt32:
            return all(vtk_double<std::uint32_t>);
        case SampleType::Int64:
            return all(vtk_double<std::int64_t>);
        case SampleType::UInt64:
            return all(vtk_double<std::uint64_t>);
        case SampleType::Float32:
            return all(vtk_double<float>);
        case SampleType::Float64:
            return all(vtk_double<double>);
    }
    return {};
}

}  // namespace edgesplat::detail
