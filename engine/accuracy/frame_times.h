// What a frame costs, next to the ray caster: measured so that the ratio is the same on a machine that others use too.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/accuracy/metrics.h"
#include "engine/renderer.h"

namespace edgesplat::accuracy {

/// A frame, the ray caster, the same frame again: what disturbs the machine disturbs all three alike.
struct TimedTriple {
    double before = 0, ray = 0, after = 0;  ///< ms
    double ratio() const { return (before + after) / 2 / ray; }
};

/// One visit to one configuration and camera.
struct TimedVisit {
    std::vector<TimedTriple> triples;            ///< by the wall clock
    std::vector<TimedTriple> processor_triples;  ///< the same by the processor time of all threads of this process
    std::vector<std::pair<std::string, double>> passes;  ///< GPU ms, fastest of the visit
    double setup_milliseconds = 0;  ///< estimation and collection; 0 where nothing was to be set up
    // Not in the JSON:
    std::vector<std::vector<PassTime>> frames;  ///< GPU ms of each frame
    std::vector<PassTime> setup_passes;         ///< GPU ms; empty where nothing was to be set up
    std::uint64_t submissions = 0;              ///< RenderStats of the last frame
};

/// How long fast frames are repeated for.
struct VisitLimits {
    double milliseconds = 120;
    int triples = 6;  ///< at most
};

/// Makes a frame and casts rays in turns; the first of each is dropped. Always one triple; more where they are fast.
TimedVisit time_visit(const std::function<RenderStats()>& frame, const std::function<RenderStats()>& ray,
                      const VisitLimits& limits = {});

/// The same of splats.
TimedVisit time_visit(Renderer& renderer, const Scene& scene, const Camera& camera, const Settings& settings, int width,
                      int height, const VisitLimits& limits = {});

nlohmann::ordered_json to_json(const TimedVisit& visit);
TimedVisit timed_visit_from(const nlohmann::ordered_json& json);

/// What frame and ray caster are compared by. A device that is this machine's processor shares it with whatever else
/// runs, which the wall clock sees and the processor's own time does not.
enum class RatioClock { Wall, Processor };
RatioClock ratio_clock(const DeviceInfo& device);
std::string_view name_of(RatioClock clock);  ///< wall, processor

/// Over all visits of one configuration and camera.
struct FrameTimes {
    Spread frame;           ///< ms
    Spread ratio;           ///< of a triple: frame / ray caster, by the clock that was asked for
    Spread wall_ratio;      ///< the same by the wall clock
    double ray_median = 0;  ///< ms
    std::vector<std::pair<std::string, double>> passes;  ///< GPU ms, median of the visits
};
FrameTimes summarise(std::span<const TimedVisit> visits, RatioClock clock);

/// 0 .. count - 1 in an order of its own for each round, always the same.
std::vector<std::size_t> order_of_round(std::size_t count, int round);

}  // namespace edgesplat::accuracy
