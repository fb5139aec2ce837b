// Work without the interpreter's lock, which Ctrl-C stops.
#pragma once

#include <chrono>

#include "engine/reference/pixel_rows.h"
#include "engine/renderer.h"
#include "python/src/bindings.h"

namespace edgesplat::python {

/// Does `work` without the interpreter's lock. Where it was stopped by a signal, the signal's exception goes on.
template <typename Work>
auto without_lock(Work work) {
    try {
        const py::gil_scoped_release release;
        return work();
    } catch (const Interrupted&) {
        if (PyErr_Occurred() != nullptr) throw py::error_already_set();
        throw;
    } catch (const reference::Cancelled&) {
        if (PyErr_Occurred() != nullptr) throw py::error_already_set();
        throw;
    }
}

/// Whether signals that came in ask to stop; asked by a thread without the interpreter's lock, which is taken 50 times
/// a second at most. Then the signal's exception is set.
class Signals {
  public:
    bool ask_to_stop() {
        const std::chrono::steady_clock::time_point now = std::chrono::steady_clock::now();
        if (now - last_ < std::chrono::milliseconds(20)) return false;
        last_ = now;
        const py::gil_scoped_acquire acquire;
        return PyErr_CheckSignals() != 0;
    }

  private:
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace edgesplat::python
