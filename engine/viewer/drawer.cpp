#include "engine/viewer/drawer.h"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <utility>

#include "engine/error.h"
#include "engine/plan/plan.h"
#include "engine/scene/ladder.h"
#include "engine/viewer/display.h"
#include "engine/volume/packed_volume.h"
#include "engine/volume/sample_source.h"

namespace edgesplat::viewer {
namespace {

using Clock = std::chrono::steady_clock;

// Voxels that can be estimated and collected within a picture's time.
constexpr std::size_t kQuickVoxelsSoftware = std::size_t{1} << 17U, kQuickVoxels = std::size_t{1} << 25U;

/// A picture faster than this needs no coarser one before it, milliseconds.
constexpr double kSoon = 350;

constexpr double kHalfScale = 0.5;

constexpr int kNiceness = 5;

glm::ivec2 scaled(const glm::ivec2& size, double scale) {
    return glm::max(glm::ivec2(glm::round(glm::dvec2(size) * scale)), 1);
}

/// Cheaper settings for a picture that is shown for a moment. At level 0 the edge estimator stays: its splats are those
/// of the best picture and are estimated only once.
Settings hasty(Settings settings, int level, bool several_volumes) {
    settings.sheets = SheetCut::Whole;
    settings.sheet_spacing = Settings{}.sheet_spacing;
    settings.sheet_format = SheetFormat::Tiles;
    settings.detail = 0;
    // Surfaces of several volumes need the spline's edges.
    if (level == 0 || settings.edges == EdgeEstimator::Off || several_volumes) return settings;
    settings.edges = EdgeEstimator::Taylor;
    return settings;
}

Settings without_edges(Settings settings) {
    settings.edges = EdgeEstimator::Off;
    return settings;
}

}  // namespace

/// A request and its remaining stages.
struct Drawer::Job {
    struct Stage {
        Rung rung;
        bool best = false;
    };
    DrawRequest request;
    std::uint64_t number = 0, view = 0;
    bool planned = false, finished_before = false;  ///< finished_before: a finished picture of this view is shown
    std::vector<Stage> stages;                      ///< the next one is last
};

int Drawer::coarsest_level(const Volume& volume, bool software) {
    const std::size_t most = software ? kQuickVoxelsSoftware : kQuickVoxels;
    // In memory any level can be made; a file has only its stored levels.
    constexpr int kFewest = 24;  // voxels along the longest axis; below this nothing is recognisable
    const auto has = [&](int level) {
        const glm::ivec3 dims = level_geometry(volume.geometry, level).dims;
        return volume.values.empty() ? level < level_count(volume) : std::max({dims.x, dims.y, dims.z}) >= kFewest;
    };
    int level = 0;
    while (has(level + 1) && level_geometry(volume.geometry, level).voxel_count() > most)
        ++level;
    return level;
}

Drawer::Drawer(Options options) : options_(std::move(options)), target_(options_.target), rays_(options_.rays) {
    if (options_.threaded) thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

Drawer::~Drawer() {
    ++asked_;  // cancels the picture being drawn
    if (thread_.joinable()) thread_.request_stop();
}

std::uint64_t Drawer::ask(DrawRequest request) {
    const std::lock_guard lock(mutex_);
    wanted_ = std::make_unique<Job>();
    wanted_->request = std::move(request);
    wanted_->number = ++asked_;
    wanted_->view = wanted_->request.same_view ? view_ : ++view_;
    changed_.notify_all();
    return wanted_->number;
}

std::optional<DrawnPicture> Drawer::take() {
    if (!options_.threaded) return draw_next();
    const std::lock_guard lock(mutex_);
    return std::exchange(ready_, std::nullopt);
}

bool Drawer::busy() const {
    const std::lock_guard lock(mutex_);
    return wanted_ || drawing_ || ready_;
}

std::string Drawer::take_error() {
    const std::lock_guard lock(mutex_);
    return std::exchange(error_, {});
}

void Drawer::set_target(double milliseconds) {
    const std::lock_guard lock(mutex_);
    target_ = milliseconds;
}

void Drawer::set_rays(Options::Rays rays) {
    const std::lock_guard lock(mutex_);
    rays_ = rays;
}

std::size_t Drawer::renderers() const {
    const std::lock_guard lock(renderers_mutex_);
    return renderers_.size();
}

void Drawer::run(const std::stop_token& stop) {
    // If drawing uses the processor, the window has priority. Driver threads that are created here inherit this.
    setpriority(PRIO_PROCESS, 0, kNiceness);
    while (!stop.stop_requested()) {
        {
            std::unique_lock lock(mutex_);
            if (!changed_.wait(lock, stop, [this] { return wanted_ != nullptr; })) return;
        }
        draw_next();
    }
}

std::optional<DrawnPicture> Drawer::draw_next() {
    std::unique_ptr<Job> job;
    {
        const std::lock_guard lock(mutex_);
        if (!wanted_) return std::nullopt;
        job = std::move(wanted_);
        drawing_ = true;
        for (auto* pace : {&pace_, &ray_pace_})
            if (*pace) (*pace)->set_target(target_);
        options_.target = target_;
        options_.rays = rays_;
        job->finished_before = job->view == finished_view_;
    }
    std::optional<DrawnPicture> picture;
    try {
        plan(*job);
        picture = draw(*job);
        if (picture->stats.complete) job->stages.pop_back();  // else the next picture draws more blocks
        picture->finished = job->stages.empty();
    } catch (const Interrupted&) {
        job->stages.clear();
    } catch (const std::exception& error) {
        failed(error.what());
        job->stages.clear();
    }
    const std::lock_guard lock(mutex_);
    drawing_ = false;
    if (picture && picture->finished && !picture->moving) finished_view_ = job->view;
    if (!job->stages.empty() && !wanted_) wanted_ = std::move(job);
    if (!options_.threaded) return picture;
    if (picture) ready_ = std::move(picture);
    return std::nullopt;
}

void Drawer::failed(const std::string& what) {
    drop([](const Key&) { return true; });
    coarse_.reset();
    const std::lock_guard lock(mutex_);
    finished_view_ = 0;
    error_ = what;
}

bool Drawer::is_processor() {
    if (!on_processor_) {
        spare_ = std::make_unique<Renderer>(options_.device);
        on_processor_ = spare_->device().is_processor;
    }
    return *on_processor_;
}

bool Drawer::casts_rays(const DrawRequest& request) {
    using Rays = Options::Rays;
    const bool wanted = options_.rays == Rays::Always || options_.rays == Rays::Cubic ||
                        (options_.rays == Rays::OnProcessor && is_processor());
    return wanted && !request.plain && !request.volume->values.empty() && raycast_obstacle(request.scene).empty() &&
           request.settings.edges != EdgeEstimator::Off;
}

Rung Drawer::quick_rung(const DrawRequest& request, bool rays) {
    Rung rung = pace_of(rays).rung();
    // In narrow passages a coarse level may put the eye inside matter and show nothing else.
    const bool outside = rung.level > 0 && !eye_in_opaque(*request.volume, request.scene, request.camera);
    while (rung.level > 0 && outside &&
           eye_in_opaque(*level_of(request.volume, rung.level), request.scene, request.camera)) {
        --rung.level;
        rung.scale = std::max(pace_scales().front(), rung.scale / 2);
    }
    return rung;
}

void Drawer::plan(Job& job) {
    if (job.planned) return;
    job.planned = true;
    if (volume_ != job.request.volume) {
        drop([](const Key&) { return true; });
        levels_.clear();
        still_times_.clear();
        coarse_.reset();
        pace_.reset();
        ray_pace_.reset();
        volume_ = job.request.volume;
    }
    std::erase_if(levels_, [&](const auto& entry) {
        const auto is_drawn = [&](const AddedVolume& added) { return added.volume == entry.first.first; };
        return entry.first.first != volume_ && std::ranges::none_of(job.request.scene.added, is_drawn);
    });
    if (!pace_) {
        pace_.emplace(options_.target, coarsest_level(*volume_, is_processor()));
        ray_pace_.emplace(options_.target, 0, true);
    }
    forget_unused(job);
    using Stage = Job::Stage;
    const bool rays = casts_rays(job.request);
    const Stage quick{quick_rung(job.request, rays)};
    if (job.request.moving) {
        job.stages = {quick};
        return;
    }
    if (job.request.best) job.stages.push_back({{0, 1.0}, true});
    job.stages.push_back({{0, 1.0}});
    const auto time = [&](double scale) {
        const auto known = still_times_.find(scale);
        return known != still_times_.end() ? known->second : 1e9;
    };
    if (time(1) <= kSoon || job.finished_before) return;
    if (!rays) job.stages.push_back({{0, kHalfScale}});
    if (rays || time(kHalfScale) > kSoon) job.stages.push_back(quick);
}

template <typename Unused>
void Drawer::drop(const Unused& unused) {
    const std::lock_guard lock(renderers_mutex_);
    std::erase_if(renderers_, [&](const auto& entry) {
        if (!unused(entry.first)) return false;
        if (entry.second.renderer) messages_before_ += entry.second.renderer->validation_messages();
        return true;
    });
}

void Drawer::forget_unused(const Job& job) {
    drop([&](const Key& key) {
        return (key.kind == Kind::Plain && !job.request.plain) ||
               (key.kind == Kind::Best && !job.request.best && !job.request.moving);
    });
}

std::shared_ptr<const Volume> Drawer::level_of(const std::shared_ptr<const Volume>& volume, int level) {
    if (level == 0) return volume;
    auto& found = levels_[{volume, level}];
    if (!found) {
        found = volume->values.empty() ? std::make_shared<const Volume>(load_level(*volume, level))
                                       : std::make_shared<const Volume>(halved(*level_of(volume, level - 1)));
    }
    return found;
}

Renderer& Drawer::renderer_for(const Key& key, const Job& job) {
    const std::lock_guard lock(renderers_mutex_);
    Held& held = renderers_[key];
    if (!held.renderer) {
        held.renderer = spare_ ? std::move(spare_) : std::make_unique<Renderer>(options_.device);
        held.renderer->set_memory_budget(options_.memory_budget);
        held.renderer->set_volume(level_of(job.request.volume, key.level));
        if (key.level == 0 && job.request.volume->values.empty()) held.renderer->set_patience(kSoon);
    }
    return *held.renderer;
}

Image Drawer::draw_kind(Kind kind, const Job& job, const Rung& rung, DrawnPicture& out) {
    const DrawRequest& request = job.request;
    const Key key{rung.level, kind};
    Renderer& renderer = renderer_for(key, job);
    // A picture in motion is short; cancelling it would not make the next one better.
    const bool may_stop = options_.threaded && !request.moving;
    renderer.set_interruption(may_stop ? std::function<bool()>([this, number = job.number] { return asked_ != number; })
                                       : std::function<bool()>());
    found_ = 1;
    renderer.set_progress([this](double share) { found_ = share; });
    Scene scene = request.scene;
    scene.effects.overlays = {};
    for (AddedVolume& added : scene.added)
        added.volume = level_of(added.volume, std::min(rung.level, coarsest_level(*added.volume, is_processor())));
    Settings settings = kind == Kind::Best ? *request.best : request.settings;
    const bool hurry = rung.scale < 1 || rung.level > 0 || request.moving;
    if (hurry) {
        scene.effects.samples = 1;
        settings = hasty(settings, rung.level, !scene.added.empty());
    }
    if (kind == Kind::Plain) settings = without_edges(settings);
    const glm::ivec2 size = scaled(request.size, rung.scale);
    if (lose_.exchange(false)) renderer.simulate_device_loss();
    const auto filter = options_.rays == Options::Rays::Cubic ? RaycastFilter::Cubic : RaycastFilter::Trilinear;
    RenderResult result = rung.rays
                              ? renderer.raycast(scene, request.camera, settings, {.filter = filter}, size.x, size.y)
                              : renderer.render(scene, request.camera, settings, size.x, size.y);
    out.setup += result.stats.setup_milliseconds + result.stats.pipeline_milliseconds;
    if (kind != Kind::Plain) out.stats = std::move(result.stats);
    const std::lock_guard lock(renderers_mutex_);
    if (!rung.rays) renderers_.at(key).scene_number = request.scene_number;
    std::uint64_t bytes = 0, messages = messages_before_;
    for (const auto& [other, held] : renderers_) {
        bytes += held.renderer->held_bytes();
        messages += held.renderer->validation_messages();
    }
    device_bytes_ = bytes;
    validation_messages_ = messages;
    return std::move(result.color);
}

DrawnPicture Drawer::draw(const Job& job) {
    const Job::Stage& stage = job.stages.back();
    DrawnPicture out;
    out.number = job.number;
    out.rung = stage.rung;
    out.moving = job.request.moving;
    out.best = stage.best;
    const auto start = Clock::now();
    out.color = draw_kind(stage.best ? Kind::Best : Kind::Warped, job, stage.rung, out);
    if (job.request.plain) out.plain = draw_kind(Kind::Plain, job, stage.rung, out);
    out.milliseconds = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
    const bool hurried = stage.rung.scale < 1 || stage.rung.level > 0 || stage.rung.rays;
    Pace& pace = pace_of(stage.rung.rays);
    if (!frozen_ && stage.rung == pace.rung() && (job.request.moving || hurried)) {
        const auto finer = renderers_.find({stage.rung.level - 1, Kind::Warped});
        pace.drawn(out.milliseconds, std::min(out.setup, out.milliseconds),
                   finer != renderers_.end() && finer->second.scene_number == job.request.scene_number);
    }
    if (stage.rung.level == 0 && !stage.rung.rays && !stage.best)
        still_times_[stage.rung.scale] = out.milliseconds - out.setup;
    if (hurried && !job.request.moving && (!coarse_ || coarse_->number != job.number)) coarse_ = out;
    if (!hurried && coarse_ && coarse_->number == job.number) {
        out.coarse_error = rms_after_upscaling(coarse_->color, out.color);
        out.coarse_rung = coarse_->rung;
    }
    return out;
}

}  // namespace edgesplat::viewer
