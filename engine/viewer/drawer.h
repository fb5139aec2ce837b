// Draws pictures for a window: within a time limit while something moves, then refined.
#pragma once

#include <atomic>
#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <tuple>

#include "engine/renderer.h"
#include "engine/viewer/pace.h"

namespace edgesplat::viewer {

/// A request for a picture.
struct DrawRequest {
    std::shared_ptr<const Volume> volume;
    Scene scene;
    Settings settings;
    std::uint64_t scene_number = 0;  ///< changes whenever volume, scene or settings change
    Camera camera;
    glm::ivec2 size{0};   ///< pixels of the window's picture, each 1..16384
    bool plain = false;   ///< draw the conventional picture, too
    bool moving = false;  ///< draw one picture in time; else refine up to the best one
    /// Only the way of drawing differs from the previous request, not the view. If that request was finished, its
    /// picture stays until this one is finished, without coarser ones in between.
    bool same_view = false;
    std::optional<Settings> best;  ///< drawn after the finished picture of `settings`
};

/// A picture that was drawn.
struct DrawnPicture {
    std::uint64_t number = 0;  ///< of the request
    Image color;               ///< at the rung's size
    std::optional<Image> plain;
    Rung rung;
    bool moving = false;
    bool finished = false;    ///< no better picture follows
    bool best = false;        ///< drawn with the request's best settings
    double milliseconds = 0;  ///< wall clock
    double setup = 0;         ///< the part of it that the next picture of the scene does not need
    RenderStats stats;
    /// For a finished picture: RMS error of the last coarse picture of the same request, as a share of sRGB full scale.
    std::optional<double> coarse_error;
    std::optional<Rung> coarse_rung;
};

/// Owns the renderers: one for each resolution and kind of picture, created when first needed.
class Drawer {
  public:
    struct Options {
        DeviceChoice device;
        std::uint64_t memory_budget = 0;  ///< bytes for each renderer; 0: what the device has
        double target = 150;              ///< time limit of a picture in motion, milliseconds
        /// When pictures in motion are ray cast, if the scene allows it (`raycast_obstacle`). On a processor, rays are
        /// several times as fast as splats. Cubic: through the B-spline, which is more accurate and takes longer.
        enum class Rays { Never, OnProcessor, Always, Cubic } rays = Rays::OnProcessor;
        bool threaded = true;  ///< otherwise `take` draws the pictures
    };
    explicit Drawer(Options options);
    ~Drawer();
    Drawer(const Drawer&) = delete;
    Drawer& operator=(const Drawer&) = delete;

    /// Replaces the current request. A picture being drawn for an earlier request is cancelled, unless that one was
    /// moving. Returns the request's number.
    std::uint64_t ask(DrawRequest request);
    /// The newest picture that was not taken yet. Without a thread, draws the next picture now.
    std::optional<DrawnPicture> take();
    /// Whether another picture of the last request will follow.
    bool busy() const;
    /// The error since the last call; empty if there was none. The next request tries again.
    std::string take_error();
    void set_target(double milliseconds);
    void set_rays(Options::Rays rays);
    /// Pictures in motion keep their current resolution, however long they take: the same pictures on every machine.
    void freeze_pace(bool on) { frozen_ = on; }
    /// Test hook: simulates the loss of the device for the next picture.
    void simulate_device_loss() { lose_ = true; }
    /// The share of the surfaces that the picture being drawn has found, 0 to 1; 1 if it waits for none.
    double found() const { return found_; }
    /// Device memory of all renderers, bytes.
    std::uint64_t device_bytes() const { return device_bytes_; }
    /// Messages of all renderers, also of destroyed ones.
    std::uint64_t validation_messages() const { return validation_messages_; }
    /// Number of renderers, so that tests can check that none is superfluous.
    std::size_t renderers() const;
    /// The coarsest level that is drawn of a volume: small enough that every picture can estimate its edges.
    static int coarsest_level(const Volume& volume, bool software);

  private:
    enum class Kind { Warped, Plain, Best };
    struct Key {
        int level;
        Kind kind;
        bool operator<(const Key& other) const { return std::tie(level, kind) < std::tie(other.level, other.kind); }
    };
    struct Held {
        std::unique_ptr<Renderer> renderer;
        std::optional<std::uint64_t> scene_number;  ///< of the last picture
    };
    struct Job;

    void run(const std::stop_token& stop);
    /// Draws the next picture. Returns it, or with a thread keeps it for `take`.
    std::optional<DrawnPicture> draw_next();
    DrawnPicture draw(const Job& job);
    Image draw_kind(Kind kind, const Job& job, const Rung& rung, DrawnPicture& out);
    bool casts_rays(const DrawRequest& request);
    Rung quick_rung(const DrawRequest& request, bool rays);
    Pace& pace_of(bool rays) { return rays ? *ray_pace_ : *pace_; }
    Renderer& renderer_for(const Key& key, const Job& job);
    std::shared_ptr<const Volume> level_of(const std::shared_ptr<const Volume>& volume, int level);
    /// Destroys the renderers for which `unused` is true; their validation messages stay counted.
    template <typename Unused>
    void drop(const Unused& unused);
    void forget_unused(const Job& job);
    bool is_processor();
    void plan(Job& job);
    void failed(const std::string& what);

    Options options_;
    mutable std::mutex mutex_;  ///< guards the members up to the next blank line
    std::condition_variable_any changed_;
    std::unique_ptr<Job> wanted_;  ///< not begun, or with stages left
    std::optional<DrawnPicture> ready_;
    std::string error_;
    bool drawing_ = false;
    double target_;
    Options::Rays rays_;
    std::uint64_t view_ = 0, finished_view_ = 0;  ///< of the last request; of the last finished picture

    std::atomic<bool> frozen_{false}, lose_{false};
    std::atomic<double> found_{1};
    std::atomic<std::uint64_t> asked_{0}, device_bytes_{0}, validation_messages_{0};
    // Used by the drawing thread.
    mutable std::mutex renderers_mutex_;
    std::map<Key, Held> renderers_;
    std::unique_ptr<Renderer> spare_;  ///< opened to query the device
    std::optional<bool> on_processor_;
    std::shared_ptr<const Volume> volume_;
    std::map<std::pair<std::shared_ptr<const Volume>, int>, std::shared_ptr<const Volume>> levels_;
    std::optional<Pace> pace_, ray_pace_;
    std::optional<DrawnPicture> coarse_;    ///< the last coarse picture
    std::map<double, double> still_times_;  ///< milliseconds of splatted pictures at level 0, by scale
    std::uint64_t messages_before_ = 0;     ///< of destroyed renderers
    std::jthread thread_;                   ///< last: ends before the other members are destroyed
};

}  // namespace edgesplat::viewer
