// A picture with everything that it was made from.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/edgesplat/cpu_renderers.h"
#include "engine/accuracy/choose_settings.h"
#include "python/src/bindings.h"

namespace edgesplat::python {

struct Picture {
    SharedVolume volume;
    SceneDocument document;  ///< as it was asked for
    Scene scene;
    Camera camera;
    std::vector<RenderedFrame> frames;          ///< with output.compare_plain the plain one first
    std::vector<CpuMeasurements> measurements;  ///< of renderers that need no device
    std::optional<accuracy::ChosenSettings> choice;
    std::string device;
};

}  // namespace edgesplat::python
