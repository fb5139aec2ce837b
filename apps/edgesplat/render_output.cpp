#include "apps/edgesplat/render_output.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>

#include "engine/scene/ladder.h"

namespace {

using nlohmann::ordered_json;

constexpr int kDividerWidth = 2;  ///< pixels between the pictures of --compare
constexpr float kDividerColor = 0.5F;

ordered_json to_json(const glm::dvec3& v) {
    return {v.x, v.y, v.z};
}

/// Every knob of the ladder by its name, with underscores.
ordered_json to_json(const edgesplat::Settings& s) {
    ordered_json json;
    for (const edgesplat::Knob& knob : edgesplat::ladder()) {
        std::string key(knob.name);
        std::replace(key.begin(), key.end(), '-', '_');
        const std::string value = knob.get(s);
        json[key] = knob.number ? ordered_json(std::stod(value)) : ordered_json(value);
    }
    json["cull_buried"] = s.cull_buried;
    return json;
}

ordered_json to_json(const edgesplat::DeviceInfo& d) {
    return {{"name", d.name},
            {"type", d.type},
            {"driver", d.driver},
            {"driver_version", d.driver_version},
            {"api_version", d.api_version}};
}

ordered_json to_json(const RenderedFrame& frame) {
    const edgesplat::RenderStats& stats = frame.result.stats;
    ordered_json passes = ordered_json::object();
    for (const edgesplat::PassTime& pass : stats.passes)
        passes[pass.name] = pass.milliseconds;
    ordered_json json = {{"name", frame.name},
                         {"settings", to_json(frame.settings)},
                         {"width", frame.result.color.width},
                         {"height", frame.result.color.height},
                         {"setup_ms", stats.setup_milliseconds},
                         {"frame_ms", stats.frame_milliseconds},
                         {"passes_ms", passes},
                         {"voxels", stats.voxels},
                         {"level", stats.level},
                         {"wanted_level", stats.wanted_level},
                         {"in_blocks", stats.in_blocks},
                         {"blocks", stats.blocks},
                         {"blocks_held", stats.blocks_held},
                         {"splats_collected", stats.splats_collected},
                         {"splats_read", stats.splats_read},
                         {"splats_culled", stats.splats_culled},
                         {"splats_drawn", stats.splats_drawn},
                         {"edge_splats", stats.edge_splats},
                         {"sheets", stats.sheets},
                         {"sheet_groups", stats.sheet_groups},
                         {"submissions", stats.submissions},
                         {"device_bytes", stats.device_bytes},
                         {"validation_messages", stats.validation_messages}};
    return json;
}

/// Peak resident size of this process, bytes.
std::uint64_t peak_host_bytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

std::string checksum_text(const edgesplat::Volume& volume) {
    return fmt::format("{:016x}", volume.checksum);
}

edgesplat::Image side_by_side(const edgesplat::Image& left, const edgesplat::Image& right) {
    edgesplat::Image out(left.width + kDividerWidth + right.width, left.height, left.channels);
    std::fill(out.pixels.begin(), out.pixels.end(), kDividerColor);
    for (int y = 0; y < out.height; ++y) {
        for (int c = 0; c < out.channels; ++c) {
            for (int x = 0; x < left.width; ++x)
                out.at(x, y, c) = left.at(x, y, c);
            for (int x = 0; x < right.width; ++x)
                out.at(left.width + kDividerWidth + x, y, c) = right.at(x, y, c);
            if (c == 3)
                for (int x = 0; x < kDividerWidth; ++x)
                    out.at(left.width + x, y, c) = 1;
        }
    }
    return out;
}

/// The extra outputs in `result`, each with its name and the names of its channels.
std::vector<std::pair<std::string, edgesplat::ImageLayer>> aov_layers(const edgesplat::RenderResult& result) {
    std::vector<std::pair<std::string, edgesplat::ImageLayer>> layers;
    for (const edgesplat::Aov& aov : edgesplat::aovs()) {
        const std::optional<edgesplat::Image>& image = result.*image_of(aov);
        const std::vector<std::string> channels(aov.channels.begin(), aov.channels.begin() + aov.count());
        if (image) layers.push_back({std::string(aov.name), {&*image, channels}});
    }
    return layers;
}

}  // namespace

edgesplat::ImageMetadata picture_metadata(const RunDescription& run) {
    return {{"Software", "edgesplat " EDGESPLAT_VERSION},
            {"edgesplat:command", run.command_line},
            {"edgesplat:volume", run.volume_path},
            {"edgesplat:checksum", checksum_text(*run.volume)},
            {"edgesplat:device", run.device},
            {"edgesplat:scene", run.scene_text}};
}

ordered_json statistics(const RunDescription& run, const std::vector<RenderedFrame>& frames) {
    const edgesplat::Volume& volume = *run.volume;
    const glm::ivec3 dims = volume.geometry.dims;
    ordered_json materials = ordered_json::array();
    for (const edgesplat::Material& m : run.scene->materials)
        materials.push_back({{"color", to_json(m.color)}, {"extinction_per_mm", m.extinction}});
    std::vector<double> iso_values = run.scene->iso_values;
    for (double& value : iso_values)
        value = volume.in_file_unit(value);
    ordered_json frame_list = ordered_json::array();
    for (const RenderedFrame& frame : frames)
        frame_list.push_back(to_json(frame));
    ordered_json json = {{"program", "edgesplat"},
                         {"version", EDGESPLAT_VERSION},
                         {"command", run.command_line},
                         {"volume",
                          {{"name", volume.name},
                           {"checksum", checksum_text(volume)},
                           {"dims", {dims.x, dims.y, dims.z}},
                           {"spacing_mm", to_json(volume.geometry.spacing())},
                           {"min", volume.in_file_unit(static_cast<double>(volume.min_value))},
                           {"max", volume.in_file_unit(static_cast<double>(volume.max_value))},
                           {"warnings", volume.warnings}}},
                         {"scene", {{"iso_values", iso_values}, {"materials", materials}}},
                         {"camera",
                          {{"eye_mm", to_json(run.camera.eye)},
                           {"direction", to_json(run.camera.direction)},
                           {"up", to_json(run.camera.up)},
                           {"fov_y_degrees", run.camera.fov_y}}},
                         {"device", to_json(frames.back().result.stats.device)},
                         {"frames", frame_list},
                         {"peak_host_bytes", peak_host_bytes()}};
    if (!run.plan.is_null()) json["plan"] = run.plan;
    return json;
}

std::filesystem::path aov_path(const std::filesystem::path& picture, const std::string& aov) {
    std::filesystem::path path = picture;
    return path.replace_extension("." + aov + ".exr");
}

std::vector<edgesplat::FileContent> picture_files(const std::filesystem::path& path,
                                                  const std::vector<RenderedFrame>& frames,
                                                  const edgesplat::ImageMetadata& metadata) {
    const edgesplat::RenderResult& last = frames.back().result;
    edgesplat::Image color = frames.front().result.color;
    for (std::size_t i = 1; i < frames.size(); ++i)
        color = side_by_side(color, frames[i].result.color);
    const auto aovs = aov_layers(last);
    std::vector<edgesplat::FileContent> files;
    if (edgesplat::is_png_path(path)) {
        files.push_back({path, edgesplat::encode_png(edgesplat::without_alpha(color), metadata)});
        for (const auto& [name, layer] : aovs)
            files.push_back({aov_path(path, name), edgesplat::encode_exr({&layer, 1}, metadata)});
    } else {
        std::vector<edgesplat::ImageLayer> layers{{&color, {"R", "G", "B", "A"}}};
        for (const auto& [name, layer] : aovs)
            layers.push_back(layer);
        files.push_back({path, edgesplat::encode_exr(layers, metadata)});
    }
    return files;
}
