#include "engine/accuracy/report_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/accuracy/heat_map.h"
#include "engine/accuracy/page_parts.h"
#include "engine/accuracy/svg_plot.h"

namespace edgesplat::accuracy {
namespace {

std::string rms_text(double error) {
    return error < 0.001 ? fmt::format("{:.2e}", error) : fmt::format("{:.4f}", error);
}

std::string optional_cell(bool known, const std::string& text) {
    return known ? text : "\u2013";
}

/// Error against the truth.
std::string truth_text(const SettingsResult& r) {
    return fmt::format("{} RMS ({:.1f} dB)", rms_text(r.truth.rms), decibels(r.truth));
}

/// Summary of the results in a few sentences.
std::string summary(const Report& report) {
    const SettingsResult& base = report.of_row(0);
    std::string text = fmt::format(
        "With the base settings the error against {1} is {0}. Against the converged picture of the model it is {2} RMS "
        "(at most {3:.3f}). A frame takes {4:.2f} times the {5} of the trilinear ray caster.",
        truth_text(base), report.truth_description(), rms_text(base.method.rms), base.method.max, base.ratio.median,
        ratio_clock(report.device) == RatioClock::Processor ? "processor time" : "time");
    for (std::size_t row = 0; row < report.rows.size(); ++row)
        if (const ConfigurationKind kind = report.rows[row].kind;
            kind == ConfigurationKind::Plain || kind == ConfigurationKind::Rays)
            text += fmt::format(" The error of {} is {}, at {:.1f} ms.", report.rows[row].name,
                                truth_text(report.of_row(row)), report.of_row(row).frame_ms);
    if (base.edges && base.edges->measured > 0)
        text += fmt::format(" On average an edge rises over {:.2f} voxel and lies {:.3f} voxel from its true place.",
                            base.edges->rise_mean, base.edges->location_mean);
    if (!report.front.empty()) {
        const std::size_t last = report.front.back();
        text += fmt::format(" The lowest error has {}: {}, at {:.1f} ms.", report.rows[last].name,
                            truth_text(report.of_row(last)), report.of_row(last).frame_ms);
    }
    return text;
}

std::string cost_and_error(const Report& report, std::size_t row) {
    const SettingsResult& r = report.of_row(row);
    return fmt::format("{}: {}, {:.1f} ms, {:.2f} x ray caster", report.rows[row].name, truth_text(r), r.frame_ms,
                       r.ratio.median);
}

/// Plot of all rows: error against time.
std::string error_against_time(const Report& report) {
    PlotSeries steps{"one step from the base", "pt 7 ps 0.8 lc rgb '#8fb8de'", {}};
    PlotSeries combinations{"combination", "pt 7 ps 0.6 lc rgb '#c6ccd4'", {}};
    PlotSeries best{"nothing is both faster and nearer to the truth", "pt 6 ps 1.6 lw 2 lc rgb '#c8501e'", {}};
    PlotSeries presets{"base, presets, and the paper's method", "pt 7 ps 1.0 lc rgb '#1f6fb2'", {}};
    PlotSeries others{"plain splatting, ray casters", "pt 9 ps 1.2 lc rgb '#2b7a4b'", {}};
    LogPlot plot{"milliseconds", "error against " + report.truth_description() + ", RMS of full scale", {}, {}};
    const auto add = [&](PlotSeries& series, std::size_t row, const std::string& label) {
        const SettingsResult& r = report.of_row(row);
        series.points.push_back({r.frame_ms, r.truth.rms, label});
    };
    for (std::size_t row = 0; row < report.rows.size(); ++row) {
        const Configuration& c = report.rows[row];
        if (c.kind == ConfigurationKind::Preset || c.kind == ConfigurationKind::Base) add(presets, row, c.name);
        if (c.kind == ConfigurationKind::Plain || c.kind == ConfigurationKind::Rays) add(others, row, c.name);
        if (c.kind == ConfigurationKind::Combination) add(combinations, row, "");
        if (c.kind == ConfigurationKind::Step) add(steps, row, "");
    }
    for (std::size_t i = 0; i < report.front.size(); ++i) {
        add(best, report.front[i], fmt::format("{}", i + 1));
        const SettingsResult& r = report.of_row(report.front[i]);
        plot.line.emplace_back(r.frame_ms, r.truth.rms);
    }
    plot.series = {combinations, steps, presets, others, best};  // rings around the front's points
    std::string html = log_plot_svg(plot) + "<ol class=\"front-list\">\n";
    for (const std::size_t row : report.front)
        html += "<li>" + escaped(cost_and_error(report, row)) + "</li>\n";
    return html + "</ol>\n";
}

std::vector<std::string> cells_of(const Report& report, std::size_t row) {
    const Configuration& c = report.rows[row];
    const SettingsResult& r = report.of_row(row);
    const EdgeFigures edges = r.edges.value_or(EdgeFigures{});
    const bool rises = edges.measured > 0;
    return {c.kind == ConfigurationKind::Step ? c.step : c.name,
            fmt::format("{:.1f}", decibels(r.truth)),
            rms_text(r.truth.rms),
            rms_text(r.method.rms),
            fmt::format("{:.3f}", r.method.max),
            optional_cell(rises, fmt::format("{:.3f}", edges.rise_mean)),
            optional_cell(rises, fmt::format("{:.4f}", edges.location_mean)),
            optional_cell(r.popping.has_value(), r.popping ? rms_text(r.popping->mean_difference) : ""),
            optional_cell(r.popping.has_value(), r.popping ? fmt::format("{:+.5f}", r.popping->mean_excess) : ""),
            fmt::format("{:.1f}", r.frame_ms),
            fmt::format("{:.2f}", r.ratio.median),
            fmt::format("{:.2f}\u2013{:.2f}", r.ratio.low, r.ratio.high),
            fmt::format("{:.2f}", r.wall_ratio),
            optional_cell(!std::isnan(r.setup_ms), fmt::format("{:.1f}", r.setup_ms)),
            fmt::format("{:.1f}", static_cast<double>(r.device_bytes) / 1e6)};
}

std::string steps_section(const Report& report) {
    HtmlTable table({"", "truth dB", "truth RMS", "model RMS", "max", "rise", "place", "popping", "excess", "ms",
                     "\u00d7 ray", "p10\u2013p90", "wall \u00d7", "setup ms", "MB"});
    std::string group;
    for (std::size_t row = 0; row < report.rows.size(); ++row) {
        const Configuration& c = report.rows[row];
        const std::string name = c.kind == ConfigurationKind::Step   ? c.knob
                                 : c.kind == ConfigurationKind::Base ? "base settings"
                                 : c.kind == ConfigurationKind::Plain || c.kind == ConfigurationKind::Rays
                                     ? "for comparison"
                                 : c.kind == ConfigurationKind::Combination ? "combinations"
                                                                            : "presets";
        if (name != group) table.group(group = name);
        const bool best = std::find(report.front.begin(), report.front.end(), row) != report.front.end();
        const bool same = report.result_of_row[row] == report.result_of_row[0];
        table.row(cells_of(report, row), same && c.kind != ConfigurationKind::Base ? "base" : best ? "best" : "");
    }
    return table.html() + "<p class=\"note\"><b>truth</b>: PSNR and RMS error against " + report.truth_description() +
           ", all cameras, full scale = 1, linear light. <b>model</b>, <b>max</b>: RMS and largest difference from "
           "the converged picture of the same model; for rays, of the base's model. <b>rise</b>: 10\u201390 % width "
           "of an edge, <b>place</b>: distance of its 50 % crossing from the true surface; both in voxels, in the "
           "model's reconstruction. <b>popping</b>: RMS change between frames one degree apart that the model does "
           "not have; <b>excess</b>: RMS change minus the model's own. <b>\u00d7 ray</b>: time over the trilinear "
           "ray caster's, measured in turns; geometric mean over the cameras. If the device is the processor, this "
           "is processor time, which does not depend on other programs. <b>wall \u00d7</b>: the same by wall clock. "
           "<b>setup</b>: finding the edges, once per volume; a dash where another step shares that work. Bold: "
           "nothing is both faster and nearer to the truth. Grey: the same as the base."
           "</p>\n";
}

std::string cameras_section(const Report& report) {
    HtmlTable table({"", "eye (mm)", "direction", "angle", "ray caster ms"});
    for (std::size_t i = 0; i < report.cameras.size(); ++i) {
        const ReportCamera& c = report.cameras[i];
        const auto vector = [](const glm::dvec3& v) { return fmt::format("{:.2f}, {:.2f}, {:.2f}", v.x, v.y, v.z); };
        table.row({c.name + ": " + c.what, vector(c.camera.eye), vector(glm::normalize(c.camera.direction)),
                   fmt::format("{:.0f}\u00b0", c.camera.fov_y), fmt::format("{:.1f}", report.raycast_ms[i])},
                  "");
    }
    return table.html();
}

std::string pictures_section(const Measured& measured) {
    std::string html;
    for (std::size_t i = 0; i < measured.pictures.size(); ++i) {
        const ReportPictures& p = measured.pictures[i];
        const Report& report = measured.report;
        html += "<h3>" + escaped(report.cameras[i].name) + "</h3>\n<div class=\"pictures\">\n";
        html += figure(p.plain, "plain splatting");
        html += figure(p.base, "base settings");
        html += figure(p.accurate, "preset accurate");
        html += figure(p.trilinear_rays, "trilinear rays");
        html += figure(p.cubic_rays, "cubic rays");
        html += figure(p.truth, report.truth_description());
        html += figure(heat_map(p.plain, p.truth), "plain \u2212 truth");
        html += figure(heat_map(p.base, p.truth), "base \u2212 truth");
        html += figure(heat_map(p.accurate, p.truth), "accurate \u2212 truth");
        html += figure(heat_map(p.trilinear_rays, p.truth), "trilinear rays \u2212 truth");
        html += figure(heat_map(p.cubic_rays, p.truth), "cubic rays \u2212 truth");
        html += figure(heat_map(p.base, p.reference), "base \u2212 its model");
        html += "</div>\n";
    }
    std::string ticks;
    for (double v = kHeatLow; v < kHeatHigh * 1.01; v *= 10)
        ticks += fmt::format("<span>{:g}</span>", v);
    return html + "<div class=\"scale\"><div class=\"bar\" style=\"background:" + heat_gradient() + "\"></div><div " +
           "class=\"ticks\">" + ticks +
           "</div><p class=\"note\">Differences: largest of a pixel's colour channels, relative to full scale, "
           "linear light. The scale is logarithmic and the same in all pictures.</p></div>\n";
}

std::string passes_section(const Report& report) {
    std::vector<std::size_t> rows{0};
    for (std::size_t row = 0; row < report.rows.size(); ++row)
        if (report.rows[row].kind == ConfigurationKind::Preset) rows.push_back(row);
    std::vector<std::string> names;
    for (const std::size_t row : rows)
        for (const CameraResult& c : report.of_row(row).cameras)
            for (const auto& [name, ms] : c.times.passes)
                if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    std::vector<std::string> head{""};
    head.insert(head.end(), names.begin(), names.end());
    head.emplace_back("frame");
    HtmlTable table(head);
    for (const std::size_t row : rows) {
        table.group(report.rows[row].name);
        const SettingsResult& r = report.of_row(row);
        for (std::size_t i = 0; i < r.cameras.size(); ++i) {
            std::vector<std::string> cells{report.cameras[i].name};
            for (const std::string& name : names) {
                const auto& passes = r.cameras[i].times.passes;
                const auto found =
                    std::find_if(passes.begin(), passes.end(), [&](const auto& p) { return p.first == name; });
                cells.push_back(found == passes.end() ? "\u2013" : fmt::format("{:.2f}", found->second));
            }
            cells.push_back(fmt::format("{:.1f}", r.cameras[i].times.frame.median));
            table.row(cells, "");
        }
    }
    return table.html() + "<p class=\"note\">Milliseconds on the device, median.</p>\n";
}

}  // namespace

std::string report_page(const Measured& measured) {
    const Report& report = measured.report;
    const glm::ivec3 d = report.input.volume->geometry.dims;
    std::string notes;
    for (const std::string& note : report.notes)
        notes += "<li>" + escaped(note) + "</li>\n";
    const std::string facts = fmt::format(
        "{}\u00d7{}\u00d7{} voxels, checksum {:016x} \u00b7 {} ({}), {} {} \u00b7 {} \u00b7 {}\u00d7{} pixels, "
        "{} rounds",
        d.x, d.y, d.z, report.input.volume->checksum, report.device.name, report.device.type, report.device.driver,
        report.device.driver_version, report.input.program, report.options.size.x, report.options.size.y,
        report.options.repeats);
    return page_begin("Accuracy and time: " + report.input.volume->name) + "<p class=\"facts\">" + escaped(facts) +
           "</p>\n<p class=\"lead\">" + escaped(summary(report)) + "</p>\n<h2>Error against time</h2>\n" +
           error_against_time(report) + "<h2>Every step</h2>\n" + steps_section(report) + "<h2>Pictures</h2>\n" +
           pictures_section(measured) + "<h2>Time of each pass</h2>\n" + passes_section(report) + "<h2>Cameras</h2>\n" +
           cameras_section(report) + "<h2>Notes</h2>\n<ul>\n" + notes + "</ul>\n<p class=\"facts\">Command: <code>" +
           escaped(report.input.command) + "</code></p>\n" + page_end();
}

}  // namespace edgesplat::accuracy
