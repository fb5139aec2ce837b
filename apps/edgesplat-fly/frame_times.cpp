#include "apps/edgesplat-fly/frame_times.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "engine/image/image_file.h"

void FrameTimes::add(const edgesplat::viewer::DrawnPicture& picture) {
    if (picture.number != number_) spent_ = 0;
    number_ = picture.number;
    spent_ += picture.milliseconds;
    if (picture.moving) {
        moving_.push_back({picture.milliseconds, picture.rung});
    } else if (!picture.best && picture.rung == edgesplat::viewer::Rung{} && picture.stats.complete) {
        standstills_.push_back(spent_);
    }
}

void FrameTimes::clear() {
    moving_.clear();
    standstills_.clear();
}

void FrameTimes::write(const std::filesystem::path& path, double target) const {
    using nlohmann::ordered_json;
    const auto summary = [](std::vector<double> times) {
        std::ranges::sort(times);
        const auto at = [&](double share) {
            return times[static_cast<std::size_t>(share * static_cast<double>(times.size() - 1) + 0.5)];
        };
        ordered_json json{{"count", times.size()}};
        if (!times.empty()) json.update({{"median_ms", at(0.5)}, {"p95_ms", at(0.95)}, {"max_ms", times.back()}});
        return json;
    };
    std::vector<double> times;
    std::map<std::string, int> rungs;
    for (const Moving& m : moving_) {
        times.push_back(m.milliseconds);
        ++rungs[fmt::format("{}, level {}, scale {:g}", m.rung.rays ? "rays" : "splats", m.rung.level, m.rung.scale)];
    }
    const auto within = std::ranges::count_if(times, [&](double t) { return t <= target; });
    ordered_json moving = summary(times);
    moving["target_ms"] = target;
    moving["within_target"] = within;
    moving["rungs"] = rungs;
    const ordered_json json{{"moving", moving}, {"standstill", summary(standstills_)}};
    const edgesplat::FileContent content{path, json.dump(2) + "\n"};
    edgesplat::write_files({&content, 1});
}
