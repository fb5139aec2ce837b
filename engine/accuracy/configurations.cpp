#include "engine/accuracy/configurations.h"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <set>

#include "engine/scene/ladder.h"

namespace edgesplat::accuracy {
namespace {

using Names = std::initializer_list<std::string_view>;

constexpr std::array<std::string_view, 6> kKindNames{"base", "plain", "rays", "step", "combination", "preset"};

/// Collects combinations, each once, without the base itself.
class Combinations {
  public:
    Combinations(const Settings& base, std::vector<Configuration>& rows)
        : base_(base), rows_(rows), seen_{settings_key(base)} {}

    void add(Names sheets, Names spacings, Names formats, Names saturations) {
        for (const auto sheet : sheets)
            for (const auto spacing : spacings)
                for (const auto format : formats)
                    for (const auto saturation : saturations)
                        add({{"sheets", sheet},
                             {"sheet-spacing", spacing},
                             {"sheet-format", format},
                             {"saturation", saturation}});
    }

  private:
    void add(std::initializer_list<std::pair<std::string_view, std::string_view>> values) {
        Settings settings = base_;
        for (const auto& [name, value] : values) {
            const Knob& knob = knob_named(name);
            if (knob.used(settings)) knob.set(settings, value);
        }
        if (!seen_.insert(settings_key(settings)).second) return;
        rows_.push_back({ConfigurationKind::Combination, difference(settings, base_), "", "", settings, {}});
    }

    Settings base_;
    std::vector<Configuration>& rows_;
    std::set<std::string> seen_;
};

void add_combinations(const Settings& base, std::vector<Configuration>& rows) {
    Combinations combinations(base, rows);
    combinations.add({"whole"}, {"2", "1", "0.5", "0.25"}, {"tiles"}, {"0.999"});
    combinations.add({"sliced"}, {"2", "1", "0.5", "0.25"}, {"tiles"}, {"0.999", "0.9999"});
    combinations.add({"whole"}, {"1", "0.5"}, {"layers"}, {"0.999"});
}

}  // namespace

std::string_view name_of(ConfigurationKind kind) {
    return kKindNames[static_cast<std::size_t>(kind)];
}

std::vector<Configuration> configurations(const Settings& base, std::span<const std::string> knobs) {
    for (const std::string& name : knobs)
        knob_named(name);
    Settings plain = base;
    plain.edges = EdgeEstimator::Off;
    std::vector<Configuration> rows{
        {ConfigurationKind::Base, "base", "", "", base, {}},
        {ConfigurationKind::Plain, "plain splatting", "", "", plain, {}},
        {ConfigurationKind::Rays, "trilinear rays", "", "", base, RaycastFilter::Trilinear},
        {ConfigurationKind::Rays, "cubic rays", "", "", base, RaycastFilter::Cubic},
    };
    for (const Knob& knob : ladder()) {
        const bool asked = knobs.empty() || std::find(knobs.begin(), knobs.end(), knob.name) != knobs.end();
        Settings from = base;
        if (knob.from != nullptr) knob.from(from);
        if (!asked || !knob.used(from) || knob.steps.size() < 2) continue;
        for (const std::string_view step : knob.steps) {
            Configuration row{ConfigurationKind::Step,
                              std::string(knob.name) + "=" + std::string(step),
                              std::string(knob.name),
                              std::string(step),
                              from,
                              {}};
            knob.set(row.settings, step);
            rows.push_back(std::move(row));
        }
    }
    if (knobs.empty()) add_combinations(base, rows);
    for (const Preset& preset : presets())
        rows.push_back({ConfigurationKind::Preset, std::string(preset.name), "", "", preset.settings, {}});
    rows.push_back({ConfigurationKind::Preset, "paper", "", "", paper_settings(base), {}});
    return rows;
}

Settings canonical(const Settings& settings) {
    const Settings standard;
    Settings result = settings;
    for (const Knob& knob : ladder())
        if (!knob.used(settings)) knob.set(result, knob.get(standard));
    return result;
}

std::string settings_key(const Settings& settings) {
    const Settings plain = canonical(settings);
    std::string key;
    for (const Knob& knob : ladder())
        key += (key.empty() ? "" : " ") + std::string(knob.name) + "=" + knob.get(plain);
    if (!settings.cull_buried) key += " keep-buried";
    return key;
}

std::string picture_key(const Configuration& row) {
    if (!row.rays) return settings_key(row.settings);
    return "rays " + std::string(kRaycastFilterNames.at(static_cast<std::size_t>(*row.rays)));
}

Settings model_of(const Settings& settings) {
    Settings model;  // method knobs are at their defaults; the reference does not read them
    for (const Knob& knob : ladder())
        if (knob.kind == KnobKind::Model) knob.set(model, knob.get(settings));
    model.footprints = FootprintMode::Procedural;
    return canonical(model);
}

std::string model_key(const Settings& settings) {
    return settings_key(model_of(settings));
}

}  // namespace edgesplat::accuracy
