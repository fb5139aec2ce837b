// The exceptions that users of the library can catch, and `fail`, which throws them.
#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace edgesplat {

/// Bad input, a missing file or a device that lacks a feature. The message names the file or field, the value and the
/// expected value, so that the user can correct it.
class Error : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// render() was interrupted (Renderer::set_interruption): no picture was made.
class Interrupted : public Error {
  public:
    Interrupted() : Error("render: interrupted") {}
};

/// The device was lost (VK_ERROR_DEVICE_LOST), and lost again after it was reopened: no picture was made.
class DeviceLost : public Error {
  public:
    using Error::Error;
};

template <typename... Args>
[[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) {
    throw Error(fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace edgesplat
