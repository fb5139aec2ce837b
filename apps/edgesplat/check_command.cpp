#include "apps/edgesplat/check_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/edgesplat/json_output.h"
#include "engine/error.h"
#include "engine/scene/views.h"
#include "engine/volume/find_volumes.h"
#include "engine/volume/labels.h"
#include "engine/volume/load_volume.h"
#include "engine/volume/value_text.h"

namespace {

using edgesplat::Volume;
using Json = nlohmann::ordered_json;

struct CheckOptions {
    std::vector<std::string> paths;
    std::string json;
};

constexpr std::size_t kWidth = 120;  // columns of the table
constexpr std::size_t kMostSeries = 10000;

/// The patient's directions along which i, j, k increase, e.g. "LPS"; "none": the file names none.
std::string orientation(const Volume& volume) {
    if (!volume.in_patient) return "none";
    std::string letters;
    for (int axis = 0; axis < 3; ++axis) {
        const char letter = edgesplat::patient_letter(volume.geometry.index_to_world_axes[axis]);
        letters += letter == 'H' ? 'S' : letter == 'F' ? 'I' : letter;
    }
    return letters;
}

/// Smallest and largest value in the file's unit; of labels that are stored as ranks: their numbers.
Json range_of(const edgesplat::Volume& volume) {
    if (volume.labels && has_ranks(*volume.labels)) {
        const auto number = [&](const edgesplat::Label& label) { return std::stod(volume.labels->number_of(label)); };
        return {number(volume.labels->labels.front()), number(volume.labels->labels.back())};
    }
    return {volume.in_file_unit(static_cast<double>(volume.min_value)),
            volume.in_file_unit(static_cast<double>(volume.max_value))};
}

/// What the table and the JSON file say of a volume.
Json entry_of(const std::string& path, const Volume& volume) {
    const auto& geometry = volume.geometry;
    const glm::dvec3 spacing = geometry.spacing();
    return {{"path", path},
            {"status", "read"},
            {"format", volume.format},
            {"dims", {geometry.dims.x, geometry.dims.y, geometry.dims.z}},
            {"type", volume.stored_type},
            {"spacing_mm", {spacing.x, spacing.y, spacing.z}},
            {"orientation", orientation(volume)},
            {"geometry_source", volume.geometry_source.empty() ? "none" : volume.geometry_source},
            {"length_unit", volume.length_unit},
            {"range", range_of(volume)},
            {"no_data", volume.non_finite_count},
            {"notes", volume.notes},
            {"warnings", volume.warnings}};
}

/// Reads a volume and forgets its samples.
Json checked(const std::string& path, const std::string& name, const std::string& series) {
    std::string problem;
    try {
        edgesplat::LoadOptions options;
        options.series = series;
        return entry_of(name, edgesplat::load_volume(path, options));
    } catch (const std::bad_alloc&) {
        problem = "not enough memory for it";
    } catch (const std::exception& error) {
        problem = error.what();
    }
    if (problem.starts_with(path + ": ")) problem.erase(0, path.size() + 2);
    return {{"path", name}, {"status", "refused"}, {"error", problem}};
}

/// One entry for each volume at a path: several for a folder with several DICOM series.
std::vector<Json> all_checked(const std::string& path) {
    std::vector<Json> found{checked(path, path, "")};
    std::error_code error;
    if (found[0]["status"] == "read" || !std::filesystem::is_directory(path, error)) return found;
    std::vector<Json> series;
    for (std::size_t number = 0; number < kMostSeries; ++number) {
        const std::string text = std::to_string(number);
        Json entry = checked(path, fmt::format("{} (series {})", path, text), text);
        const std::string problem = entry.value("error", "");
        // Without several series every number is refused as the folder was.
        if (problem.find(fmt::format("--series {} is none of", text)) != std::string::npos ||
            problem == found[0].value("error", ""))
            break;
        series.push_back(std::move(entry));
    }
    if (series.size() > 1) return series;
    // Stacks that are no slices of one volume.
    std::vector<Json> stacks;
    for (const auto& file : std::filesystem::directory_iterator(path, error)) {
        const std::string ending = file.path().extension().string();
        if (ending == ".tif" || ending == ".tiff" || ending == ".TIF" || ending == ".TIFF")
            stacks.push_back(checked(file.path().string(), file.path().string(), ""));
    }
    std::ranges::sort(stacks, {}, [](const Json& entry) { return entry["path"].get<std::string>(); });
    const bool all_read = std::ranges::all_of(stacks, [](const Json& entry) { return entry["status"] == "read"; });
    return all_read && !stacks.empty() ? stacks : found;
}

/// Number of columns that UTF-8 text takes.
std::size_t columns_of(const std::string& text) {
    return static_cast<std::size_t>(
        std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

/// The text, or its end after "..", padded to a width.
std::string fitted(std::string text, std::size_t width, bool keep_end = false) {
    while (columns_of(text) > width) {
        if (keep_end)
            text = ".." + text.substr(text.starts_with("..") ? 3 : 1);
        else
            text.replace(text.size() - (text.ends_with("..") ? 3 : 1), std::string::npos, "..");
    }
    return text + std::string(width - columns_of(text), ' ');
}

/// Lines of at most `width` columns, broken between words.
void print_wrapped(const std::string& first, const std::string& text) {
    std::string line = first;
    std::size_t begin = 0;
    const std::string indent(first.size(), ' ');
    while (begin < text.size()) {
        const std::size_t end = std::min(text.find_first_of(" \n", begin), text.size());
        const std::string word = text.substr(begin, end - begin);
        if (line.size() > indent.size() && columns_of(line) + 1 + columns_of(word) > kWidth) {
            std::cout << line << '\n';
            line = indent;
        }
        if (!word.empty()) line += (line.size() > indent.size() ? " " : "") + word;
        begin = end + 1;
    }
    std::cout << line << '\n';
}

void print_row(const std::vector<std::string>& cells) {
    constexpr std::array<std::size_t, 7> kWidths{34, 10, 15, 17, 4, 15, 19};
    std::string line;
    for (std::size_t i = 0; i < kWidths.size(); ++i)
        line += fitted(cells.at(i), kWidths.at(i), i == 0) + (i + 1 < kWidths.size() ? " " : "");
    line.erase(line.find_last_not_of(' ') + 1);
    std::cout << line << '\n';
}

void print_entry(const Json& entry) {
    if (entry["status"] == "refused") {
        std::cout << fitted(entry["path"].get<std::string>(), 34, true) << " REFUSED\n";
        print_wrapped("  ! ", entry["error"].get<std::string>());
        return;
    }
    const auto& d = entry["dims"];
    const auto& s = entry["spacing_mm"];
    const double low = entry["range"][0].get<double>(), high = entry["range"][1].get<double>();
    using edgesplat::value_text;
    print_row({entry["path"], entry["format"],
               fmt::format("{} x {} x {}", d[0].get<int>(), d[1].get<int>(), d[2].get<int>()),
               fmt::format("{:.4g} {:.4g} {:.4g}", s[0].get<double>(), s[1].get<double>(), s[2].get<double>()),
               entry["orientation"], entry["geometry_source"],
               fmt::format("{} .. {}", value_text(low, high - low), value_text(high, high - low))});
    for (const auto& warning : entry["warnings"])
        print_wrapped("  ! ", warning.get<std::string>());
    for (const auto& note : entry["notes"])
        print_wrapped("    ", note.get<std::string>());
}

int run(const CheckOptions& options) {
    const edgesplat::FoundVolumes found = edgesplat::find_volumes(options.paths);
    const bool table = options.json != "-";
    Json volumes = Json::array();
    std::size_t refused = 0;
    if (table) print_row({"VOLUME", "FORMAT", "VOXELS", "SPACING, mm", "AXES", "PLACE FROM", "VALUES"});
    for (const std::string& path : found.paths)
        for (Json& entry : all_checked(path)) {
            refused += entry["status"] == "refused" ? 1 : 0;
            if (table) {
                print_entry(entry);
                std::cout.flush();
            }
            volumes.push_back(std::move(entry));
        }
    if (table)
        std::cout << fmt::format("{} volumes: {} read, {} refused; {} other files ignored\n", volumes.size(),
                                 volumes.size() - refused, refused, found.ignored);
    if (!options.json.empty())
        write_json(options.json, Json{{"volumes", volumes}, {"refused", refused}, {"ignored_files", found.ignored}});
    return refused > 0 ? 1 : 0;
}

}  // namespace

void add_check_command(CLI::App& app, int& exit_status) {
    CLI::App& command = *app.add_subcommand("check", "Read all volumes under files and folders and say what is odd");
    const auto options = std::make_shared<CheckOptions>();
    command.add_option("FILES", options->paths, "Files and folders; folders are searched with all folders inside")
        ->required()
        ->type_name("");
    command.add_option("--json", options->json, "Write JSON to a file, or to stdout with - (then without a table)")
        ->type_name("FILE");
    command.footer(
        "Reads headers and samples of every volume, one after another, and prints a line for each: format, voxels,\n"
        "spacing, the patient's directions along which i, j and k increase, the header's fields that define the "
        "place,\n"
        "and the range of values; below it warnings (!) and notes. A DICOM series, slices in a folder and a Zarr "
        "folder\n"
        "are one volume each. Files that are no volumes are counted.\n"
        "Exit status: 0 all were read, 1 some were refused.\n"
        "Example:\n  edgesplat check study/ --json study.json");
    command.callback([options, &exit_status] { exit_status = run(*options); });
}
