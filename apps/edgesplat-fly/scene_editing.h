// State of the scene panels between frames, besides the document.
#pragma once

#include <cstddef>
#include <future>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/scene/scene_presets.h"
#include "engine/viewer/handles.h"
#include "engine/volume/filters.h"

/// Distribution of a volume's values.
struct ValueStatistics {
    edgesplat::Histogram histogram;
    std::vector<edgesplat::IsoSuggestion> suggestions;
};

/// Computes statistics on a thread, once per volume.
class ValueCounter {
  public:
    /// Null until they are computed. `wait`: waits for them.
    const ValueStatistics* of(const std::shared_ptr<const edgesplat::Volume>& volume, bool wait);
    bool busy() const;

  private:
    std::shared_ptr<const edgesplat::Volume> volume_, counted_;  ///< being counted; the volume of `found_`
    std::future<ValueStatistics> to_come_;
    ValueStatistics found_;
};

/// State of the plot over the value axis.
struct PlotState {
    enum class Kind { None, Iso, Point };
    struct Target {
        Kind kind = Kind::None;
        std::size_t place = 0;
    };
    Target grabbed;
    glm::dvec2 offset{0};               ///< pixels from the grabbed target to the mouse
    std::optional<std::size_t> chosen;  ///< the point of the transfer function that is edited in the panel
    double low = 0, high = 1;           ///< values at the plot's sides
};

/// A drag of a clip handle in the picture.
struct ClipHand {
    bool shown = true;
    bool was_down = false;
    std::optional<std::size_t> hovered;
    std::optional<edgesplat::viewer::Handle> held;  ///< as it was when the drag began
    std::optional<double> start;                    ///< mm along its normal, where the drag began
};

/// State of the list of labels.
struct LabelList {
    std::string search;
    const edgesplat::Volume* samples = nullptr;  ///< whose labels `shown` chooses
    std::vector<std::string> only, hide;         ///< as `shown` chooses them
    std::vector<bool> shown;                     ///< by place in the table
    std::size_t background = 0;                  ///< place in the table
};

struct SceneEditing {
    LabelList labels;
    ValueCounter counter;
    PlotState plot;
    ClipHand clip;
    std::vector<edgesplat::TransferPoint> stored_transfer;  ///< the transfer function, while materials are used
    std::vector<edgesplat::ScenePreset> presets;            ///< read on first use
    std::shared_ptr<const edgesplat::Volume> volume;        ///< volume of this state
};
