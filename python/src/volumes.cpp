// Volumes from files and arrays.
#include "engine/error.h"
#include "engine/measure/extents.h"
#include "engine/scene/default_materials.h"
#include "engine/scene/scene_document.h"
#include "engine/volume/analytic_volumes.h"
#include "engine/volume/filters.h"
#include "engine/volume/io/samples.h"
#include "engine/volume/labels.h"
#include "engine/volume/load_volume.h"
#include "engine/volume/no_data.h"
#include "engine/volume/packed_volume.h"
#include "engine/volume/segmentation.h"
#include "python/src/signals.h"

namespace edgesplat::python {
namespace {

SharedVolume load(const std::string& path, std::optional<int> component, std::optional<int> frame,
                  std::optional<int> level, const std::string& series, const std::string& raw,
                  const std::optional<Triple>& spacing, std::optional<double> no_data, const std::string& label_names) {
    VolumeSource source;
    source.component = component;
    source.frame = frame;
    source.level = level;
    source.series = series;
    source.raw = raw;
    source.no_data = no_data;
    source.label_names = label_names;
    if (spacing) source.spacing = vector(*spacing);
    source.path = path;
    return read_from(std::move(source), volume_folders({}));
}

/// Dimensions x, y, z of an array with axes z, y, x. Throws Error beyond the limits of files.
glm::ivec3 dims_of(const py::array& array, const std::string& name) {
    const auto side = [&](int axis) { return static_cast<std::size_t>(array.shape(axis)); };
    for (const int axis : {0, 1, 2}) {
        if (side(axis) < 1)
            fail("{}: shape {}: axis {} is empty", name, std::string(py::str(array.attr("shape"))), axis);
        if (side(axis) > kMaxVoxelsPerAxis)
            fail("{}: shape {}: an axis may have at most {} voxels", name, std::string(py::str(array.attr("shape"))),
                 kMaxVoxelsPerAxis);
    }
    if (side(0) * side(1) * side(2) > kMaxVoxels)
        fail("{}: shape {}: a volume may have at most {} voxels", name, std::string(py::str(array.attr("shape"))),
             kMaxVoxels);
    return {side(2), side(1), side(0)};
}

/// The type of an array of integers that floats may not represent.
std::optional<detail::SampleType> wide_integer(const py::array& array) {
    using detail::SampleType;
    const char kind = array.dtype().kind();
    const auto bytes = array.dtype().itemsize();
    if (bytes != 4 && bytes != 8) return std::nullopt;
    if (kind == 'i') return bytes == 4 ? SampleType::Int32 : SampleType::Int64;
    if (kind == 'u') return bytes == 4 ? SampleType::UInt32 : SampleType::UInt64;
    return std::nullopt;
}

/// A volume from an array. `array`: numbers with three axes z, y, x, any byte order and strides. `axes`: steps of a
/// voxel along x, y and z, mm. `value_scale`: as of Volume. Integers that floats cannot represent keep their identity
/// as in files.
SharedVolume from_array(const py::array& array, const std::array<Triple, 3>& axes, const Triple& origin, bool patient,
                        const std::string& name, double value_scale, std::optional<double> no_data,
                        const std::string& label_names) {
    Volume volume;
    volume.name = name;
    volume.stored_type = py::str(array.dtype());
    volume.in_patient = patient;
    volume.geometry.dims = dims_of(array, name);
    for (int axis = 0; axis < 3; ++axis)
        volume.geometry.index_to_world_axes[axis] = vector(axes[static_cast<std::size_t>(axis)]);
    volume.geometry.origin = vector(origin);
    const auto type = wide_integer(array);
    const py::module_ numpy = py::module_::import("numpy");
    if (type) {
        const py::array plain = numpy.attr("ascontiguousarray")(
            array.attr("astype")(array.dtype().attr("newbyteorder")("="), py::arg("copy") = false));
        detail::take_samples({.type = *type, .data = plain.data()}, volume);
    } else {
        volume.values.resize(volume.geometry.voxel_count());
        // NumPy converts any array in one pass, directly into the volume's memory.
        const py::array_t<float> target({array.shape(0), array.shape(1), array.shape(2)}, volume.values.data(),
                                        py::none());
        numpy.attr("copyto")(target, array, py::arg("casting") = "unsafe");
    }
    const py::gil_scoped_release release;
    volume.value_scale = value_scale;
    if (no_data && declare_no_data(volume, *no_data) == 0) fail("{}: no_data: no sample is {}", name, *no_data);
    finish_volume(volume);
    for (const SuspectedFill& fill : suspected_fill(volume))
        volume.warnings.push_back(text_of(fill, volume));
    if (!volume.labels) volume.labels = labels_of(volume);
    if (!label_names.empty()) name_labels(volume, label_names);
    VolumeSource source;
    source.path = name;
    return {std::make_shared<const Volume>(std::move(volume)), std::move(source)};
}

/// The volume with the labels of a segmentation (add_segmentation).
SharedVolume with_segmentation(const SharedVolume& self, const SharedVolume& segmentation,
                               const std::string& label_names) {
    const py::gil_scoped_release release;
    Volume volume = *self.volume;
    add_segmentation(volume, *segmentation.volume);
    if (!label_names.empty()) name_labels(volume, label_names);
    VolumeSource source = self.source;
    source.segmentation = segmentation.source.path;
    source.label_names = label_names;
    return {std::make_shared<const Volume>(std::move(volume)), std::move(source)};
}

py::array values(const py::object& self) {
    const Volume& volume = *self.cast<const SharedVolume&>().volume;
    require_samples(volume, "Volume.array");
    const glm::ivec3& dims = volume.geometry.dims;
    return view_of<float>({dims.z, dims.y, dims.x}, volume.values.data(), self);
}

/// Which samples contain no data, in the shape of the samples; None: all do.
py::object no_data(const SharedVolume& self) {
    const Volume& volume = *self.volume;
    if (!volume.no_data) return py::none();
    const glm::ivec3& dims = volume.geometry.dims;
    py::array_t<bool> marks({dims.z, dims.y, dims.x});
    std::copy(volume.no_data->begin(), volume.no_data->end(), marks.mutable_data());
    return marks;
}

std::vector<std::pair<double, double>> suggestions(const SharedVolume& self, int count) {
    const py::gil_scoped_release release;
    std::vector<std::pair<double, double>> found;
    for (const IsoSuggestion& suggestion : suggest_iso_values(*self.volume, count))
        found.emplace_back(self.volume->in_file_unit(suggestion.value), suggestion.strength);
    return found;
}

using Numbers = std::pair<double, double>;  // a value and its uncertainty

std::vector<Numbers> numbers(const std::vector<measure::Quantity>& quantities) {
    std::vector<Numbers> all;
    for (const measure::Quantity& quantity : quantities)
        all.emplace_back(quantity.value, quantity.uncertainty);
    return all;
}

/// Volumes of the materials, mm^3, and areas of the iso-surfaces, mm^2.
std::pair<std::vector<Numbers>, std::vector<Numbers>> measured(const SharedVolume& self,
                                                               const std::vector<double>& iso_values) {
    return without_lock([&] {
        Signals signals;
        std::vector<double> samples = iso_values;
        for (double& value : samples)
            value /= self.volume->value_scale;
        const auto extents =
            measure::measure_extents(*self.volume, samples, {}, [&](double) { return !signals.request_stop(); });
        return std::pair(numbers(extents.volumes), numbers(extents.surfaces));
    });
}

/// A label's number: an int in Python.
py::object number_of(const LabelTable& table, const Label& label) {
    if (table.is_signed) return py::int_(static_cast<std::int64_t>(label.id));
    return py::int_(label.id);
}

/// Number, name and colour (linear light) of each label; empty if the volume is no segmentation.
std::vector<std::tuple<py::object, std::string, Triple>> labels(const SharedVolume& self) {
    std::vector<std::tuple<py::object, std::string, Triple>> all;
    const auto table = labels_of(*self.volume);
    if (!table) return all;
    const std::vector<glm::dvec3> colors = label_colors(*table);
    for (std::size_t place = 0; place < table->labels.size(); ++place)
        all.emplace_back(number_of(*table, table->labels[place]), table->labels[place].name, triple(colors[place]));
    return all;
}

/// Each label's number and name, with its number of voxels, its volume, mm^3, and the mean and standard deviation of a
/// scan's values in it. A value of a volume that is no segmentation is its own number.
std::vector<std::tuple<py::object, std::string, std::size_t, Numbers, std::optional<Numbers>>> measured_labels(
    const SharedVolume& self) {
    const auto extents = without_lock([&] { return measure::measure_labels(*self.volume); });
    const auto table = labels_of(*self.volume);
    std::vector<std::tuple<py::object, std::string, std::size_t, Numbers, std::optional<Numbers>>> all;
    for (const measure::LabelExtent& extent : extents)
        all.emplace_back(table ? number_of(*table, extent.label) : py::float_(static_cast<double>(extent.label.value)),
                         extent.label.name, extent.voxels, Numbers(extent.volume.value, extent.volume.uncertainty),
                         extent.values ? std::optional(Numbers(extent.values->x, extent.values->y)) : std::nullopt);
    return all;
}

}  // namespace

SharedVolume read_from(VolumeSource source, const std::vector<std::filesystem::path>& folders) {
    source.path = find_volume(source.path, folders);
    std::vector<std::filesystem::path> searched{{}};
    searched.insert(searched.end(), folders.begin(), folders.end());
    Volume volume = small_labels_in_memory(read_source(source, searched));
    // An absolute path stays valid wherever the picture is stored.
    if (!is_builtin(source.path)) source.path = std::filesystem::absolute(source.path).string();
    return {std::make_shared<const Volume>(std::move(volume)), std::move(source)};
}

void add_volumes(py::module_& module) {
    py::class_<SharedVolume>(module, "Volume")
        .def_static("load", load)
        .def_static("from_array", from_array)
        .def_property_readonly("array", values)
        .def("suggest_iso_values", suggestions)
        .def("measure", measured)
        .def("with_segmentation", with_segmentation)
        .def("measure_labels", measured_labels)
        .def_property_readonly("labels", labels)
        .def_property_readonly("shape",
                               [](const SharedVolume& self) {
                                   const glm::ivec3& dims = self.volume->geometry.dims;
                                   return std::array<int, 3>{dims.z, dims.y, dims.x};
                               })
        .def_property_readonly("axes",
                               [](const SharedVolume& self) {
                                   const glm::dmat3& axes = self.volume->geometry.index_to_world_axes;
                                   return std::array<Triple, 3>{triple(axes[0]), triple(axes[1]), triple(axes[2])};
                               })
        .def_property_readonly("spacing",
                               [](const SharedVolume& self) { return triple(self.volume->geometry.spacing()); })
        .def_property_readonly("origin", [](const SharedVolume& self) { return triple(self.volume->geometry.origin); })
        .def_property_readonly("patient", [](const SharedVolume& self) { return self.volume->in_patient; })
        .def_property_readonly("min",
                               [](const SharedVolume& self) {
                                   return self.volume->in_file_unit(static_cast<double>(self.volume->min_value));
                               })
        .def_property_readonly("max",
                               [](const SharedVolume& self) {
                                   return self.volume->in_file_unit(static_cast<double>(self.volume->max_value));
                               })
        .def_property_readonly("value_scale", [](const SharedVolume& self) { return self.volume->value_scale; })
        .def_property_readonly("no_data", no_data)
        .def_property_readonly("non_finite_count",
                               [](const SharedVolume& self) { return self.volume->non_finite_count; })
        .def_property_readonly("name", [](const SharedVolume& self) { return self.volume->name; })
        .def_property_readonly("stored_type", [](const SharedVolume& self) { return self.volume->stored_type; })
        .def_property_readonly("checksum",
                               [](const SharedVolume& self) { return fmt::format("{:016x}", self.volume->checksum); })
        .def_property_readonly("notes", [](const SharedVolume& self) { return self.volume->notes; })
        .def_property_readonly("warnings", [](const SharedVolume& self) { return self.volume->warnings; });
    module.def("builtin_names", [] {
        std::vector<std::string> names;
        for (const auto& name : analytic_scene_names())
            names.emplace_back(name);
        return names;
    });
}

}  // namespace edgesplat::python
