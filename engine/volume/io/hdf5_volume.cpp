// Reads an array of an HDF5 file. HDF5 defines no geometry; attributes that programs write are understood: ITK's image
// group, VTKHDF image data, Imaris, and spacing attributes beside the array (ilastik, Fiji's HDF5 plugin, h5py users).
#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>

#include "engine/volume/io/arrays.h"
#include "engine/volume/io/hdf5.h"
#include "engine/volume/io/readers.h"
#include "engine/volume/io/samples.h"
#include "engine/volume/packed_internal.h"

namespace edgesplat::detail {
namespace {

struct Hdf5Place {
    glm::dmat3 axes{1};  // columns: steps of one voxel
    glm::dvec3 origin{0};
    double millimetres = 1;
    std::string source, unit;
    bool in_patient = false;
};

std::string parent_of(const std::string& path) {
    const auto slash = path.rfind('/');
    return slash == 0 || slash == std::string::npos ? "/" : path.substr(0, slash);
}

std::optional<std::vector<double>> numbers_in(const Hdf5File& file, const std::string& dataset, std::size_t count) {
    if (!file.has(dataset)) return std::nullopt;
    const Hdf5Dataset data = file.dataset(dataset);
    std::uint64_t total = 1;
    for (const auto n : data.extent())
        total *= std::min<std::uint64_t>(n, 4096);
    if (total != count) return std::nullopt;
    std::vector<double> values(count);
    data.read(Hdf5Extent(data.extent().size(), 0), data.extent(), SampleType::Float64, values.data());
    return values;
}

// /ITKImage/N/VoxelData with Directions, Origin and Spacing beside it, all in ITK's order x, y, z.
std::optional<Hdf5Place> place_of_itk(const Hdf5File& file, const std::string& array) {
    if (!array.ends_with("/VoxelData")) return std::nullopt;
    const std::string group = parent_of(array);
    const auto spacing = numbers_in(file, group + "/Spacing", 3), origin = numbers_in(file, group + "/Origin", 3),
               directions = numbers_in(file, group + "/Directions", 9);
    if (!spacing || !origin || !directions) return std::nullopt;
    Hdf5Place place{.source = "Directions, Origin and Spacing of ITKImage", .unit = {}, .in_patient = true};
    for (int column = 0; column < 3; ++column) {
        place.origin[column] = (*origin)[static_cast<std::size_t>(column)];
        for (int row = 0; row < 3; ++row)  // row by row
            place.axes[column][row] = (*directions)[static_cast<std::size_t>(3 * row + column)] *
                                      (*spacing)[static_cast<std::size_t>(column)];
    }
    return place;
}

// /VTKHDF with Type "ImageData".
std::optional<Hdf5Place> place_of_vtkhdf(const std::string& path, const Hdf5File& file, const std::string& array) {
    if (!array.starts_with("/VTKHDF/PointData/") && !array.starts_with("/VTKHDF/CellData/")) return std::nullopt;
    if (file.find_text("/VTKHDF", "Type").value_or("") != "ImageData")
        fail("{}: {}: VTKHDF data of Type '{}', expected ImageData (attribute Type of /VTKHDF)", path, array,
             file.find_text("/VTKHDF", "Type").value_or(""));
    const auto spacing = file.find_numbers("/VTKHDF", "Spacing"), origin = file.find_numbers("/VTKHDF", "Origin"),
               extent = file.find_numbers("/VTKHDF", "WholeExtent");
    if (!spacing || spacing->size() != 3 || !origin || origin->size() != 3 || !extent || extent->size() != 6)
        return std::nullopt;
    const auto directions =
        file.find_numbers("/VTKHDF", "Direction").value_or(std::vector<double>{1, 0, 0, 0, 1, 0, 0, 0, 1});
    if (directions.size() != 9) return std::nullopt;
    Hdf5Place place{.source = "Origin, Spacing and Direction of VTKHDF", .unit = {}};
    glm::dvec3 first(0);
    for (int column = 0; column < 3; ++column) {
        const auto c = static_cast<std::size_t>(column);
        place.origin[column] = (*origin)[c];
        first[column] = (*extent)[2 * c] + (array.starts_with("/VTKHDF/CellData/") ? 0.5 : 0.0);
        for (int row = 0; row < 3; ++row)
            place.axes[column][row] = directions[static_cast<std::size_t>(3 * row + column)] * (*spacing)[c];
    }
    place.origin += place.axes * first;
    return place;
}

constexpr const char* kImarisImage = "/DataSetInfo/Image";

bool is_imaris(const Hdf5File& file, const std::string& array, const Hdf5Extent& extent) {
    return array.starts_with("/DataSet/ResolutionLevel") && extent.size() == 3 && file.has(kImarisImage);
}

// Imaris pads arrays to whole chunks. Says how much of them is the image: the attributes ImageSizeX, Y and Z of the
// array's channel, or X, Y and Z of the image for the first level.
Hdf5Extent size_of_imaris(const std::string& path, const Hdf5File& file, const std::string& array, Hdf5Extent extent) {
    const std::string channel = parent_of(array);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const char letter = "ZYX"[axis];
        std::string object = channel, name = fmt::format("ImageSize{}", letter);
        auto text = file.find_text(object, name);
        if (!text && array.starts_with("/DataSet/ResolutionLevel 0/"))
            text = file.find_text(object = kImarisImage, name = std::string(1, letter));
        if (!text) continue;
        std::uint64_t size = 0;
        const auto [end, error] = std::from_chars(text->data(), text->data() + text->size(), size);
        if (error != std::errc() || end != text->data() + text->size() || size < 1 || size > extent[axis])
            fail("{}: attribute {} of {} is '{}', expected a whole number from 1 to {}, the size of the array", path,
                 name, object, *text, extent[axis]);
        extent[axis] = size;
    }
    return extent;
}

// Imaris: the box of the image in /DataSetInfo/Image, as texts. `extent`: without padding.
std::optional<Hdf5Place> place_of_imaris(const Hdf5File& file, const std::string& array, const Hdf5Extent& extent) {
    if (!is_imaris(file, array, extent)) return std::nullopt;
    Hdf5Place place{.source = "ExtMin and ExtMax of DataSetInfo/Image",
                    .unit = file.find_text(kImarisImage, "Unit").value_or("um")};
    const auto millimetres = millimetres_in(place.unit);
    if (!millimetres) return std::nullopt;
    place.millimetres = *millimetres;
    for (int axis = 0; axis < 3; ++axis) {
        const auto low = file.find_text(kImarisImage, fmt::format("ExtMin{}", axis)),
                   high = file.find_text(kImarisImage, fmt::format("ExtMax{}", axis));
        if (!low || !high) return std::nullopt;
        const double from = std::strtod(low->c_str(), nullptr), to = std::strtod(high->c_str(), nullptr);
        const double step = (to - from) / static_cast<double>(extent[static_cast<std::size_t>(2 - axis)]);
        place.axes[axis][axis] = step;
        place.origin[axis] = from + step / 2;
    }
    return place;
}

// An attribute of the array or of a group above it that gives the spacing, slowest axis first, with its unit.
std::optional<Hdf5Place> place_of_attributes(const std::string& path, const Hdf5File& file, const std::string& array,
                                             const ArrayAxes& axes, std::size_t rank, std::vector<std::string>& notes) {
    struct Name {
        const char* name;
        const char* unit;  // nullptr: in an attribute of its own
    };
    static constexpr std::array kNames{
        Name{"element_size_um", "um"}, Name{"element_size_mm", "mm"}, Name{"element_size_nm", "nm"},
        Name{"voxel_size_um", "um"},   Name{"voxel_size_mm", "mm"},   Name{"voxel_size_nm", "nm"},
        Name{"spacing_um", "um"},      Name{"spacing_mm", "mm"},      Name{"spacing_nm", "nm"},
        Name{"element_size", nullptr}, Name{"voxel_size", nullptr},   Name{"voxelsize", nullptr},
        Name{"spacing", nullptr},      Name{"pixel_size", nullptr},   Name{"resolution", nullptr}};
    static constexpr std::array kUnits{
        "unit", "units", "spacing_unit", "spacing_units", "resolution_unit", "voxel_size_unit", "voxel_unit"};
    for (std::string object = array;; object = parent_of(object)) {
        for (const Name& known : kNames) {
            const auto numbers = file.find_numbers(object, known.name);
            if (!numbers) continue;
            std::string unit = known.unit == nullptr ? "" : known.unit;
            for (const char* name : kUnits)
                if (unit.empty()) unit = file.find_text(object, name).value_or("");
            const auto millimetres = millimetres_in(unit);
            if (!millimetres || (numbers->size() != 3 && numbers->size() != rank)) {
                notes.push_back(fmt::format(
                    "The attribute {} of {} is not used: {}.", known.name, object,
                    millimetres    ? fmt::format("{} numbers, expected 3", numbers->size())
                    : unit.empty() ? std::string("it has no unit; give --spacing X Y Z in mm if it is the spacing")
                                   : fmt::format("'{}' is no unit of length", unit)));
                continue;
            }
            Hdf5Place place{.millimetres = *millimetres,
                            .source = fmt::format("attribute {} of {}", known.name, object),
                            .unit = unit};
            for (std::size_t i = 0; i < 3; ++i) {
                const bool of_all = numbers->size() == rank && rank != 3;
                const std::size_t from_last = i < axes.space.size() ? i : 0;
                const std::size_t at = of_all ? axes.space[axes.space.size() - 1 - from_last] : 2 - i;
                const double step = (*numbers)[at];
                if (!(step > 0) || !std::isfinite(step))
                    fail("{}: {}: attribute {}: {}, expected lengths above 0", path, object, known.name, step);
                const int column = static_cast<int>(i);
                place.axes[column] = glm::dvec3(0);
                place.axes[column][axes.world.at(i)] = step;
            }
            return place;
        }
        if (object == "/") return std::nullopt;
    }
}

// A letter for each axis, from dimension labels or ilastik's axistags (JSON: "key": "z").
std::string letters_of(const Hdf5File& file, const Hdf5Dataset& data, const std::string& array) {
    std::string letters;
    if (const auto tags = file.find_text(array, "axistags")) {
        for (auto at = tags->find("\"key\""); at != std::string::npos; at = tags->find("\"key\"", at + 5)) {
            const auto quote = tags->find('"', tags->find(':', at) + 1);
            if (quote == std::string::npos || quote + 1 >= tags->size()) break;
            letters += static_cast<char>(std::tolower(static_cast<unsigned char>((*tags)[quote + 1])));
        }
        return letters;
    }
    for (const std::string& name : data.axis_names()) {
        if (name.empty()) return "";
        letters += static_cast<char>(std::tolower(static_cast<unsigned char>(name.front())));
    }
    return letters;
}

bool is_dimension_scale(const Hdf5File& file, const std::string& array) {
    return file.find_text(array, "CLASS").value_or("") == "DIMENSION_SCALE";
}

std::vector<NamedArray> arrays_of(const Hdf5File& file) {
    std::vector<NamedArray> arrays;
    for (const std::string& name : file.datasets()) {
        const Hdf5Dataset data = file.dataset(name);
        const auto thick = std::ranges::count_if(data.extent(), [](std::uint64_t n) { return n > 1; });
        if (data.extent().empty() || is_dimension_scale(file, name)) continue;
        arrays.push_back({name, data.extent(), std::string(name_of(data.type())), thick >= 3});
    }
    return arrays;
}

}  // namespace

bool is_packed(const std::string& path) {
    const Hdf5File file = Hdf5File::open(path);
    return file.find_text("/", "format").value_or("") == kPackedFormat;
}

Volume load_hdf5(const std::string& path, const LoadOptions& options) {
    report(options, 0.0, "reading header");
    const Hdf5File file = Hdf5File::open(path);
    const auto arrays = arrays_of(file);
    if (const auto links = file.external_links(); arrays.empty() && !links.empty())
        fail("{}: contains no array of numbers, but {} leads to {} in the file {}; give that file", path, links[0].name,
             links[0].object, links[0].file);
    NamedArray array = arrays[chosen_array(path, options, arrays)];
    const Hdf5Dataset data = file.dataset(array.name);
    if (is_imaris(file, array.name, array.extent)) array.extent = size_of_imaris(path, file, array.name, array.extent);
    const ArrayAxes axes = axes_of(array, letters_of(file, data, array.name));
    const ArrayBox box = chosen_box(path, options, array, axes);
    Volume volume;
    volume.name = path;
    volume.geometry.dims = box.dims;
    volume.stored_type = array.type;
    const std::size_t bytes = volume.geometry.voxel_count() * size_of(data.type());
    check_memory(path, array.name, bytes + volume.geometry.voxel_count() * sizeof(float));
    if (data.stored_bytes() == 0) fail("{}: {}: no sample was ever written to it", path, array.name);
    check_stored_size(path, bytes, data.stored_bytes(), kBestDeflateRatio * kPlainRatio);

    auto place = place_of_itk(file, array.name);
    if (!place) place = place_of_vtkhdf(path, file, array.name);
    if (!place) place = place_of_imaris(file, array.name, array.extent);
    if (!place) place = place_of_attributes(path, file, array.name, axes, array.extent.size(), volume.notes);
    if (!place) {
        place.emplace();
        place->source = "none: 1 mm assumed";
        for (std::size_t i = 0; i < 3; ++i) {
            place->axes[static_cast<int>(i)] = glm::dvec3(0);
            place->axes[static_cast<int>(i)][axes.world.at(i)] = 1;
        }
    }
    set_place(volume, place->axes, place->origin, place->millimetres, place->source);
    volume.in_patient = place->in_patient;
    volume.length_unit = place->unit;
    if (arrays.size() > 1)
        volume.notes.push_back(fmt::format("The array {} of {} was read.", array.name, arrays.size()));

    report(options, 0.1, "reading voxels");
    const auto buffer = std::make_unique<std::byte[]>(bytes);
    data.read(box.low, box.size, data.type(), buffer.get());
    StoredSamples stored{.type = data.type(), .data = buffer.get()};
    const auto one = [&](const char* name) -> std::optional<double> {
        const auto numbers = file.find_numbers(array.name, name);
        return numbers && numbers->size() == 1 ? std::optional(numbers->front()) : std::nullopt;
    };
    stored.slope = one("scale_factor").value_or(1);
    stored.intercept = one("add_offset").value_or(0);
    stored.fill = one("_FillValue");
    if (!stored.fill) stored.fill = one("missing_value");
    if (const auto warning = colour_warning(array, axes); place->source.starts_with("none") && !warning.empty())
        volume.warnings.push_back(warning);
    take_samples(stored, volume);
    return volume;
}

}  // namespace edgesplat::detail
