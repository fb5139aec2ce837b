// Volumes of a scene that cut the others.
#pragma once

#include <memory>
#include <vector>

#include "engine/scene/scene_document.h"
#include "engine/volume/cut.h"

namespace edgesplat {

/// Cuts a scene's volumes, and keeps the latest results.
class Cuts {
  public:
    /// Lets the visible entries with VolumeRule::Cut remove matter of all other volumes: sets `whole` of the document
    /// and `cut` of its entries, which must be read. `whole`: the first volume before. Result: the first volume as it
    /// is drawn. A cut that the last call made, too, is the same object. Throws Error naming the volume.
    std::shared_ptr<const Volume> apply(SceneDocument& document, std::shared_ptr<const Volume> whole);

  private:
    struct Cut {
        std::shared_ptr<const Volume> whole;
        double iso = 0;
        std::vector<Cutter> cutters;
        std::shared_ptr<const Volume> drawn;
    };
    std::vector<Cut> kept_;
};

}  // namespace edgesplat
