// What the scene's panels hold between frames, beside the document itself.
#pragma once

#include <cstddef>
#include <future>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "engine/scene/scene_presets.h"
#include "engine/viewer/handles.h"
#include "engine/volume/filters.h"

/// How a volume's values are distributed.
struct ValueStatistics {
    edgesplat::Histogram histogram;
    std::vector<edgesplat::IsoSuggestion> suggestions;
};

/// Counted on a thread, once per volume.
class ValueCounter {
  public:
    /// Null until they are there. `wait`: they are there at once.
    const ValueStatistics* of(const std::shared_ptr<const edgesplat::Volume>& volume, bool wait);
    bool busy() const;

  private:
    std::shared_ptr<const edgesplat::Volume> volume_, counted_;  ///< being counted; that `found_` is of
    std::future<ValueStatistics> to_come_;
    ValueStatistics found_;
};

/// The plot over the value axis.
struct PlotState {
    enum class Kind { None, Iso, Point };
    struct Target {
        Kind kind = Kind::None;
        std::size_t place = 0;
    };
    Target grabbed;
    glm::dvec2 offset{0};               ///< pixels from what is grabbed to the mouse
    std::optional<std::size_t> chosen;  ///< point of the transfer function whose colour is edited
    double low = 0, high = 1;           ///< values at the plot's sides
};

/// A clip handle that is dragged in the picture.
struct ClipHand {
    bool shown = true;
    bool was_down = false;
    std::optional<std::size_t> hovered;
    std::optional<edgesplat::viewer::Handle> held;  ///< as it was when it was taken
    std::optional<double> start;                    ///< mm along its normal where the mouse took it
};

struct SceneEditing {
    ValueCounter counter;
    PlotState plot;
    ClipHand clip;
    std::vector<edgesplat::TransferPoint> put_away;   ///< a transfer function while materials are shown
    std::vector<edgesplat::ScenePreset> presets;      ///< read when they were first looked at
    std::shared_ptr<const edgesplat::Volume> volume;  ///< that all of this is about
};
