// A picture together with the inputs that it was rendered from.
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
    SceneDocument document;  ///< as requested
    Scene scene;
    Camera camera;
    std::vector<RenderedFrame> frames;          ///< with output.compare_plain, the plain frame comes first
    std::vector<CpuMeasurements> measurements;  ///< of renderers on the processor
    std::optional<accuracy::ChosenSettings> choice;
    std::string device;
};

}  // namespace edgesplat::python
