#include <fmt/format.h>

#include <array>

#include "engine/accuracy/downsample.h"
#include "engine/accuracy/heat_map.h"
#include "engine/accuracy/json_text.h"
#include "engine/accuracy/page_parts.h"
#include "engine/accuracy/report_json.h"
#include "engine/accuracy/svg_plot.h"
#include "engine/error.h"
#include "engine/image/image_file.h"

namespace edgesplat::accuracy {
namespace {

using nlohmann::ordered_json;

constexpr const char* kWording =
    "A sharp picture of coarse data does not show what the coarse data lost. Invented: pixels that show a surface "
    "where the full volume shows none; lost: the opposite; displaced: both show one, but more than one coarse voxel "
    "apart in depth. Details smaller than a coarse voxel can be missing or merged in every variant, however sharp "
    "its edges are.";

ordered_json json_of(const ResolutionReport& report) {
    const Volume& volume = *report.request.volume;
    const glm::ivec3 d = volume.geometry.dims;
    ordered_json factors = ordered_json::array();
    for (const FactorResult& f : report.factors) {
        ordered_json variants = ordered_json::array();
        for (const VariantResult& v : f.variants)
            variants.push_back({{"name", v.name},
                                {"settings", settings_json(v.settings)},
                                {"edges_fine_voxels", to_json(v.edges)},
                                {"rmse", v.rmse},
                                {"recovered_rise", v.recovered_rise},
                                {"recovered_rmse", v.recovered_rmse},
                                {"invented", v.surface.invented},
                                {"lost", v.surface.lost},
                                {"displaced", v.surface.displaced}});
        factors.push_back({{"factor", f.factor},
                           {"dims", {f.dims.x, f.dims.y, f.dims.z}},
                           {"points", f.points},
                           {"left_out_disturbed", f.disturbed},
                           {"left_out_near_border", f.near_border},
                           {"full_edges_fine_voxels", to_json(f.full)},
                           {"variants", variants}});
    }
    return {{"schema", "edgesplat resolution report 1"},
            {"program", report.request.program},
            {"command", report.request.command},
            {"volume",
             {{"name", volume.name},
              {"checksum", fmt::format("{:016x}", volume.checksum)},
              {"dims", {d.x, d.y, d.z}},
              {"iso_values", report.request.scene.iso_values}}},
            {"device", report.device.name},
            {"width", report.request.size.x},
            {"height", report.request.size.y},
            {"factors", factors}};
}

std::string csv_of(const ResolutionReport& report) {
    std::string text =
        "factor,variant,rise_mean_fine_voxels,location_mean_fine_voxels,bias_fine_voxels,points,missed,rmse,"
        "recovered_rise,recovered_rmse,invented,lost,displaced\n";
    for (const FactorResult& f : report.factors) {
        text += fmt::format("{},full,{},{},{},{},{},0,1,1,0,0,0\n", f.factor, f.full.rise_mean, f.full.location_mean,
                            f.full.bias, f.full.measured, f.full.missed);
        for (const VariantResult& v : f.variants)
            text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{}\n", f.factor, v.name, v.edges.rise_mean,
                                v.edges.location_mean, v.edges.bias, v.edges.measured, v.edges.missed, v.rmse,
                                v.recovered_rise, v.recovered_rmse, v.surface.invented, v.surface.lost,
                                v.surface.displaced);
    }
    return text;
}

std::vector<std::string> cells_of(const std::string& name, const EdgeFigures& e, const VariantResult* v) {
    const auto percent = [](double share) { return share >= 0 ? fmt::format("{:.2f} %", 100 * share) : "-"; };
    return {name,
            fmt::format("{:.2f}", e.rise_mean),
            fmt::format("{:.2f}", e.location_mean),
            fmt::format("{:+.2f}", e.bias),
            fmt::format("{}", e.missed),
            v ? fmt::format("{:.4f}", v->rmse) : "-",
            v ? fmt::format("{:.0f} %", 100 * v->recovered_rise) : "-",
            v ? fmt::format("{:.0f} %", 100 * v->recovered_rmse) : "-",
            v ? percent(v->surface.invented) : "-",
            v ? percent(v->surface.lost) : "-",
            v ? percent(v->surface.displaced) : "-"};
}

const std::array<const char*, 11> kColumns{
    "", "rise", "place", "bias", "missed", "RMSE", "rise recovered", "RMSE recovered", "invented", "lost", "displaced"};

std::string page_of(const ResolutionReport& report) {
    const Volume& volume = *report.request.volume;
    const glm::ivec3 d = volume.geometry.dims;
    std::string html = page_begin("Loss by down-sampling: " + volume.name) +
                       fmt::format(
                           "<p class=\"facts\">{}\u00d7{}\u00d7{} voxels, checksum {:016x} \u00b7 {} \u00b7 {}"
                           "</p>\n<p class=\"lead\">{}</p>\n",
                           d.x, d.y, d.z, volume.checksum, escaped(report.device.name), escaped(report.request.program),
                           escaped(kWording));
    for (const FactorResult& f : report.factors) {
        html += fmt::format("<h2>Factor {}: {}\u00d7{}\u00d7{} voxels</h2>\n", f.factor, f.dims.x, f.dims.y, f.dims.z);
        HtmlTable table(std::vector<std::string>(kColumns.begin(), kColumns.end()));
        table.row(cells_of("full volume", f.full, nullptr), "");
        for (const VariantResult& v : f.variants)
            table.row(cells_of(v.name, v.edges, &v), "");
        html +=
            table.html() +
            fmt::format(
                "<p class=\"note\">Rise, place and bias: voxels of the full volume, along normals at {} points of its "
                "surface ({} points left out near its border, {} near another surface). "
                "Recovered: share of what plain splatting of the coarse volume loses.</p>\n",
                f.points, f.near_border, f.disturbed);
        for (std::size_t c = 0; c < report.cameras.size(); ++c) {
            html += "<h3>" + escaped(report.cameras[c].name) + "</h3>\n<div class=\"pictures\">\n" +
                    figure(report.full[c], "full volume");
            for (const VariantResult& v : f.variants)
                html += figure(v.pictures[c], v.name);
            for (const VariantResult& v : f.variants)
                html += figure(heat_map(v.pictures[c], report.full[c]), v.name + " \u2212 full");
            html += "</div>\n";
        }
    }
    return html +
           "<p class=\"note\">Differences, logarithmic: dark 0.0001, yellow 1 of full scale.</p>\n<p class=\"facts\">"
           "Command: <code>" +
           escaped(report.request.command) + "</code></p>\n" + page_end();
}

}  // namespace

void write_resolution(const ResolutionReport& report, const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) fail("cannot create the folder {}: {}", folder.string(), error.message());
    const std::array<FileContent, 3> files{{{folder / "resolution.json", json_text(json_of(report), 2) + "\n"},
                                            {folder / "resolution.csv", csv_of(report)},
                                            {folder / "resolution.html", page_of(report)}}};
    write_files(files);
}

std::string resolution_table(const ResolutionReport& report) {
    std::string text;
    for (const FactorResult& f : report.factors) {
        text += fmt::format("factor {}, {} x {} x {} voxels, {} points ({} left out)\n", f.factor, f.dims.x, f.dims.y,
                            f.dims.z, f.points, f.disturbed + f.near_border);
        const auto line = [&](const std::vector<std::string>& cells) {
            text += fmt::format("  {:<12} {:>6} {:>6} {:>6} {:>6} {:>7} {:>14} {:>14} {:>9} {:>9} {:>9}\n", cells[0],
                                cells[1], cells[2], cells[3], cells[4], cells[5], cells[6], cells[7], cells[8],
                                cells[9], cells[10]);
        };
        line({kColumns.begin(), kColumns.end()});
        line(cells_of("full volume", f.full, nullptr));
        for (const VariantResult& v : f.variants)
            line(cells_of(v.name, v.edges, &v));
    }
    return text + kWording + "\n";
}

}  // namespace edgesplat::accuracy
