// State of the navigation app without window and widgets: what is shown, and what the user changes.
#pragma once

#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/viewer/drawer.h"
#include "engine/viewer/flight_recorder.h"
#include "engine/viewer/history.h"
#include "engine/viewer/loading.h"
#include "engine/viewer/motion.h"
#include "engine/viewer/pick.h"
#include "engine/viewer/tour.h"
#include "engine/viewer/walls.h"

namespace edgesplat::viewer {

/// Which of the two pictures is shown.
enum class Show {
    Edges,       ///< edge-preserved
    Plain,       ///< conventional splatting
    Wipe,        ///< plain left of the divider, edge-preserved right of it
    Sharpening,  ///< where the two differ, and how much
};

/// The distance between the last two picks.
struct Ruler {
    double length = 0;       ///< mm
    double uncertainty = 0;  ///< mm, of both ends combined
};

class Session {
  public:
    /// `wait`: calls wait for background threads, so that the same calls give the same states.
    explicit Session(bool wait = false) : wait_(wait) {}

    /// Shows an opened volume from its scene's camera. Throws Error; the session is then unchanged.
    void open(Opened opened, const glm::ivec2& size);
    bool is_open() const { return history_.has_value(); }

    const Opened& opened() const { return opened_; }
    const Volume& volume() const { return *opened_.volume; }
    const SceneDocument& document() const { return history_->now(); }
    /// The document's scene; if that cannot be drawn, the last one that could.
    const Scene& scene() const { return scene_; }

    /// Changes the document. `finished`: makes it an undo step. A change that cannot be drawn is rejected with a
    /// message.
    void edit(const std::function<void(SceneDocument&)>& change, bool finished = true);
    /// Makes unfinished changes one undo step. Does nothing without any.
    void finish_edit();
    void undo();
    void redo();
    bool can_undo() const { return is_open() && history_->can_undo(); }
    bool can_redo() const { return is_open() && history_->can_redo(); }

    Motion& motion() { return motion_; }
    const Motion& motion() const { return motion_; }
    Tour& tour() { return tour_; }
    const Tour& tour() const { return tour_; }
    FlightRecorder& recorder() { return recorder_; }
    const std::shared_ptr<const Walls>& walls() const { return walls_; }
    Show show() const { return show_; }
    void set_show(Show show);
    double wipe() const { return wipe_; }
    void set_wipe(double share);  ///< of the picture's width, from the left; kept within [0, 1]
    bool best_when_still() const { return best_; }
    void set_best_when_still(bool on);

    /// Advances time: moves the eye, plays the tour, takes the results of threads.
    void step(const Controls& controls, double seconds);

    /// Picks the visible surface at a pixel of the picture and adds it to `picks`. Returns whether there is one.
    bool pick_at(const glm::dvec2& pixel, const glm::ivec2& size);
    /// Flies to the surface at a pixel and makes it the centre of orbits. Returns whether there is one.
    bool fly_to(const glm::dvec2& pixel, const glm::ivec2& size);
    const std::vector<Pick>& picks() const { return picks_; }
    void clear_picks();
    /// The point of the slices, world mm: the last pick, or the last `set_point`; nullopt without either.
    const std::optional<glm::dvec3>& point() const { return point_; }
    void set_point(const glm::dvec3& world) { point_ = world; }
    std::optional<Ruler> ruler() const;

    /// The request for a picture of that size; nullopt if it equals the last request.
    std::optional<DrawRequest> next_request(const glm::ivec2& size);
    /// Makes the next call of next_request return a request in any case: the drawn picture is lost.
    void force_next_request() {
        changed_ = true;
        asked_view_.reset();
    }
    /// Whether the picture changes by itself or by user input.
    bool moving() const;

    /// The document with the current camera, and with all values written out.
    SceneDocument document_to_save(const glm::ivec2& size) const;

    /// The last message; empty if there is none.
    const std::string& message() const { return message_; }
    void say(std::string text) { message_ = std::move(text); }

  private:
    /// `scene`: the document's resolved scene. `seen`: more than the drawing quality has changed.
    void apply(Scene scene, bool seen = true);
    Scene current_scene() const;
    /// The volume of a document in which other labels are drawn than now; null if the volume stays. Sets its checksum.
    std::shared_ptr<const Volume> relabelled(SceneDocument& document) const;
    /// Takes over the volume of the document after an undo or redo.
    void follow_document();
    /// Of all states but the current one, cuts are made again when they are needed.
    void forget_cuts();
    void find_walls();
    void poll();

    bool wait_;
    Opened opened_;
    SceneDocument drawn_;  ///< whose labels `opened_.whole` shows
    std::optional<History<SceneDocument>> history_;
    Scene scene_;
    std::uint64_t scene_number_ = 0, view_number_ = 0;  ///< change with every scene or quality; with every scene
    Motion motion_;
    Tour tour_;
    FlightRecorder recorder_;
    std::shared_ptr<const Walls> walls_;
    std::future<std::shared_ptr<const Walls>> pending_walls_;
    std::shared_ptr<const Volume> walls_volume_;  ///< whose walls are being computed
    Scene walls_scene_;                           ///< of `walls_`, or of those being computed
    bool walls_outdated_ = false;
    std::vector<Pick> picks_;
    std::optional<glm::dvec3> point_;
    Show show_ = Show::Edges;
    double wipe_ = 0.5;
    bool best_ = false;
    double quiet_ = 1;  ///< seconds since the last change
    bool changed_ = true;
    bool asked_moving_ = false;
    glm::ivec2 asked_size_{0};
    /// The view of the last request, if nothing moved.
    struct View {
        std::uint64_t number = 0;
        Camera camera;
    };
    std::optional<View> asked_view_;
    std::string message_;
};

}  // namespace edgesplat::viewer
