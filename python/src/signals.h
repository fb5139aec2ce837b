// Runs work without the interpreter's lock, and lets Ctrl-C stop it.
#pragma once

#include <chrono>

#include "engine/reference/pixel_rows.h"
#include "engine/renderer.h"
#include "python/src/bindings.h"

namespace edgesplat::python {

/// Runs `work` without the interpreter's lock. If a signal stopped it, rethrows the signal handler's exception.
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

/// Checks for signals from a thread without the interpreter's lock; takes the lock at most 50 times a second.
/// request_stop() returns true if a handler raised an exception, which is then set.
class Signals {
  public:
    bool request_stop() {
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
