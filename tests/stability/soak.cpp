#include "tests/stability/soak.h"

#include <fmt/format.h>
#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <random>

#include "engine/renderer.h"
#include "engine/scene/scene_document.h"
#include "engine/scene/settings.h"
#include "engine/volume/analytic_volumes.h"

namespace edgesplat::test {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kVisitors = 3;  ///< renderers that are created and destroyed
constexpr int kMostStay = 60;         ///< largest number of frames that one of them draws
constexpr double kVisits = 0.2;       ///< share of frames that they draw

double allocated_mib() {
    const struct mallinfo2 info = mallinfo2();
    return static_cast<double>(info.uordblks + info.hblkhd) / (1024.0 * 1024.0);
}

int open_descriptors() {
    const std::filesystem::directory_iterator all("/proc/self/fd");
    return static_cast<int>(std::distance(begin(all), end(all))) - 1;  // without the descriptor of this listing
}

/// The content of a frame.
struct Shot {
    std::shared_ptr<const Volume> volume;
    Scene scene;
    Camera camera;
    Settings settings;
    glm::ivec2 size{32, 32};
    AovRequest aovs;
    bool rays = false;
};

class Shots {
  public:
    Shots(std::uint32_t seed, int looks) : random_(seed) {
        for (const std::string_view name : analytic_scene_names())
            for (const int side : {12, 20})
                volumes_.push_back(sampled(name, side));
        for (int i = 0; i < looks; ++i) {
            Shot look;
            look.settings = settings();
            effects(look);
            looks_.push_back(look);
        }
    }

    /// The first shot: independent of the random numbers.
    Shot first() const {
        Shot shot;
        shot.volume = volumes_.front();
        shot.scene = scene_of(*shot.volume);
        shot.camera = {.eye = center_of(*shot.volume) - glm::dvec3(0, 2, 0) * extent_of(*shot.volume)};
        return shot;
    }

    Shot next() {
        Shot shot = looks_[below(looks_.size())];
        shot.volume = volumes_[below(volumes_.size())];
        Scene scene = scene_of(*shot.volume);
        scene.effects = shot.scene.effects;
        scene.lights = shot.scene.lights;
        shot.scene = std::move(scene);
        const double extent = extent_of(*shot.volume);
        for (auto* planes : {&shot.scene.effects.clip.keep, &shot.scene.effects.clip.remove})
            for (Plane& plane : *planes)
                plane.point = center_of(*shot.volume);
        const glm::dvec3 aim = center_of(*shot.volume) + 0.3 * extent * direction();
        shot.camera.eye = center_of(*shot.volume) + extent * std::exp(real(-2, 1.2)) * direction();
        shot.camera.direction = aim - shot.camera.eye;
        shot.camera.up = direction();
        shot.camera.fov_y = real(10, 110);
        shot.size = {16 + static_cast<int>(below(81)), 16 + static_cast<int>(below(81))};
        shot.aovs = {.tau = chance(0.1), .depth = chance(0.1), .normal = chance(0.1), .distance = chance(0.1)};
        shot.rays = chance(0.1) && raycast_obstacle(shot.scene).empty();
        return shot;
    }

    std::size_t below(std::size_t count) { return std::uniform_int_distribution<std::size_t>(0, count - 1)(random_); }
    bool chance(double share) { return real(0, 1) < share; }

  private:
    static std::shared_ptr<const Volume> sampled(std::string_view name, int side) {
        return std::make_shared<const Volume>(sample(resized(analytic_scene(name), glm::ivec3(side))));
    }
    static Scene scene_of(const Volume& volume) {
        SceneDocument document;
        document.iso_values = {0.5 * (static_cast<double>(volume.min_value) + static_cast<double>(volume.max_value))};
        return resolve_scene(document, volume);
    }
    static glm::dvec3 center_of(const Volume& volume) { return volume.geometry.center(); }
    static double extent_of(const Volume& volume) {
        return glm::length(volume.geometry.spacing() * glm::dvec3(volume.geometry.dims));
    }
    double real(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
    glm::dvec3 direction() {
        const double z = real(-1, 1), angle = real(-M_PI, M_PI), r = std::sqrt(1 - z * z);
        return {r * std::cos(angle), r * std::sin(angle), z};
    }
    template <typename Value>
    Value one_of(std::initializer_list<Value> values) {
        return values.begin()[below(values.size())];
    }

    Settings settings() {
        Settings s;
        s.edges = one_of({EdgeEstimator::Off, EdgeEstimator::Taylor, EdgeEstimator::March, EdgeEstimator::Cubic});
        s.footprints =
            one_of({FootprintMode::Isotropic, FootprintMode::Warp2d, FootprintMode::Procedural, FootprintMode::Table});
        s.warp = one_of({WarpFamily::Paper, WarpFamily::Face});
        s.sheets = one_of({SheetCut::Whole, SheetCut::Sliced});
        s.sheet_format = one_of({SheetFormat::Layers, SheetFormat::Tiles});
        s.sheet_spacing = one_of({0.25, 0.5, 1.0});
        s.saturation = one_of({0.99, 0.999, 1.0});
        s.cull_buried = chance(0.5);
        return s;
    }

    void effects(Shot& shot) {
        Effects& e = shot.scene.effects;
        constexpr double kExtent = 20;  // mm, about that of the volumes
        if (chance(0.2)) e.fog = Fog{.density = real(0, 0.1), .start = real(0, kExtent)};
        if (chance(0.2)) e.silhouette = Silhouette{.strength = real(0, 1)};
        if (chance(0.15)) e.occlusion = AmbientOcclusion{.radius = 0.2 * kExtent};
        if (chance(0.15))
            shot.scene.lights = {Light{.kind = Light::Kind::Directional, .direction = direction(), .shadows = true}};
        if (chance(0.2)) e.clip.keep = {Plane{.normal = direction()}};
        if (chance(0.1)) e.clip.remove = {Plane{.normal = direction()}};
        if (chance(0.2)) e.background_top = glm::dvec3(0.1, 0.2, 0.4);
        e.antialias = chance(0.2);
        e.samples = chance(0.1) ? 2 : 1;
        e.smooth_outlines = shot.settings.sheet_format == SheetFormat::Tiles && chance(0.2);
        if (chance(0.1)) e.overlays = {.orientation = true, .scale_bar = true, .legend = true};
    }

    std::mt19937 random_;
    std::vector<std::shared_ptr<const Volume>> volumes_;
    std::vector<Shot> looks_;
};

/// A renderer with its current volume.
struct Held {
    Renderer renderer;
    std::shared_ptr<const Volume> volume;
    int stay = 0;
    std::uint64_t messages = 0;  ///< validation messages that were already reported

    RenderResult draw(const Shot& shot) {
        if (volume != shot.volume) renderer.set_volume(shot.volume);
        volume = shot.volume;
        return shot.rays ? renderer.raycast(shot.scene, shot.camera, shot.settings, {}, shot.size.x, shot.size.y)
                         : renderer.render(shot.scene, shot.camera, shot.settings, shot.size.x, shot.size.y, shot.aovs);
    }
};

bool finite(const RenderResult& result) {
    const auto all = [](const Image& image) {
        return std::ranges::all_of(image.pixels, [](float value) { return std::isfinite(value); });
    };
    bool good = all(result.color);
    for (const auto* image : {&result.tau, &result.depth, &result.normal, &result.distance})
        good &= !*image || all(**image);
    return good;
}

}  // namespace

void leave_no_holes() {
    mallopt(M_MMAP_THRESHOLD, 1 << 16);
    mallopt(M_ARENA_MAX, 1);
}

double resident_mib() {
    malloc_trim(0);
    std::ifstream file("/proc/self/statm");
    double all = 0, resident = 0;
    file >> all >> resident;
    return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1024.0 * 1024.0);
}

SoakResult soak(const SoakOptions& options, const std::function<void(const SoakSample&)>& note) {
    SoakResult result;
    Shots shots(options.seed, options.looks);
    const DeviceChoice device{.device = {}, .validation = options.validation};
    Held always{Renderer(device), {}, 0};
    const Shot first = shots.first();
    const std::vector<float> wanted = always.draw(first).color.pixels;
    std::vector<std::unique_ptr<Held>> visitors(kVisitors);
    auto begin = Clock::now();
    for (int frame = 1; frame <= options.frames; ++frame) {
        const Shot shot = shots.next();
        Held* drawn_by = &always;
        if (shots.chance(kVisits)) {
            auto& visitor = visitors[shots.below(kVisitors)];
            if (!visitor || --visitor->stay < 0)
                visitor = std::make_unique<Held>(Held{Renderer(device), {}, static_cast<int>(shots.below(kMostStay))});
            drawn_by = visitor.get();
        }
        try {
            if (!finite(drawn_by->draw(shot))) result.problems.push_back(fmt::format("frame {}: not finite", frame));
        } catch (const Error& error) {
            result.problems.push_back(fmt::format("frame {}: {}", frame, error.what()));
        }
        if (const std::uint64_t now = drawn_by->renderer.validation_messages(); now != drawn_by->messages) {
            result.problems.push_back(fmt::format("frame {}: {} validation messages", frame, now - drawn_by->messages));
            drawn_by->messages = now;
        }
        if (frame % options.every != 0) continue;
        const double spent = std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
        for (auto& visitor : visitors)
            visitor.reset();
        if (always.draw(first).color.pixels != wanted)
            result.problems.push_back(fmt::format("frame {}: the first picture has changed", frame));
        result.samples.push_back({frame, resident_mib(), allocated_mib(), always.renderer.held_bytes(),
                                  open_descriptors(), spent / options.every});
        if (note) note(result.samples.back());
        begin = Clock::now();
    }
    return result;
}

double host_growth(const std::vector<SoakSample>& samples, int from) {
    double count = 0, x = 0, y = 0, xx = 0, xy = 0, last = from;
    for (const SoakSample& s : samples) {
        if (s.frame < from) continue;
        ++count;
        x += s.frame;
        y += s.host_mib;
        xx += static_cast<double>(s.frame) * s.frame;
        xy += s.frame * s.host_mib;
        last = s.frame;
    }
    const double spread = count * xx - x * x;
    return spread > 0 ? (count * xy - x * y) / spread * (last - from) / (y / count) : 0;
}

}  // namespace edgesplat::test
