// What a window shows and a person changes: everything of the navigation app that is neither window nor widget.
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

/// What of the two pictures is shown.
enum class Show {
    Edges,       ///< edge-preserved
    Plain,       ///< conventional splatting
    Wipe,        ///< plain left of the divider, edge-preserved right of it
    Sharpening,  ///< where the two differ, and how much
};

/// A line between the last two picks.
struct Ruler {
    double length = 0;       ///< mm
    double uncertainty = 0;  ///< mm, of both ends together
};

class Session {
  public:
    /// `wait`: what else happens on threads is done before a call returns, so that the same calls give the same states.
    explicit Session(bool wait = false) : wait_(wait) {}

    /// Shows what was opened, from the camera that its scene says. Throws Error; the session is as before then.
    void open(Opened opened, const glm::ivec2& size);
    bool is_open() const { return history_.has_value(); }

    const Opened& opened() const { return opened_; }
    const Volume& volume() const { return *opened_.volume; }
    const SceneDocument& document() const { return history_->now(); }
    /// The document's scene; of a change that cannot be drawn the last one that could.
    const Scene& scene() const { return scene_; }

    /// Changes the document; `finished`: undo comes back to it. A change that cannot be drawn is refused and said.
    void edit(const std::function<void(SceneDocument&)>& change, bool finished = true);
    /// Ends changes that were not finished: undo comes back to what is now. Without any, nothing happens.
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

    /// Time goes on: moves the eye, plays the tour, takes what threads have found.
    void step(const Controls& controls, double seconds);

    /// The visible surface at a pixel of the picture; kept among `picks`. Whether there is one.
    bool pick_at(const glm::dvec2& pixel, const glm::ivec2& size);
    /// Flies there and makes it the centre that one turns about. Whether there is a surface.
    bool fly_to(const glm::dvec2& pixel, const glm::ivec2& size);
    const std::vector<Pick>& picks() const { return picks_; }
    void clear_picks();
    /// The place that slices go through, world mm: the last pick, or what was set since; none where there is neither.
    const std::optional<glm::dvec3>& point() const { return point_; }
    void set_point(const glm::dvec3& world) { point_ = world; }
    std::optional<Ruler> ruler() const;

    /// What is to be drawn for a window's picture of that size; nothing if that is what was asked for last.
    std::optional<DrawRequest> next_request(const glm::ivec2& size);
    /// The next request is asked for whatever it is: what was drawn is lost.
    void ask_again() {
        changed_ = true;
        asked_view_.reset();
    }
    /// Whether the picture is going to change by itself or under a hand.
    bool moving() const;

    /// The document with the camera as it is, and everything written out.
    SceneDocument kept_document(const glm::ivec2& size) const;

    /// The last thing there was to say; empty: nothing.
    const std::string& message() const { return message_; }
    void say(std::string text) { message_ = std::move(text); }

  private:
    /// `scene`: what the document says, resolved. `seen`: not only how well it is drawn has changed.
    void apply(Scene scene, bool seen = true);
    Scene resolved_now() const;
    void find_walls();
    void poll();

    bool wait_;
    Opened opened_;
    std::optional<History<SceneDocument>> history_;
    Scene scene_;
    std::uint64_t scene_number_ = 0, view_number_ = 0;  ///< another one with every scene or quality; with every scene
    Motion motion_;
    Tour tour_;
    FlightRecorder recorder_;
    std::shared_ptr<const Walls> walls_;
    std::future<std::shared_ptr<const Walls>> walls_to_come_;
    std::shared_ptr<const Volume> walls_volume_;  ///< whose they are
    Scene walls_scene_;                           ///< of which they were, or are being, found
    bool walls_outdated_ = false;
    std::vector<Pick> picks_;
    std::optional<glm::dvec3> point_;
    Show show_ = Show::Edges;
    double wipe_ = 0.5;
    bool best_ = false;
    double quiet_ = 1;  ///< seconds since something last changed
    bool changed_ = true;
    bool asked_moving_ = false;
    glm::ivec2 asked_size_{0};
    /// What the last request was to show, if nothing moved.
    struct View {
        std::uint64_t number = 0;
        Camera camera;
    };
    std::optional<View> asked_view_;
    std::string message_;
};

}  // namespace edgesplat::viewer
