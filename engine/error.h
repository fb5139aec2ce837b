// The one exception users see: bad input, a missing file, a device that cannot do what was asked.
#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace edgesplat {

/// What went wrong in words a user can act on: names the file, the field, the value, and what was expected.
class Error : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// Renderer::render was told to stop (Renderer::set_interruption): there is no picture.
class Interrupted : public Error {
  public:
    Interrupted() : Error("render: interrupted") {}
};

/// The device was lost (VK_ERROR_DEVICE_LOST), and again after it had been opened anew: there is no picture.
class DeviceLost : public Error {
  public:
    using Error::Error;
};

template <typename... Args>
[[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) {
    throw Error(fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace edgesplat
