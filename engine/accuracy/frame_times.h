// Measures the time of a frame relative to the ray caster, so that the ratio does not depend on other load.
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

/// A frame, the ray caster, the same frame again: a disturbance of the machine affects all three alike.
struct TimedTriple {
    double before = 0, ray = 0, after = 0;  ///< ms
    double ratio() const { return (before + after) / 2 / ray; }
};

/// One visit to one configuration and camera.
struct TimedVisit {
    std::vector<TimedTriple> triples;                    ///< by the wall clock
    std::vector<TimedTriple> processor_triples;          ///< by the processor time of all threads of this process
    std::vector<std::pair<std::string, double>> passes;  ///< GPU ms, fastest of the visit
    double setup_milliseconds = 0;                       ///< estimation and collection; 0: no setup was needed
    // Not in the JSON:
    std::vector<std::vector<PassTime>> frames;  ///< GPU ms of each frame
    std::vector<PassTime> setup_passes;         ///< GPU ms; empty: no setup was needed
    std::uint64_t submissions = 0;              ///< RenderStats of the last frame
};

/// How long fast frames are repeated.
struct VisitLimits {
    double milliseconds = 120;
    int triples = 6;  ///< at most
};

/// Renders frames and casts rays in turns; the first of each is not counted. At least one triple; more if they are
/// fast.
TimedVisit time_visit(const std::function<RenderStats()>& frame, const std::function<RenderStats()>& ray,
                      const VisitLimits& limits = {});

/// The same for frames of splats.
TimedVisit time_visit(Renderer& renderer, const Scene& scene, const Camera& camera, const Settings& settings, int width,
                      int height, const VisitLimits& limits = {});

nlohmann::ordered_json to_json(const TimedVisit& visit);
TimedVisit timed_visit_from(const nlohmann::ordered_json& json);

/// The clock that frame and ray caster are compared by. If the device is this machine's processor, other programs use
/// it, too; that affects the wall clock but not this process's processor time.
enum class RatioClock { Wall, Processor };
RatioClock ratio_clock(const DeviceInfo& device);
std::string_view name_of(RatioClock clock);  ///< wall, processor

/// Times over all visits of one configuration and camera.
struct FrameTimes {
    Spread frame;                                        ///< ms
    Spread ratio;                                        ///< of a triple: frame / ray caster, by the given clock
    Spread wall_ratio;                                   ///< the same by the wall clock
    double ray_median = 0;                               ///< ms
    std::vector<std::pair<std::string, double>> passes;  ///< GPU ms, median of the visits
};
FrameTimes summarise(std::span<const TimedVisit> visits, RatioClock clock);

/// 0 .. count - 1 in a different order for each round, the same in every run.
std::vector<std::size_t> order_of_round(std::size_t count, int round);

}  // namespace edgesplat::accuracy
