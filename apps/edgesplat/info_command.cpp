#include "apps/edgesplat/info_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/edgesplat/json_output.h"
#include "apps/edgesplat/label_table.h"
#include "apps/edgesplat/volume_options.h"
#include "engine/volume/filters.h"
#include "engine/volume/packed_volume.h"
#include "engine/volume/value_text.h"

namespace {

using edgesplat::Volume;

struct InfoOptions {
    std::string path, json;
    VolumeOptions volume;
    int bins = 24;
};

std::vector<double> listed(const glm::dvec3& v) {
    return {v.x, v.y, v.z};
}

/// Rows of the 4 x 4 matrix from voxel indices i, j, k to world mm.
nlohmann::json affine(const edgesplat::VolumeGeometry& geometry) {
    nlohmann::json rows;
    const glm::dmat3& axes = geometry.index_to_world_axes;
    for (int row = 0; row < 3; ++row)
        rows.push_back({axes[0][row], axes[1][row], axes[2][row], geometry.origin[row]});
    rows.push_back({0.0, 0.0, 0.0, 1.0});
    return rows;
}

/// Properties of a packed volume, and the level from which iso-values are suggested.
nlohmann::json packed_description(const edgesplat::PackedVolume& packed) {
    const int suggestion_level = finest_level_within(packed, edgesplat::kMaxVoxelsAnalysed);
    nlohmann::json json{{"stored_as", packed.sample_type()},
                        {"source", packed.source()},
                        {"quantisation_error", packed.quantisation_error()},
                        {"suggestions_from_level", suggestion_level}};
    for (int level = 0; level < packed.levels(); ++level) {
        const glm::ivec3& dims = packed.geometry(level).dims;
        json["levels"].push_back({dims.x, dims.y, dims.z});
    }
    return json;
}

nlohmann::json description(const Volume& volume, int bins) {
    const auto& geometry = volume.geometry;
    const auto spacing = geometry.spacing();
    nlohmann::json json;
    json["volume"] = volume.name;
    json["dims"] = {geometry.dims.x, geometry.dims.y, geometry.dims.z};
    json["format"] = volume.format;
    json["type"] = volume.stored_type;
    json["geometry_source"] = volume.geometry_source.empty() ? "none" : volume.geometry_source;
    json["length_unit"] = volume.length_unit;
    json["affine"] = affine(geometry);
    json["in_patient"] = volume.in_patient;
    json["spacing_mm"] = listed(spacing);
    for (int axis = 0; axis < 3; ++axis)
        json["directions"].push_back(listed(geometry.index_to_world_axes[axis] / spacing[axis]));
    json["origin_mm"] = listed(geometry.origin);
    json["left_handed"] = glm::determinant(geometry.index_to_world_axes) < 0;
    const auto in_file_unit = [&](double value) { return volume.in_file_unit(value); };
    json["range"] = {in_file_unit(static_cast<double>(volume.min_value)),
                     in_file_unit(static_cast<double>(volume.max_value))};
    json["mean"] = in_file_unit(mean_of(volume));
    json["no_data"] = volume.non_finite_count;
    json["checksum"] = fmt::format("{:016x}", volume.checksum);
    if (!volume.packed) json["samples_crc32"] = fmt::format("{:08x}", samples_crc32(volume));
    json["notes"] = volume.notes;
    json["warnings"] = volume.warnings;
    const auto histogram = edgesplat::histogram(volume, bins);
    json["histogram"] = {
        {"low", in_file_unit(histogram.low)}, {"high", in_file_unit(histogram.high)}, {"counts", histogram.counts}};
    if (volume.packed) json["packed"] = packed_description(*volume.packed);
    json["suggested_iso_values"] = nlohmann::json::array();
    for (const auto& suggestion : edgesplat::suggest_iso_values(volume))
        json["suggested_iso_values"].push_back(
            {{"value", in_file_unit(suggestion.value)}, {"strength", suggestion.strength}});
    return json;
}

std::string triple(const nlohmann::json& v) {
    return fmt::format("{:.6g} {:.6g} {:.6g}", v[0].get<double>(), v[1].get<double>(), v[2].get<double>());
}

// Bars are logarithmic: most volumes are mostly air.
void print_histogram(const nlohmann::json& histogram) {
    const auto counts = histogram["counts"].get<std::vector<std::size_t>>();
    const double low = histogram["low"], high = histogram["high"];
    std::vector<double> from;
    for (std::size_t bin = 0; bin < counts.size(); ++bin)
        from.push_back(low + (high - low) * static_cast<double>(bin) / static_cast<double>(counts.size()));
    const std::vector<std::string> texts = edgesplat::value_texts(from, high - low);
    double longest = 0;
    for (const auto count : counts)
        longest = std::max(longest, std::log2(1.0 + static_cast<double>(count)));
    for (std::size_t bin = 0; bin < counts.size(); ++bin) {
        const double length = std::log2(1.0 + static_cast<double>(counts[bin]));
        std::cout << fmt::format(
            "  {:>12} {:>11} {}\n", texts[bin], counts[bin],
            std::string(static_cast<std::size_t>(std::lround(50 * length / std::max(longest, 1.0))), '#'));
    }
}

void print_packed(const nlohmann::json& json) {
    std::cout << fmt::format("packed      from {}, stored as {}, error at most {:.3g}\n",
                             json["source"].get<std::string>(), json["stored_as"].get<std::string>(),
                             json["quantisation_error"].get<double>());
    for (std::size_t level = 0; level < json["levels"].size(); ++level) {
        const auto& dims = json["levels"][level];
        std::cout << fmt::format("level {:<5} {} x {} x {}\n", level, dims[0].get<int>(), dims[1].get<int>(),
                                 dims[2].get<int>());
    }
}

/// "sform (code 2), in mm": where the geometry comes from.
std::string place_text(const nlohmann::json& json) {
    const auto unit = json["length_unit"].get<std::string>();
    return fmt::format("{}{}, {}", json["geometry_source"].get<std::string>(),
                       unit.empty() ? ", no unit named: mm" : ", unit " + unit,
                       json["in_patient"].get<bool>() ? "patient axes (LPS)" : "no patient axes");
}

void print(const nlohmann::json& json, const std::array<std::string, 2>& range_ends) {
    const double low = json["range"][0].get<double>(), high = json["range"][1].get<double>();
    const auto& d = json["dims"];
    const double voxels = d[0].get<double>() * d[1].get<double>() * d[2].get<double>();
    std::cout << fmt::format("volume      {}\n", json["volume"].get<std::string>())
              << fmt::format("dims        {} x {} x {} ({:.4g} M voxels)\n", d[0].get<int>(), d[1].get<int>(),
                             d[2].get<int>(), voxels / 1e6)
              << fmt::format("format      {}\n", json["format"].get<std::string>())
              << fmt::format("type        {}\n", json["type"].get<std::string>())
              << fmt::format("place       {}\n", place_text(json))
              << fmt::format("spacing     {} mm\n", triple(json["spacing_mm"]));
    const char* const names = "ijk";
    for (std::size_t axis = 0; axis < 3; ++axis)
        std::cout << fmt::format("direction {} {}\n", names[axis], triple(json["directions"][axis]));
    std::cout << fmt::format("origin      {} mm{}\n", triple(json["origin_mm"]),
                             json["left_handed"].get<bool>() ? " (left-handed)" : "")
              << fmt::format("range       {} .. {}, mean {}\n", range_ends[0], range_ends[1],
                             edgesplat::value_text(json["mean"].get<double>(), high - low))
              << fmt::format("no data     {} samples\n", json["no_data"].get<std::size_t>())
              << fmt::format("checksum    {}{}\n", json["checksum"].get<std::string>(),
                             json.contains("samples_crc32")
                                 ? ", CRC-32 of the samples " + json["samples_crc32"].get<std::string>()
                                 : "");
    for (const auto& note : json["notes"])
        std::cout << "note        " << note.get<std::string>() << '\n';
    for (const auto& warning : json["warnings"])
        std::cout << "warning     " << warning.get<std::string>() << '\n';
    const bool packed = json.contains("packed");
    if (packed) print_packed(json["packed"]);
    std::cout << "histogram   (lower bound, voxels, logarithmic bar"
              << (packed ? "; merged from the file's histogram)\n" : ")\n");
    print_histogram(json["histogram"]);
    std::cout << "suggested iso-values"
              << (packed ? fmt::format(" (from level {})", json["packed"]["suggestions_from_level"].get<int>()) : "")
              << ":";
    std::vector<double> values;
    for (const auto& suggestion : json["suggested_iso_values"])
        values.push_back(suggestion["value"].get<double>());
    const std::vector<std::string> texts = edgesplat::value_texts(values, high - low);
    for (std::size_t i = 0; i < texts.size(); ++i)
        std::cout << fmt::format(" {} ({:.2f})", texts[i], json["suggested_iso_values"][i]["strength"].get<double>());
    std::cout << (json["suggested_iso_values"].empty() ? " none\n" : "\n");
    print_labels(json);
}

void run(const InfoOptions& options) {
    edgesplat::VolumeSource source{.path = options.path};
    apply(options.volume, source);
    const Volume volume = load_with_progress(
        [&](const edgesplat::LoadProgress& progress) {
            return read_source(source, edgesplat::volume_folders({}), progress);
        },
        false);
    auto json = description(volume, options.bins);
    add_labels(json, volume);
    if (options.json.empty())
        print(json, {value_text(volume, volume.min_value), value_text(volume, volume.max_value)});
    else
        write_json(options.json, json);
}

}  // namespace

void add_info_command(CLI::App& app) {
    const auto options = std::make_shared<InfoOptions>();
    auto* command = app.add_subcommand("info", "Print a volume's size, position, values and likely iso-values");
    command->add_option("volume", options->path, "A volume file, a folder or pattern of slices, or builtin:NAME")
        ->required();
    add_volume_options(*command, options->volume);
    command->add_option("--json", options->json, "Write JSON to a file, or to stdout with -");
    command->add_option("--bins", options->bins, "Number of bins of the histogram")->check(CLI::Range(1, 1024));
    command->callback([options] { run(*options); });
}
