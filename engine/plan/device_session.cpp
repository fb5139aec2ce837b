#include "engine/plan/device_session.h"

#include "footprints/cache_folder.h"

namespace edgesplat {

DeviceSession::DeviceSession(const DeviceChoice& choice, std::uint64_t messages_before)
    : choice_(choice),
      messages_before_(messages_before),
      device_(choice),
      pipelines_(device_, cache_folder()),
      bindings_(device_, pipelines_),
      commands_(device_, pipelines_, bindings_.set()) {
    bindings_.write_volume({});
    bindings_.write_splats({});
    bindings_.write_targets({});
    commands_.run([&] { bindings_.prepare(commands_); });
}

}  // namespace edgesplat
