#include "engine/bench/run.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <memory>
#include <thread>

#include "engine/accuracy/report_cameras.h"
#include "engine/bench/host_memory.h"
#include "engine/error.h"
#include "engine/volume/packed_volume.h"

namespace edgesplat::bench {
namespace {

using Clock = std::chrono::steady_clock;
using VolumePointer = std::shared_ptr<const Volume>;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// A case with everything resolved that its pictures need.
struct Shot {
    const SuiteCase* from = nullptr;
    VolumePointer volume;
    Scene scene;
    Camera camera;
    Settings settings;
    glm::ivec2 size{0};
};

Shot shot_of(const SuiteCase& entry, const VolumePointer& volume) {
    Shot shot{.from = &entry,
              .volume = volume,
              .settings = entry.document.quality.settings,
              .size = entry.document.output.size};
    try {
        shot.scene = resolve_scene(entry.document, *volume);
        if (const std::string obstacle = raycast_obstacle(shot.scene); !obstacle.empty())
            fail("every case is compared with the ray caster, which does not support {}", obstacle);
        validate(shot.settings);
        if (entry.camera.empty()) {
            shot.camera = resolve_camera(entry.document, *volume, shot.scene);
            return shot;
        }
        const auto cameras = accuracy::report_cameras(*volume, shot.scene, shot.size.x, shot.size.y);
        const auto found = std::ranges::find(cameras, entry.camera, &accuracy::ReportCamera::name);
        if (found == cameras.end()) fail("camera: {}: this volume has no place for it", entry.camera);
        shot.camera = found->camera;
    } catch (const Error& error) {
        fail("{}: {}", entry.name, error.what());
    }
    return shot;
}

/// Runs the suite and collects its results.
class SuiteRun {
  public:
    SuiteRun(const Suite& suite, const BenchOptions& options, const accuracy::ProgressFunction& progress)
        : suite_(suite), options_(options), progress_(progress), budget_(options.budget.value_or(suite.budget)) {}

    BenchRun run() {
        BenchRun result{.suite = suite_.name, .about = suite_.about};
        result.cores = std::thread::hardware_concurrency();
        result.skipped = suite_.skipped;
        load(result);
        for (const Shot& shot : shots_) {
            report("cold: " + shot.from->name);
            result.cases.push_back(cold(shot));
            ++done_;
        }
        Renderer renderer(options_.device);
        result.device = renderer.device();
        measure(renderer, result);
        const accuracy::RatioClock clock = accuracy::ratio_clock(result.device);
        result.clock = accuracy::name_of(clock);
        for (std::size_t i = 0; i < shots_.size(); ++i)
            summarise(visits_[i], clock, result.cases[i]);
        result.scaling = scaling_of(result.cases);
        peak_ = std::max(peak_, host_peak_bytes());
        result.host_peak_bytes = peak_;
        result.seconds = seconds_since(start_);
        return result;
    }

  private:
    void load(BenchRun& result) {
        auto loaded = suite_.loaded;
        const auto folders = volume_folders(std::filesystem::path(suite_.file).parent_path());
        for (const SuiteCase& entry : suite_.cases) {
            report("volume of " + entry.name);
            const VolumeSource& source = entry.document.volume;
            auto found = std::ranges::find(loaded, source, &std::pair<VolumeSource, VolumePointer>::first);
            if (found == loaded.end()) {
                loaded.emplace_back(source, std::make_shared<const Volume>(load_source(source, folders)));
                found = loaded.end() - 1;
            }
            require_samples(*found->second, "bench");
            shots_.push_back(shot_of(entry, found->second));
        }
        if (shots_.empty() && result.skipped.empty()) fail("{}: no cases", suite_.file);
        visits_.resize(shots_.size());
        pieces_ = shots_.size() * 2;
    }

    RenderStats draw(Renderer& renderer, const Shot& shot) const {
        return renderer.render(shot.scene, shot.camera, shot.settings, shot.size.x, shot.size.y).stats;
    }

    CaseResult cold(const Shot& shot) {
        const SuiteCase& from = *shot.from;
        CaseResult result{.name = from.name, .group = from.group, .mode = from.mode, .series = from.series};
        result.volume = from.document.volume.path;
        result.checksum = fmt::format("{:016x}", shot.volume->checksum);
        result.dims = shot.volume->geometry.dims;
        result.size = shot.size;
        peak_ = std::max(peak_, host_peak_bytes());
        (void)reset_host_peak();
        const auto begin = Clock::now();
        Renderer renderer(options_.device);
        result.cold.startup_ms = 1e3 * seconds_since(begin);
        renderer.set_volume(shot.volume);
        // Counting adds almost nothing to a first picture, while another picture for it would take long.
        renderer.count_fragments(true);
        const auto first = Clock::now();
        result.stats = draw(renderer, shot);
        result.cold.first_picture_ms = 1e3 * seconds_since(first);
        result.cold.pipelines = result.stats.pipelines_made;
        result.cold.pipeline_ms = result.stats.pipeline_milliseconds;
        result.host_peak_bytes = host_peak_bytes();
        return result;
    }

    void measure(Renderer& renderer, BenchRun& result) {
        VolumePointer current;
        double longest = 0;
        const int most = options_.rounds.value_or(1000);
        for (int round = 0; round < most; ++round) {
            // Another round only if it will end in time.
            if (!options_.rounds && round > 0 && seconds_since(start_) + longest > budget_) break;
            const auto begin = Clock::now();
            if (round > 0) pieces_ += shots_.size();
            for (const std::size_t i : accuracy::order_of_round(shots_.size(), round)) {
                const Shot& shot = shots_[i];
                report(fmt::format("round {}: {}", round + 1, shot.from->name));
                if (current != shot.volume) renderer.set_volume(shot.volume);
                current = shot.volume;
                visits_[i].push_back(accuracy::time_visit(renderer, shot.scene, shot.camera, shot.settings, shot.size.x,
                                                          shot.size.y, options_.visit));
                ++done_;
            }
            longest = std::max(longest, seconds_since(begin));
            ++result.rounds;
        }
    }

    static NamedTimes sampled_passes(const std::vector<const std::vector<PassTime>*>& lists) {
        std::vector<std::string> names;
        std::map<std::string, std::vector<double>> values;
        for (const auto* list : lists) {
            for (const PassTime& pass : *list) {
                if (!values.contains(pass.name)) names.push_back(pass.name);
                values[pass.name].push_back(pass.milliseconds);
            }
        }
        NamedTimes times;
        for (const std::string& name : names)
            times.emplace_back(name, sampled(values[name]));
        return times;
    }

    static void summarise(const std::vector<accuracy::TimedVisit>& visits, accuracy::RatioClock clock,
                          CaseResult& result) {
        std::vector<double> frames, rays, processor, ratios, wall_ratios, setups;
        std::vector<const std::vector<PassTime>*> passes, setup_passes;
        for (const accuracy::TimedVisit& visit : visits) {
            for (const accuracy::TimedTriple& t : visit.triples) {
                frames.insert(frames.end(), {t.before, t.after});
                rays.push_back(t.ray);
                wall_ratios.push_back(t.ratio());
            }
            for (const accuracy::TimedTriple& t : visit.processor_triples) {
                processor.insert(processor.end(), {t.before, t.after});
                if (clock == accuracy::RatioClock::Processor) ratios.push_back(t.ratio());
            }
            for (const auto& frame : visit.frames)
                passes.push_back(&frame);
            result.stats.submissions = visit.submissions;
            if (visit.setup_milliseconds <= 0) continue;
            setups.push_back(visit.setup_milliseconds);
            setup_passes.push_back(&visit.setup_passes);
        }
        result.frame = sampled(frames);
        result.raycast = sampled(rays);
        result.processor = sampled(processor);
        result.wall_ratio = sampled(wall_ratios);
        result.ratio = clock == accuracy::RatioClock::Processor ? sampled(ratios) : result.wall_ratio;
        result.passes = sampled_passes(passes);
        std::vector<PassTime> cold;
        // The previous case may have left its splats. Then only the cold start has a setup.
        if (setups.empty()) {
            setups.push_back(result.stats.setup_milliseconds);
            for (const PassTime& pass : result.stats.passes)
                if (std::ranges::find(result.passes, pass.name, &NamedTimes::value_type::first) == result.passes.end())
                    cold.push_back(pass);
            setup_passes.push_back(&cold);
        }
        result.setup = sampled(setups);
        result.setup_passes = sampled_passes(setup_passes);
    }

    /// Reports progress. Throws Interrupted if the progress function returns false.
    void report(const std::string& what) const {
        const double spent = seconds_since(start_);
        const double by_pieces = pieces_ > 0 ? static_cast<double>(done_) / static_cast<double>(pieces_) : 0;
        double left = by_pieces > 0 ? spent / by_pieces - spent : 0;
        // The first round is measured even if it exceeds the budget.
        if (!options_.rounds) left = std::max(done_ < 2 * shots_.size() ? left : 0, budget_ - spent);
        const double share = spent / std::max(spent + left, 1e-9);
        if (!progress_({share, left, done_, pieces_, what}))
            throw accuracy::Interrupted("stopped; nothing was written");
    }

    const Suite& suite_;
    const BenchOptions& options_;
    const accuracy::ProgressFunction& progress_;
    double budget_;
    Clock::time_point start_ = Clock::now();
    std::vector<Shot> shots_;
    std::vector<std::vector<accuracy::TimedVisit>> visits_;
    std::size_t done_ = 0, pieces_ = 0;
    std::uint64_t peak_ = 0;
};

}  // namespace

BenchRun run_suite(const Suite& suite, const BenchOptions& options, const accuracy::ProgressFunction& progress) {
    return SuiteRun(suite, options, progress).run();
}

std::vector<Scaling> scaling_of(const std::vector<CaseResult>& cases) {
    std::vector<Scaling> scaling;
    std::vector<std::vector<const CaseResult*>> families;
    for (const CaseResult& entry : cases) {
        if (entry.series.empty()) continue;
        const auto same = std::ranges::find_if(families, [&](const auto& family) {
            const CaseResult& first = *family.front();
            return first.series == entry.series && first.mode == entry.mode && first.size == entry.size;
        });
        if (same == families.end())
            families.push_back({&entry});
        else
            same->push_back(&entry);
    }
    for (const auto& family : families) {
        std::vector<std::pair<double, double>> frames, setups;
        for (const CaseResult* entry : family) {
            frames.emplace_back(static_cast<double>(entry->stats.splats_drawn), entry->frame.median);
            setups.emplace_back(entry->voxels(), entry->setup.median);
        }
        const CaseResult& first = *family.front();
        if (const auto fit = fit_power(frames))
            scaling.push_back({first.series, first.mode, first.size, "frame_ms_of_splats_drawn", *fit});
        if (const auto fit = fit_power(setups))
            scaling.push_back({first.series, first.mode, first.size, "setup_ms_of_voxels", *fit});
    }
    return scaling;
}

}  // namespace edgesplat::bench
