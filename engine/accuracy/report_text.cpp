#include "engine/accuracy/report_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace edgesplat::accuracy {
namespace {

constexpr double kMegabyte = 1e6;

std::string cell(double value) {
    return fmt::format("{}", value);
}

/// A value in quotes if it has a comma, a quote or a line break (RFC 4180).
std::string quoted(const std::string& text) {
    if (text.find_first_of(",\"\n") == std::string::npos) return text;
    std::string out = "\"";
    for (const char c : text)
        out += c == '"' ? "\"\"" : std::string(1, c);
    return out + "\"";
}

std::string brief(const std::optional<double>& value, const char* format = "{:.4f}") {
    return value ? fmt::format(fmt::runtime(format), *value) : "-";
}

bool on_front(const Report& report, std::size_t row) {
    return std::find(report.front.begin(), report.front.end(), row) != report.front.end();
}

std::string line_of(const Report& report, std::size_t row, const std::string& name) {
    const SettingsResult& r = report.of_row(row);
    const auto edge = [&](double EdgeFigures::*member) {
        return r.edges && r.edges->measured > 0 ? std::optional<double>((*r.edges).*member) : std::nullopt;
    };
    return fmt::format("  {:<32} {:>6.2f} {:>8.5f} {:>8.5f} {:>7.4f} {:>6} {:>7} {:>8} {:>8.1f} {:>6.2f} {:>7.1f}{}\n",
                       name, decibels(r.truth), r.truth.rms, r.method.rms, r.method.max,
                       brief(edge(&EdgeFigures::rise_mean), "{:.3f}"), brief(edge(&EdgeFigures::location_mean)),
                       brief(r.popping ? std::optional(r.popping->mean_difference) : std::nullopt, "{:.5f}"),
                       r.frame_ms, r.ratio.median, static_cast<double>(r.device_bytes) / kMegabyte,
                       on_front(report, row) ? " *" : "");
}

}  // namespace

std::string steps_csv(const Report& report) {
    std::string text =
        "kind,name,knob,step,on_front,truth_psnr_db,truth_rms,truth_max,method_rms,method_max,rise_mean_voxels,"
        "rise_max_voxels,"
        "location_mean_voxels,location_max_voxels,popping_mean_excess,popping_max_excess,popping_mean_difference,"
        "popping_max_difference,frame_ms,times_raycast,times_raycast_p10,times_raycast_p90,wall_times_raycast,setup_ms,"
        "device_bytes";
    for (const ReportCamera& camera : report.cameras)
        for (const char* column : {"truth_rms", "method_rms", "frame_ms", "times_raycast"})
            text += "," + camera.name + "_" + column;
    text += "\n";
    for (std::size_t row = 0; row < report.rows.size(); ++row) {
        const Configuration& c = report.rows[row];
        const SettingsResult& r = report.of_row(row);
        std::vector<std::string> cells{std::string(name_of(c.kind)), quoted(c.name), c.knob, c.step,
                                       on_front(report, row) ? "1" : "0"};
        const auto add = [&](bool known, std::initializer_list<double> values) {
            for (const double v : values)
                cells.push_back(known ? cell(v) : "");
        };
        const EdgeFigures edges = r.edges.value_or(EdgeFigures{});
        const Popping popping = r.popping.value_or(Popping{});
        add(true, {decibels(r.truth), r.truth.rms, r.truth.max, r.method.rms, r.method.max});
        add(edges.measured > 0, {edges.rise_mean, edges.rise_max, edges.location_mean, edges.location_max});
        add(r.popping.has_value(),
            {popping.mean_excess, popping.max_excess, popping.mean_difference, popping.max_difference});
        add(true, {r.frame_ms, r.ratio.median, r.ratio.low, r.ratio.high, r.wall_ratio});
        add(!std::isnan(r.setup_ms), {r.setup_ms});
        cells.push_back(fmt::format("{}", r.device_bytes));
        for (const CameraResult& camera : r.cameras)
            add(true, {camera.truth.rms, camera.method.rms, camera.times.frame.median, camera.times.ratio.median});
        text += fmt::format("{}\n", fmt::join(cells, ","));
    }
    return text;
}

std::string steps_table(const Report& report) {
    std::string text = fmt::format("  {:<32} {:>6} {:>8} {:>8} {:>7} {:>6} {:>7} {:>8} {:>8} {:>6} {:>7}\n", "", "dB",
                                   "truth", "model", "max", "rise", "place", "popping", "ms", "x ray", "MB");
    std::string knob;
    for (std::size_t row = 0; row < report.rows.size(); ++row) {
        const Configuration& c = report.rows[row];
        if (c.kind == ConfigurationKind::Combination) continue;
        if (c.kind == ConfigurationKind::Step && c.knob != knob) {
            knob = c.knob;
            text += knob + "\n";
        } else if (c.kind == ConfigurationKind::Preset && knob != "presets") {
            knob = "presets";
            text += knob + "\n";
        }
        text += line_of(report, row, c.kind == ConfigurationKind::Step ? c.step : c.name);
    }
    return text + "dB, truth: PSNR and RMS error against " + report.truth_description() +
           ", full scale = 1, all cameras;\nmodel, max: RMS and largest difference from the converged picture of the "
           "same model (for rays, of the base's model);\nrise, place: 10-90 % width and displacement of edges, "
           "voxels; popping: RMS change between frames one degree apart that the model does not have;\nx ray: time "
           "over the trilinear ray caster's (processor time if the device is the processor); *: nothing is both "
           "faster and nearer to the truth.\n";
}

}  // namespace edgesplat::accuracy
