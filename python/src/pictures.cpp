// Pictures as arrays, files and figures.
#include "python/src/pictures.h"

#include <cmath>

#include "apps/edgesplat/max_error_option.h"
#include "engine/accuracy/json_text.h"
#include "engine/error.h"
#include "engine/scene/scene_file.h"

namespace edgesplat::python {
namespace {

constexpr std::array<std::string_view, 2> kPictureExtensions{".png", ".exr"};

/// Text of the scene that reproduces the picture.
std::string scene_of(const Picture& self) {
    return scene_text(
        resolved(self.document, *self.volume.volume, self.scene, self.camera, self.frames.back().settings));
}

RunDescription description_of(const Picture& self) {
    return {.command_line = "import edgesplat",
            .volume = self.volume.volume.get(),
            .scene = &self.scene,
            .camera = self.camera,
            .volume_path = self.document.volume.path,
            .scene_text = scene_of(self),
            .device = self.device,
            .plan = {}};
}

struct Described {
    ImageMetadata metadata;
    nlohmann::ordered_json statistics;
};

/// Metadata and statistics (--json) of a picture, as the program writes them.
Described described(const Picture& self) {
    const RunDescription description = description_of(self);
    Described all{picture_metadata(description), statistics(description, self.frames)};
    all.metadata.emplace_back("edgesplat:renderer", name_of(self.document.output.renderer));
    add_error_estimate(self.choice, self.document.quality.max_error, all.metadata, all.statistics);
    add_renderer_statistics(all.statistics, self.document.output, self.measurements);
    return all;
}

void save(const Picture& self, const std::string& path) {
    const py::gil_scoped_release release;
    check_output_path(path, kPictureExtensions);
    if (is_png_path(path))
        for (const std::string& aov : self.document.output.aovs)
            check_output_path(aov_path(path, aov));
    write_files(picture_files(path, self.frames, described(self).metadata));
}

std::string png(const Picture& self) {
    const py::gil_scoped_release release;
    const ImageMetadata metadata = described(self).metadata;
    if (self.frames.size() > 1) return picture_files("picture.png", self.frames, metadata).front().bytes;
    return encode_png(without_alpha(self.frames.front().result.color), metadata);
}

/// A PNG file that shows the picture `left`, of the same size, to the left of a white line; `wipe`: the line's place,
/// 0..1 of the width.
std::string wiped_png(const Picture& self, const Picture& left, double wipe) {
    const py::gil_scoped_release release;
    Image image = without_alpha(self.frames.back().result.color);
    const Image other = without_alpha(left.frames.back().result.color);
    const int line = static_cast<int>(std::lround(wipe * (image.width - 1)));
    for (int y = 0; y < image.height; ++y)
        for (int c = 0; c < image.channels; ++c) {
            for (int x = 0; x < line; ++x)
                image.at(x, y, c) = other.at(x, y, c);
            image.at(line, y, c) = 1;
        }
    return encode_png(image, {});
}

py::object array_of(const py::object& self, const Image& image) {
    std::vector<py::ssize_t> shape{image.height, image.width};
    if (image.channels > 1) shape.push_back(image.channels);
    return view_of<float>(std::move(shape), image.pixels.data(), self);
}

template <std::optional<Image> RenderResult::*output>
py::object output_of(const py::object& self) {
    const std::optional<Image>& image = self.cast<const Picture&>().frames.back().result.*output;
    return image ? array_of(self, *image) : py::none();
}

}  // namespace

void add_pictures(py::module_& module) {
    py::class_<Picture>(module, "Picture")
        .def_property_readonly("color",
                               [](const py::object& self) {
                                   return array_of(self, self.cast<const Picture&>().frames.back().result.color);
                               })
        .def_property_readonly("plain",
                               [](const py::object& self) -> py::object {
                                   const Picture& picture = self.cast<const Picture&>();
                                   if (picture.frames.size() < 2) return py::none();
                                   return array_of(self, picture.frames.front().result.color);
                               })
        .def_property_readonly("tau", output_of<&RenderResult::tau>)
        .def_property_readonly("depth", output_of<&RenderResult::depth>)
        .def_property_readonly("normal", output_of<&RenderResult::normal>)
        .def_property_readonly("distance", output_of<&RenderResult::distance>)
        .def_property_readonly("camera",
                               [](const Picture& self) {
                                   const Camera& c = self.camera;
                                   return py::make_tuple(triple(c.eye), triple(c.direction), triple(c.up), c.fov_y);
                               })
        .def_property_readonly("iso_values",
                               [](const Picture& self) {
                                   std::vector<double> values = self.scene.iso_values;
                                   for (double& value : values)
                                       value = self.volume.volume->in_file_unit(value);
                                   return values;
                               })
        .def_property_readonly("scene_text", scene_of)
        .def_property_readonly("volume", [](const Picture& self) { return self.volume; })
        .def("statistics", [](const Picture& self) { return json_text(described(self).statistics); })
        .def("png", [](const Picture& self) { return py::bytes(png(self)); })
        .def("wiped_png", [](const Picture& self, const Picture& left,
                             double wipe) { return py::bytes(wiped_png(self, left, wipe)); })
        .def("save", save);
}

}  // namespace edgesplat::python
