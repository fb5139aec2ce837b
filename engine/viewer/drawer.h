// Pictures for a window: in time while something moves, better and better once everything stands.
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

/// What is to be seen.
struct DrawRequest {
    std::shared_ptr<const Volume> volume;
    Scene scene;
    Settings settings;
    std::uint64_t scene_number = 0;  ///< another one whenever volume, scene or settings differ
    Camera camera;
    glm::ivec2 size{0};   ///< pixels of the window's picture, each 1..16384
    bool plain = false;   ///< conventional splatting, too
    bool moving = false;  ///< one picture in time; else better ones until the best is there
    /// What is seen is what was seen at the request before, only drawn in another way: where that was finished it is
    /// kept until this is, and nothing coarser comes between.
    bool same_view = false;
    std::optional<Settings> best;  ///< what follows the finished picture of `settings`
};

/// A picture that was drawn.
struct DrawnPicture {
    std::uint64_t number = 0;  ///< of the request
    Image color;               ///< of the rung's size
    std::optional<Image> plain;
    Rung rung;
    bool moving = false;
    bool finished = false;    ///< nothing better follows
    bool best = false;        ///< of the request's best settings
    double milliseconds = 0;  ///< wall clock
    double setup = 0;         ///< the part of it that the next picture of the scene does not need
    RenderStats stats;
    /// Of a finished one: RMS of sRGB full scale by which the last coarse picture of the same request was off.
    std::optional<double> coarse_error;
    std::optional<Rung> coarse_rung;
};

/// Owns the renderers: one for each resolution and kind of picture, made when first needed.
class Drawer {
  public:
    struct Options {
        DeviceChoice device;
        std::uint64_t memory_budget = 0;  ///< bytes for each renderer; 0: what the device has
        double target = 150;              ///< milliseconds a picture may take while something moves
        /// Where pictures in motion are cast with rays if the scene can be (`beyond_ray_casting`): on a processor they
        /// are there several times as soon as splats.
        /// Cubic: through the spline, which is nearer to the truth and takes longer.
        enum class Rays { Never, OnProcessor, Always, Cubic } rays = Rays::OnProcessor;
        bool threaded = true;  ///< else pictures are drawn by `take`
    };
    explicit Drawer(Options options);
    ~Drawer();
    Drawer(const Drawer&) = delete;
    Drawer& operator=(const Drawer&) = delete;

    /// From now on this is to be seen. What is being drawn for an earlier request is left off, unless it is moving.
    /// Returns the request's number.
    std::uint64_t ask(DrawRequest request);
    /// The newest picture that was not taken yet. Without a thread the next one is drawn now.
    std::optional<DrawnPicture> take();
    /// Whether another picture of the last request will come.
    bool busy() const;
    /// What went wrong since the last call; empty: nothing. The next request is tried anew.
    std::string take_error();
    void set_target(double milliseconds);
    void set_rays(Options::Rays rays);
    /// Pictures in motion keep the resolution that they have, whatever they take: the same ones on every machine.
    void freeze_pace(bool on) { frozen_ = on; }
    /// The next picture finds its device lost, to see what becomes of it.
    void lose_device() { lose_ = true; }
    /// Bytes that the renderers hold on the device.
    std::uint64_t device_bytes() const { return device_bytes_; }
    /// Of all renderers that there were.
    std::uint64_t validation_messages() const { return validation_messages_; }
    /// Renderers that are held, for tests of what is not paid for.
    std::size_t renderers() const;
    /// The coarsest level that is drawn of a volume: small enough to be estimated anew with every picture.
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
    /// Draws the next picture and returns it, or with a thread leaves it for `take`.
    std::optional<DrawnPicture> draw_next();
    DrawnPicture draw(const Job& job);
    Image draw_kind(Kind kind, const Job& job, const Rung& rung, DrawnPicture& out);
    bool casts_rays(const DrawRequest& request);
    Rung quick_rung(const DrawRequest& request, bool rays);
    Pace& pace_of(bool rays) { return rays ? *ray_pace_ : *pace_; }
    Renderer& renderer_for(const Key& key, const Job& job);
    std::shared_ptr<const Volume> level_of(const std::shared_ptr<const Volume>& volume, int level);
    /// Lets go of the renderers that `unused` says; what validation told of them stays counted.
    template <typename Unused>
    void drop(const Unused& unused);
    void forget_unused(const Job& job);
    bool is_processor();
    void plan(Job& job);
    void failed(const std::string& what);

    Options options_;
    mutable std::mutex mutex_;  ///< guards what is between here and the next blank line
    std::condition_variable_any changed_;
    std::unique_ptr<Job> wanted_;  ///< not begun, or with pictures left
    std::optional<DrawnPicture> ready_;
    std::string error_;
    bool drawing_ = false;
    double target_;
    Options::Rays rays_;
    std::uint64_t view_ = 0, finished_view_ = 0;  ///< of the last request; of the last finished picture that stands

    std::atomic<bool> frozen_{false}, lose_{false};
    std::atomic<std::uint64_t> asked_{0}, device_bytes_{0}, validation_messages_{0};
    // Of the drawing thread alone.
    mutable std::mutex renderers_mutex_;
    std::map<Key, Held> renderers_;
    std::unique_ptr<Renderer> spare_;  ///< opened to see what device there is
    std::optional<bool> on_processor_;
    std::shared_ptr<const Volume> volume_;
    std::map<int, std::shared_ptr<const Volume>> levels_;
    std::optional<Pace> pace_, ray_pace_;
    std::optional<DrawnPicture> coarse_;    ///< the last one drawn in haste
    std::map<double, double> still_times_;  ///< milliseconds by scale, level 0
    std::uint64_t messages_before_ = 0;     ///< of renderers that are gone
    std::jthread thread_;                   ///< last: ends before anything else goes
};

}  // namespace edgesplat::viewer
