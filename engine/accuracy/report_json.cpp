#include "engine/accuracy/report_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/scene/ladder.h"

namespace edgesplat::accuracy {
namespace {

using nlohmann::ordered_json;

/// JSON has no infinity: NaN becomes null, infinity a text.
ordered_json number(double value) {
    if (std::isnan(value)) return {};
    return std::isfinite(value) ? ordered_json(value) : ordered_json("infinite");
}

double number_from(const ordered_json& json) {
    return json.is_number() ? json.get<double>() : std::numeric_limits<double>::infinity();
}

ordered_json vector_json(const glm::dvec3& v) {
    return {v.x, v.y, v.z};
}

template <typename Value>
ordered_json optional_json(const std::optional<Value>& value) {
    return value ? to_json(*value) : ordered_json();
}

ordered_json truth_json(const ImageError& error) {
    ordered_json json = to_json(error);
    json["psnr_db"] = number(decibels(error));
    return json;
}

ordered_json passes_json(const FrameTimes& times) {
    ordered_json json = ordered_json::object();
    for (const auto& [name, ms] : times.passes)
        json[name] = ms;
    return json;
}

ordered_json camera_json(const ReportCamera& camera) {
    return {{"name", camera.name},
            {"what", camera.what},
            {"eye_mm", vector_json(camera.camera.eye)},
            {"direction", vector_json(camera.camera.direction)},
            {"up", vector_json(camera.camera.up)},
            {"fov_y_degrees", camera.camera.fov_y}};
}

ordered_json camera_result_json(const ReportCamera& camera, const CameraResult& r) {
    return {{"camera", camera.name},
            {"truth_error", truth_json(r.truth)},
            {"method_error", to_json(r.method)},
            {"reference_error", r.reference_error},
            {"splats_drawn", r.splats_drawn},
            {"sheets", r.sheets},
            {"time",
             {{"frame_ms", to_json(r.times.frame)},
              {"raycast_ms", r.times.ray_median},
              {"times_raycast", to_json(r.times.ratio)},
              {"wall_times_raycast", to_json(r.times.wall_ratio)},
              {"passes_ms", passes_json(r.times)}}}};
}

ordered_json row_json(const Report& report, std::size_t row) {
    const Configuration& c = report.rows[row];
    const SettingsResult& r = report.of_row(row);
    ordered_json json{{"kind", std::string(name_of(c.kind))}, {"name", c.name}};
    json["knob"] = c.knob.empty() ? ordered_json() : ordered_json(c.knob);
    json["step"] = c.step.empty() ? ordered_json() : ordered_json(c.step);
    json["raycast_filter"] =
        c.rays ? ordered_json(std::string(kRaycastFilterNames.at(static_cast<std::size_t>(*c.rays)))) : ordered_json();
    json["settings"] = c.rays ? ordered_json() : settings_json(c.settings);
    json["on_front"] = std::find(report.front.begin(), report.front.end(), row) != report.front.end();
    json["truth_error"] = truth_json(r.truth);
    json["method_error"] = to_json(r.method);
    json["edges_voxels"] = optional_json(r.edges);
    json["popping"] = optional_json(r.popping);
    json["device_bytes"] = r.device_bytes;
    json["time"] = {{"frame_ms", r.frame_ms},
                    {"times_raycast", to_json(r.ratio)},
                    {"wall_times_raycast", r.wall_ratio},
                    {"setup_ms", std::isnan(r.setup_ms) ? ordered_json() : ordered_json(r.setup_ms)}};
    ordered_json cameras = ordered_json::array();
    for (std::size_t i = 0; i < r.cameras.size(); ++i)
        cameras.push_back(camera_result_json(report.cameras[i], r.cameras[i]));
    json["cameras"] = cameras;
    return json;
}

}  // namespace

ordered_json to_json(const ImageError& error) {
    return {{"rms", number(error.rms)}, {"max", number(error.max)}};
}

ImageError image_error_from(const ordered_json& json) {
    return {number_from(json.at("rms")), number_from(json.at("max"))};
}

ordered_json to_json(const EdgeFigures& f) {
    return {{"measured", f.measured},
            {"missed", f.missed},
            {"rise_mean", f.rise_mean},
            {"rise_max", f.rise_max},
            {"location_mean", f.location_mean},
            {"location_max", f.location_max},
            {"bias", f.bias}};
}

EdgeFigures edge_figures_from(const ordered_json& json) {
    return {json.at("measured"),      json.at("missed"),       json.at("rise_mean"), json.at("rise_max"),
            json.at("location_mean"), json.at("location_max"), json.at("bias")};
}

ordered_json to_json(const Popping& p) {
    return {{"mean_excess", number(p.mean_excess)},
            {"max_excess", number(p.max_excess)},
            {"mean_difference", number(p.mean_difference)},
            {"max_difference", number(p.max_difference)}};
}

Popping popping_from(const ordered_json& json) {
    return {number_from(json.at("mean_excess")), number_from(json.at("max_excess")),
            number_from(json.at("mean_difference")), number_from(json.at("max_difference"))};
}

ordered_json to_json(const Spread& s) {
    return {{"median", number(s.median)}, {"p10", number(s.low)}, {"p90", number(s.high)}};
}

ordered_json settings_json(const Settings& settings) {
    ordered_json json;
    for (const Knob& knob : ladder()) {
        std::string key(knob.name);
        std::replace(key.begin(), key.end(), '-', '_');
        const std::string value = knob.get(settings);
        json[key] = knob.number ? ordered_json(std::stod(value)) : ordered_json(value);
    }
    return json;
}

ordered_json report_json(const Report& report) {
    const Volume& volume = *report.input.volume;
    const glm::ivec3 dims = volume.geometry.dims;
    ordered_json cameras = ordered_json::array(), rows = ordered_json::array(), front = ordered_json::array();
    ordered_json raycast = ordered_json::object();
    for (std::size_t i = 0; i < report.cameras.size(); ++i) {
        cameras.push_back(camera_json(report.cameras[i]));
        raycast[report.cameras[i].name] = report.raycast_ms[i];
    }
    for (std::size_t row = 0; row < report.rows.size(); ++row)
        rows.push_back(row_json(report, row));
    for (const std::size_t row : report.front)
        front.push_back(report.rows[row].name);
    ordered_json surface;
    if (report.surface)
        surface = {{"points", report.surface->points.size()},
                   {"room_voxels", report.surface->room},
                   {"left_out_near_border", report.surface->near_border},
                   {"left_out_disturbed", report.surface->disturbed}};
    const ReportOptions& o = report.options;
    return {{"schema", "edgesplat accuracy report 2"},
            {"program", report.input.program},
            {"truth", report.input.analytic ? "exact scene" : "cubic spline"},
            {"command", report.input.command},
            {"volume",
             {{"name", volume.name},
              {"checksum", fmt::format("{:016x}", volume.checksum)},
              {"dims", {dims.x, dims.y, dims.z}},
              {"spacing_mm", vector_json(volume.geometry.spacing())},
              {"iso_values", report.input.scene.iso_values}}},
            {"device",
             {{"name", report.device.name},
              {"type", report.device.type},
              {"driver", report.device.driver},
              {"driver_version", report.device.driver_version},
              {"api_version", report.device.api_version}}},
            {"options",
             {{"base", settings_json(o.base)},
              {"width", o.size.x},
              {"height", o.size.y},
              {"tolerance", o.tolerance},
              {"repeats", o.repeats},
              {"orbit_frames", o.orbit_frames},
              {"orbit_size", o.orbit_size}}},
            {"largest_reference_error", report.largest_reference_error},
            {"surface", surface},
            {"cameras", cameras},
            {"ratio_clock", std::string(name_of(ratio_clock(report.device)))},
            {"raycast_ms", raycast},
            {"front", front},
            {"rows", rows},
            {"notes", report.notes}};
}

}  // namespace edgesplat::accuracy
