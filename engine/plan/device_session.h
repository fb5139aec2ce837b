// Owns the device and all objects with the same lifetime: pipelines, bindings, commands.
#pragma once

#include "engine/gpu/commands.h"
#include "engine/plan/resources.h"

namespace edgesplat {

class DeviceSession {
  public:
    /// Throws Error; vk::SystemError if the driver fails. `messages_before`: number of validation messages of earlier,
    /// lost devices.
    explicit DeviceSession(const DeviceChoice& choice, std::uint64_t messages_before = 0);
    DeviceSession(const DeviceSession&) = delete;
    DeviceSession& operator=(const DeviceSession&) = delete;

    const DeviceChoice& choice() const { return choice_; }
    const gpu::Device& device() const { return device_; }
    const gpu::DeviceProfile& profile() const { return device_.profile(); }
    gpu::Pipelines& pipelines() { return pipelines_; }
    gpu::Commands& commands() { return commands_; }
    /// The passes' resource bindings; changes apply from the next run on.
    Bindings& bindings() { return bindings_; }
    std::uint64_t validation_messages() const { return messages_before_ + device_.validation_messages(); }

  private:
    DeviceChoice choice_;
    std::uint64_t messages_before_;
    gpu::Device device_;
    gpu::Pipelines pipelines_;
    Bindings bindings_;
    gpu::Commands commands_;
};

}  // namespace edgesplat
