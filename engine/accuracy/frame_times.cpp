#include "engine/accuracy/frame_times.h"

#include <algorithm>
#include <ctime>
#include <numeric>
#include <random>

namespace edgesplat::accuracy {
namespace {

using nlohmann::ordered_json;

struct Cost {
    double wall = 0, processor = 0;  ///< ms
};

double processor_milliseconds() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

/// Cost of a frame; `stats` receives its statistics.
template <typename Render>
Cost cost_of(const Render& render, RenderStats& stats) {
    const double begin = processor_milliseconds();
    stats = render();
    return {stats.frame_milliseconds, processor_milliseconds() - begin};
}

/// Keeps the times of the passes of every frame, without the setup's.
void keep_passes(const RenderStats& stats, TimedVisit& visit) {
    auto& passes = visit.passes;
    visit.frames.push_back(stats.passes);
    for (const PassTime& pass : stats.passes) {
        const auto found =
            std::find_if(passes.begin(), passes.end(), [&](const auto& p) { return p.first == pass.name; });
        if (found == passes.end())
            passes.emplace_back(pass.name, pass.milliseconds);
        else
            found->second = std::min(found->second, pass.milliseconds);
    }
}

}  // namespace

TimedVisit time_visit(Renderer& renderer, const Scene& scene, const Camera& camera, const Settings& settings, int width,
                      int height, const VisitLimits& limits) {
    return time_visit([&] { return renderer.render(scene, camera, settings, width, height).stats; },
                      [&] { return renderer.raycast(scene, camera, settings, {}, width, height).stats; }, limits);
}

TimedVisit time_visit(const std::function<RenderStats()>& frame, const std::function<RenderStats()>& ray,
                      const VisitLimits& limits) {
    TimedVisit visit;
    const RenderStats first = frame();
    visit.setup_milliseconds = first.setup_milliseconds;
    double once = ray().frame_milliseconds;
    for (int i = 0; i < limits.triples && (i == 0 || (i + 1) * once < limits.milliseconds); ++i) {
        RenderStats stats;
        const Cost before = cost_of(frame, stats);
        keep_passes(stats, visit);
        const Cost between = cost_of(ray, stats);
        const Cost after = cost_of(frame, stats);
        keep_passes(stats, visit);
        visit.submissions = stats.submissions;
        visit.triples.push_back({before.wall, between.wall, after.wall});
        visit.processor_triples.push_back({before.processor, between.processor, after.processor});
        once = before.wall + between.wall + after.wall;
    }
    // Passes that only the first frame executed.
    for (const PassTime& pass : first.passes) {
        const bool every =
            std::any_of(visit.passes.begin(), visit.passes.end(), [&](const auto& p) { return p.first == pass.name; });
        if (!every) visit.setup_passes.push_back(pass);
    }
    return visit;
}

ordered_json to_json(const TimedVisit& visit) {
    const auto list_of = [](const std::vector<TimedTriple>& triples) {
        ordered_json list = ordered_json::array();
        for (const TimedTriple& t : triples)
            list.push_back({t.before, t.ray, t.after});
        return list;
    };
    ordered_json passes = ordered_json::object();
    for (const auto& [name, ms] : visit.passes)
        passes[name] = ms;
    return {{"triples_ms", list_of(visit.triples)},
            {"processor_triples_ms", list_of(visit.processor_triples)},
            {"passes_ms", passes},
            {"setup_ms", visit.setup_milliseconds}};
}

TimedVisit timed_visit_from(const ordered_json& json) {
    TimedVisit visit;
    const auto read = [&](const char* key, std::vector<TimedTriple>& triples) {
        for (const ordered_json& t : json.at(key))
            triples.push_back({t.at(0), t.at(1), t.at(2)});
    };
    read("triples_ms", visit.triples);
    read("processor_triples_ms", visit.processor_triples);
    for (const auto& [name, ms] : json.at("passes_ms").items())
        visit.passes.emplace_back(name, ms);
    visit.setup_milliseconds = json.at("setup_ms");
    return visit;
}

RatioClock ratio_clock(const DeviceInfo& device) {
    return device.is_processor ? RatioClock::Processor : RatioClock::Wall;
}

std::string_view name_of(RatioClock clock) {
    return clock == RatioClock::Processor ? "processor" : "wall";
}

FrameTimes summarise(std::span<const TimedVisit> visits, RatioClock clock) {
    std::vector<double> frames, ratios, wall_ratios, rays;
    std::vector<std::pair<std::string, std::vector<double>>> passes;
    for (const TimedVisit& visit : visits) {
        for (const TimedTriple& t : visit.triples) {
            frames.push_back(t.before);
            frames.push_back(t.after);
            rays.push_back(t.ray);
            wall_ratios.push_back(t.ratio());
        }
        for (const TimedTriple& t : clock == RatioClock::Processor ? visit.processor_triples : visit.triples)
            ratios.push_back(t.ratio());
        for (const auto& [name, ms] : visit.passes) {
            // Lambdas of C++20 cannot capture a binding by reference in every compiler.
            auto found = std::find_if(passes.begin(), passes.end(),
                                      [&pass = name](const auto& known) { return known.first == pass; });
            if (found == passes.end()) found = passes.insert(passes.end(), {name, {}});
            found->second.push_back(ms);
        }
    }
    FrameTimes times{spread(frames), spread(ratios), spread(wall_ratios), quantile(rays, 0.5), {}};
    for (const auto& [name, values] : passes)
        times.passes.emplace_back(name, quantile(values, 0.5));
    return times;
}

std::vector<std::size_t> order_of_round(std::size_t count, int round) {
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::mt19937 random(static_cast<std::mt19937::result_type>(round) + 1);
    for (std::size_t i = count; i > 1; --i)
        std::swap(order[i - 1], order[random() % i]);
    return order;
}

}  // namespace edgesplat::accuracy
