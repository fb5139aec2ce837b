// The module edgesplat._core, and how errors come to Python.
#include "engine/reference/pixel_rows.h"
#include "engine/renderer.h"
#include "engine/scene/scene_file.h"
#include "python/src/bindings.h"

namespace edgesplat::python {
namespace {

// Kept for the life of the process, as the interpreter keeps its own exceptions.
struct ErrorTypes {
    PyObject *error = nullptr, *scene_error = nullptr, *interrupted = nullptr, *device_lost = nullptr;
};
ErrorTypes& types() {
    static ErrorTypes all;
    return all;
}

PyObject* make_type(py::module_& module, const char* name, const char* doc, PyObject* base) {
    const std::string full = std::string("edgesplat.") + name;
    PyObject* type = PyErr_NewExceptionWithDoc(full.c_str(), doc, base, nullptr);
    if (type == nullptr) throw py::error_already_set();
    module.add_object(name, py::reinterpret_borrow<py::object>(type));
    return type;
}

void raise_scene_error(const SceneFileError& error) {
    const py::object raised = py::reinterpret_borrow<py::object>(types().scene_error)(error.what());
    raised.attr("problems") = error.problems();
    PyErr_SetObject(types().scene_error, raised.ptr());
}

void translate(std::exception_ptr pointer) {
    try {
        if (pointer) std::rethrow_exception(pointer);
    } catch (const SceneFileError& error) {
        raise_scene_error(error);
    } catch (const Interrupted& error) {
        PyErr_SetString(types().interrupted, error.what());
    } catch (const reference::Cancelled& error) {
        PyErr_SetString(types().interrupted, error.what());
    } catch (const DeviceLost& error) {
        PyErr_SetString(types().device_lost, error.what());
    } catch (const Error& error) {
        PyErr_SetString(types().error, error.what());
    }
}

}  // namespace

void add_errors(py::module_& module) {
    ErrorTypes& all = types();
    all.error = make_type(module, "Error", "What was asked for is not possible; the message says what was expected.",
                          PyExc_RuntimeError);
    all.scene_error = make_type(module, "SceneError",
                                "A scene file or text is wrong. `problems` holds one line for each thing.", all.error);
    all.interrupted = make_type(module, "Interrupted", "The picture was stopped by `Renderer.interrupt`.", all.error);
    all.device_lost =
        make_type(module, "DeviceLost", "The device was lost, and again when it was opened anew.", all.error);
    py::register_exception_translator(translate);
}

}  // namespace edgesplat::python

PYBIND11_MODULE(_core, module) {
    module.doc() = "The renderer under the package edgesplat; see there.";
    module.attr("__version__") = EDGESPLAT_VERSION;
    edgesplat::python::add_errors(module);
    edgesplat::python::add_volumes(module);
    edgesplat::python::add_scenes(module);
    edgesplat::python::add_pictures(module);
    edgesplat::python::add_renderers(module);
}
