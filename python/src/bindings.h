// Shared declarations of the Python module. Its functions use plain types; the public interface is written in Python
// (edgesplat/*.py).
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <array>
#include <filesystem>
#include <glm/glm.hpp>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "engine/image/image.h"
#include "engine/scene/cuts.h"
#include "engine/scene/scene_document.h"
#include "engine/volume/volume.h"

namespace edgesplat::python {

namespace py = pybind11;
using Triple = std::array<double, 3>;

/// The latest preprocessed version of a volume: pictures of it need no new upload.
struct LatestVersion {
    std::mutex mutex;
    VolumeSource source;
    std::vector<double> iso_values;  ///< on which the matter of chosen labels depends
    std::shared_ptr<const Volume> volume;
};

/// A volume that pictures, renderers and arrays share.
struct SharedVolume {
    std::shared_ptr<const Volume> volume;
    VolumeSource source;  ///< how it was read; for an array only its name
    std::shared_ptr<LatestVersion> latest = std::make_shared<LatestVersion>();
};

/// Finds and reads a volume. Keeps the interpreter's lock: output that another thread prints meanwhile would be taken
/// for messages of the image libraries.
SharedVolume read_from(VolumeSource source, const std::vector<std::filesystem::path>& folders);

/// A scene, and the folders searched for its volume.
struct Document {
    SceneDocument scene;
    std::vector<std::filesystem::path> folders;
    Cuts cuts{};
};

inline Triple triple(const glm::dvec3& v) {
    return {v.x, v.y, v.z};
}
inline glm::dvec3 vector(const Triple& v) {
    return {v[0], v[1], v[2]};
}

/// A read-only array over memory that `owner` owns.
template <typename T>
py::array view_of(std::vector<py::ssize_t> shape, const T* data, const py::object& owner) {
    py::array_t<T> array(std::move(shape), data, owner);
    array.attr("setflags")(py::arg("write") = false);
    return array;
}

void add_errors(py::module_& module);
void add_volumes(py::module_& module);
void add_scenes(py::module_& module);
void add_pictures(py::module_& module);
void add_renderers(py::module_& module);

}  // namespace edgesplat::python
