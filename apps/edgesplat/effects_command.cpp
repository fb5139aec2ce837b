#include "apps/edgesplat/effects_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/edgesplat/option_values.h"
#include "apps/edgesplat/progress_bar.h"
#include "apps/edgesplat/volume_options.h"
#include "engine/accuracy/frame_times.h"
#include "engine/accuracy/metrics.h"
#include "engine/error.h"
#include "engine/forecast/effect_table.h"
#include "engine/scene/ladder.h"
#include "engine/scene/views.h"
#include "engine/volume/analytic_volumes.h"
#include "engine/volume/filters.h"
#include "engine/volume/packed_volume.h"

namespace {

using edgesplat::Effect;
using edgesplat::FrameRequest;

struct EffectsOptions {
    std::string path = "builtin:phantom:48", json, device;
    VolumeOptions volume;
    std::vector<std::string> only;
    glm::ivec2 size{160, 120};
    int repeats = 5;
    bool markdown = false, quiet = false;
};

/// Times of a picture, ms.
struct Cost {
    double frame = 0, setup = 0;
};

/// One row of the table.
struct Measured {
    const Effect* effect;
    double frame_ratio = 1, setup_ratio = 1;  ///< with / without, medians
    double frame = 0, setup = 0;              ///< ms without, medians
    std::int64_t bytes = 0;                   ///< additional device memory
};

double processor_milliseconds() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

/// The base scene, with every effect off: a builtin volume's own surfaces, otherwise the strongest one, in a view of
/// the whole volume.
FrameRequest base_request(std::shared_ptr<const edgesplat::Volume> volume, const glm::ivec2& size) {
    FrameRequest request;
    if (edgesplat::is_builtin(volume->name)) {
        const std::string name = volume->name.substr(volume->name.find(':') + 1);
        request.scene.iso_values = edgesplat::analytic_scene(name.substr(0, name.find(':'))).iso_values;
    } else {
        for (const auto& suggestion : edgesplat::suggest_iso_values(*volume, 1))
            request.scene.iso_values.push_back(suggestion.value);
    }
    if (request.scene.iso_values.empty()) edgesplat::fail("{}: no surface found", volume->name);
    const glm::dvec3 spacing = volume->geometry.spacing();
    request.scene.materials.resize(request.scene.iso_values.size() + 1);
    for (std::size_t m = 1; m < request.scene.materials.size(); ++m) {
        const bool highest = m + 1 == request.scene.materials.size();
        request.scene.materials[m].extinction = (highest ? 8 : 0.15) / std::min({spacing.x, spacing.y, spacing.z});
    }
    request.volume = std::move(volume);
    request.size = size;
    request.camera = edgesplat::named_view("oblique", {request.volume.get(), &request.scene, 45, size.x, size.y});
    return edgesplat::plain_request(request);
}

class Measuring {
  public:
    explicit Measuring(const EffectsOptions& options, edgesplat::Renderer& renderer)
        : options_(&options), renderer_(&renderer), processor_(renderer.device().is_processor) {}

    Measured measure(const Effect& effect, const FrameRequest& plain) const {
        FrameRequest without = plain;
        if (effect.base != nullptr) effect.base(without);
        FrameRequest with = without;
        effect.turn_on(with);
        Measured row{&effect};
        const std::uint64_t held = bytes_of(without);
        row.bytes = static_cast<std::int64_t>(bytes_of(with)) - static_cast<std::int64_t>(held);
        std::vector<double> frames, setups, frame_ratios, setup_ratios;
        for (int repeat = 0; repeat < options_->repeats; ++repeat) {
            // Without, with, without again: a disturbance of the machine then affects all three alike.
            const Cost before = cost_of(without), between = cost_of(with), after = cost_of(without);
            frames.insert(frames.end(), {before.frame, after.frame});
            setups.insert(setups.end(), {before.setup, after.setup});
            frame_ratios.push_back(between.frame / ((before.frame + after.frame) / 2));
            setup_ratios.push_back(between.setup / ((before.setup + after.setup) / 2));
        }
        using edgesplat::accuracy::quantile;
        row.frame = quantile(frames, 0.5);
        row.setup = quantile(setups, 0.5);
        row.frame_ratio = quantile(frame_ratios, 0.5);
        row.setup_ratio = quantile(setup_ratios, 0.5);
        return row;
    }

    std::string_view clock() const { return processor_ ? "processor time of all threads" : "device time"; }

  private:
    edgesplat::RenderStats draw(const FrameRequest& r) const {
        return renderer_->render(r.scene, r.camera, r.settings, r.size.x, r.size.y, r.outputs).stats;
    }

    std::uint64_t bytes_of(const FrameRequest& request) const {
        renderer_->set_volume(request.volume);
        return draw(request).device_bytes;
    }

    /// Draws one picture with setup and one without. Earlier pictures have built the pipelines.
    Cost cost_of(const FrameRequest& request) const {
        renderer_->set_volume(request.volume);
        if (!processor_) {
            Cost cost;
            (void)draw(request);
            renderer_->set_volume(request.volume);
            // Sums over every draw of the picture, extra outputs included.
            for (const auto& pass : draw(request).passes) {
                const bool setup = pass.name.starts_with('1') || pass.name.starts_with('2');
                (setup ? cost.setup : cost.frame) += pass.milliseconds;
            }
            return cost;
        }
        const double begin = processor_milliseconds();
        (void)draw(request);
        const double first = processor_milliseconds();
        (void)draw(request);
        const double second = processor_milliseconds();
        return {second - first, std::max(first - begin - (second - first), 1e-3)};
    }

    const EffectsOptions* options_;
    edgesplat::Renderer* renderer_;
    bool processor_;
};

std::string ratio(double value) {
    return fmt::format("{:.2f}", value);
}

std::string bytes(std::int64_t value) {
    const double kib = static_cast<double>(value) / 1024.0;
    if (value == 0) return "0";
    return std::abs(kib) < 1024 ? fmt::format("{:+.1f} KiB", kib) : fmt::format("{:+.1f} MiB", kib / 1024);
}

void print(const std::vector<Measured>& rows, bool markdown) {
    std::vector<std::vector<std::string>> cells{{"effect", "enabled with", "frame x", "setup x", "memory"}};
    for (const Measured& row : rows) {
        // An effect without setup work has no setup ratio: it would be noise.
        const Effect& effect = *row.effect;
        const bool other_splats = std::ranges::count(effect.resized, "splat list") > 0;
        const bool sets_up =
            other_splats || !effect.passes.empty() || !effect.resources.empty() || !effect.scene_fields.empty();
        cells.push_back({std::string(effect.name), std::string(effect.call), ratio(row.frame_ratio),
                         sets_up ? ratio(row.setup_ratio) : "-", bytes(row.bytes)});
    }
    std::vector<std::size_t> width(cells.front().size(), 0);
    for (const auto& row : cells)
        for (std::size_t c = 0; c < row.size(); ++c)
            width[c] = std::max(width[c], row[c].size());
    for (std::size_t r = 0; r < cells.size(); ++r) {
        std::string line = markdown ? "|" : "";
        for (std::size_t c = 0; c < width.size(); ++c) {
            const bool right = c >= 2;
            const std::string cell =
                right ? fmt::format("{:>{}}", cells[r][c], width[c]) : fmt::format("{:<{}}", cells[r][c], width[c]);
            line += markdown ? " " + cell + " |" : cell + "  ";
        }
        fmt::print("{}\n", line.substr(0, line.find_last_not_of(' ') + 1));
        if (r == 0 && markdown) fmt::print("|---|---|---:|---:|---:|\n");
    }
}

nlohmann::ordered_json to_json(const std::vector<Measured>& rows) {
    auto list = nlohmann::ordered_json::array();
    for (const Measured& row : rows) {
        list.push_back({{"effect", row.effect->name},
                        {"call", row.effect->call},
                        {"frame_ratio", row.frame_ratio},
                        {"setup_ratio", row.setup_ratio},
                        {"frame_ms_without", row.frame},
                        {"setup_ms_without", row.setup},
                        {"bytes", row.bytes}});
    }
    return list;
}

void run(const EffectsOptions& options) {
    std::vector<const Effect*> effects;
    for (const std::string& name : options.only)
        effects.push_back(&edgesplat::effect_named(name));
    if (options.only.empty())
        for (const Effect& effect : edgesplat::effect_table())
            effects.push_back(&effect);
    edgesplat::VolumeSource source;
    source.path = options.path;
    apply(options.volume, source);
    const auto volume = std::make_shared<const edgesplat::Volume>(
        load_with_progress(source, edgesplat::volume_folders({}), options.quiet));
    require_samples(*volume, "effects");
    edgesplat::Renderer renderer(edgesplat::DeviceChoice{.device = options.device});
    const FrameRequest plain = base_request(volume, options.size);
    const Measuring measuring(options, renderer);
    std::vector<Measured> rows;
    for (const Effect* effect : effects) {
        if (!options.quiet) fmt::print(stderr, "\r\033[K{}/{} {}", rows.size() + 1, effects.size(), effect->name);
        rows.push_back(measuring.measure(*effect, plain));
    }
    if (!options.quiet) fmt::print(stderr, "\r\033[K");
    if (options.json == "-") {
        fmt::print("{}\n", to_json(rows).dump(2));
        return;
    }
    print(rows, options.markdown);
    const glm::ivec3 dims = volume->geometry.dims;
    fmt::print("\n{}, {} x {} x {} voxels, {} x {} pixels on {}: {}, medians of {} alternating runs with and without\n",
               volume->name, dims.x, dims.y, dims.z, options.size.x, options.size.y, renderer.device().name,
               measuring.clock(), options.repeats);
}

}  // namespace

void add_effects_command(CLI::App& app) {
    const auto options = std::make_shared<EffectsOptions>();
    CLI::App& command =
        *app.add_subcommand("effects", "Measure the cost of each effect: a small scene with and without it");
    command.add_option("VOLUME", options->path, "A volume file or builtin:NAME")
        ->type_name("")
        ->default_str("builtin:phantom:48");
    command.add_option("--only", options->only, "Names of effects, comma-separated; default: all")
        ->delimiter(',')
        ->type_name("EFFECT,...");
    command.add_option("--repeats", options->repeats, "Number of alternating runs with and without each effect")
        ->check(CLI::Range(1, 100))
        ->default_str("5");
    command
        .add_option_function<std::string>(
            "--size",
            [options](const std::string& text) {
                const auto size = parse_size(text);
                if (!size) throw CLI::ValidationError("--size", fmt::format("'{}' is not WxH, each 1 to 16384", text));
                options->size = *size;
            },
            "Picture size, pixels")
        ->type_name("WxH")
        ->default_str("160x120");
    command.add_flag("--markdown", options->markdown, "Print the table as Markdown");
    command.add_option("--json", options->json, "Print JSON to stdout: -")->check(CLI::IsMember({"-"}));
    command.add_option("--device", options->device,
                       "Vulkan device: its number in --list-devices or a part of its name");
    command.add_flag("-q,--quiet", options->quiet, "Print no progress");
    add_volume_options(command, options->volume);
    command.callback([options] { run(*options); });
}
