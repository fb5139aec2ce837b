// The module edgesplat._core, and the translation of C++ errors to Python exceptions.
#include "engine/reference/pixel_rows.h"
#include "engine/renderer.h"
#include "engine/scene/scene_file.h"
#include "python/src/bindings.h"

namespace edgesplat::python {
namespace {

// Never released, like the interpreter's own exception types.
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
    all.error =
        make_type(module, "Error", "A request failed; the message names the field, the value and the expected form.",
                  PyExc_RuntimeError);
    all.scene_error = make_type(module, "SceneError",
                                "A scene file or text has errors. `problems` holds one line per error.", all.error);
    all.interrupted = make_type(module, "Interrupted", "`Renderer.interrupt` stopped the picture.", all.error);
    all.device_lost =
        make_type(module, "DeviceLost", "The device was lost, and lost again after it was reopened.", all.error);
    py::register_exception_translator(translate);
}

}  // namespace edgesplat::python

PYBIND11_MODULE(_core, module) {
    module.doc() = "The C++ core of the package edgesplat.";
    module.attr("__version__") = EDGESPLAT_VERSION;
    edgesplat::python::add_errors(module);
    edgesplat::python::add_volumes(module);
    edgesplat::python::add_scenes(module);
    edgesplat::python::add_pictures(module);
    edgesplat::python::add_renderers(module);
}
