// The device, and what lives as long as it does.
#pragma once

#include "engine/gpu/commands.h"
#include "engine/plan/resources.h"

namespace edgesplat {

class DeviceSession {
  public:
    /// Throws Error; vk::SystemError where the driver fails. `messages_before`: validation's, of devices that were
    /// lost.
    explicit DeviceSession(const DeviceChoice& choice, std::uint64_t messages_before = 0);
    DeviceSession(const DeviceSession&) = delete;
    DeviceSession& operator=(const DeviceSession&) = delete;

    const DeviceChoice& choice() const { return choice_; }
    const gpu::Device& device() const { return device_; }
    const gpu::DeviceProfile& profile() const { return device_.profile(); }
    gpu::Pipelines& pipelines() { return pipelines_; }
    gpu::Commands& commands() { return commands_; }
    /// What the passes find from the next run on.
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
