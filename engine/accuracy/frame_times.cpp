#include "engine/accuracy/frame_times.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace edgesplat::accuracy {
namespace {

using nlohmann::ordered_json;

constexpr double kVisitMilliseconds = 120;  ///< that frames faster than this are repeated for
constexpr int kMostTriples = 6;

/// Of passes that every frame has; the setup's are left out.
void keep_fastest(const RenderStats& stats, std::vector<std::pair<std::string, double>>& passes) {
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
                      int height) {
    TimedVisit visit;
    const auto frame = [&] { return renderer.render(scene, camera, settings, width, height).stats; };
    const auto ray = [&] {
        return renderer.raycast(scene, camera, settings, RaycastSettings{}, width, height).stats.frame_milliseconds;
    };
    visit.setup_milliseconds = frame().setup_milliseconds;
    double once = ray();
    for (int i = 0; i < kMostTriples && (i == 0 || (i + 1) * once < kVisitMilliseconds); ++i) {
        TimedTriple triple;
        RenderStats stats = frame();
        triple.before = stats.frame_milliseconds;
        keep_fastest(stats, visit.passes);
        triple.ray = ray();
        stats = frame();
        triple.after = stats.frame_milliseconds;
        keep_fastest(stats, visit.passes);
        visit.triples.push_back(triple);
        once = triple.before + triple.ray + triple.after;
    }
    return visit;
}

ordered_json to_json(const TimedVisit& visit) {
    ordered_json triples = ordered_json::array(), passes = ordered_json::object();
    for (const TimedTriple& t : visit.triples)
        triples.push_back({t.before, t.ray, t.after});
    for (const auto& [name, ms] : visit.passes)
        passes[name] = ms;
    return {{"triples_ms", triples}, {"passes_ms", passes}, {"setup_ms", visit.setup_milliseconds}};
}

TimedVisit timed_visit_from(const ordered_json& json) {
    TimedVisit visit;
    for (const ordered_json& t : json.at("triples_ms"))
        visit.triples.push_back({t.at(0), t.at(1), t.at(2)});
    for (const auto& [name, ms] : json.at("passes_ms").items())
        visit.passes.emplace_back(name, ms);
    visit.setup_milliseconds = json.at("setup_ms");
    return visit;
}

FrameTimes summarise(std::span<const TimedVisit> visits) {
    std::vector<double> frames, ratios, rays;
    std::vector<std::pair<std::string, std::vector<double>>> passes;
    for (const TimedVisit& visit : visits) {
        for (const TimedTriple& t : visit.triples) {
            frames.push_back(t.before);
            frames.push_back(t.after);
            rays.push_back(t.ray);
            ratios.push_back((t.before + t.after) / 2 / t.ray);
        }
        for (const auto& [name, ms] : visit.passes) {
            auto found = std::find_if(passes.begin(), passes.end(), [&](const auto& p) { return p.first == name; });
            if (found == passes.end()) found = passes.insert(passes.end(), {name, {}});
            found->second.push_back(ms);
        }
    }
    FrameTimes times{spread(frames), spread(ratios), quantile(rays, 0.5), {}};
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
