#include "apps/edgesplat/measure_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/edgesplat/camera_options.h"
#include "apps/edgesplat/document_edits.h"
#include "apps/edgesplat/effects_options.h"
#include "apps/edgesplat/json_output.h"
#include "apps/edgesplat/label_table.h"
#include "apps/edgesplat/progress_bar.h"
#include "apps/edgesplat/render_command.h"
#include "apps/edgesplat/scene_options.h"
#include "apps/edgesplat/volume_options.h"
#include "engine/error.h"
#include "engine/image/image_file.h"
#include "engine/measure/extents.h"
#include "engine/measure/places.h"
#include "engine/viewer/contour.h"
#include "engine/viewer/pick.h"

namespace {

using edgesplat::Scene;
using edgesplat::SceneDocument;
using edgesplat::Volume;
using edgesplat::measure::Place;
using edgesplat::measure::Quantity;
using Json = nlohmann::ordered_json;

/// A value of --at.
struct Spot {
    std::string text;
    std::vector<double> numbers;  ///< two: a pixel; three: a position
};

struct MeasureCommand {
    std::string source, json;
    VolumeOptions volume;
    DocumentEdits edits;
    std::vector<Spot> spots;
    bool exact = false, quiet = false;
};

Spot read_spot(const std::string& text) {
    Spot spot{text, {}};
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t comma = std::min(text.find(',', begin), text.size());
        const auto number = parse_number(std::string_view(text).substr(begin, comma - begin));
        if (!number) break;
        spot.numbers.push_back(*number);
        begin = comma + 1;
        if (comma == text.size() && (spot.numbers.size() == 2 || spot.numbers.size() == 3)) return spot;
    }
    throw CLI::ValidationError(
        "--at", fmt::format("'{}' is neither a position X,Y,Z nor a pixel X,Y, such as 12.5,-3,40 or 256,200", text));
}

/// The visible surface at a pixel.
Place visible_surface(const Spot& spot, const SceneDocument& document, const Volume& volume, const Scene& scene) {
    const auto camera = resolve_camera(document, volume, scene);
    const glm::dvec2 pixel(spot.numbers[0], spot.numbers[1]);
    const auto hit = edgesplat::viewer::pick(volume, scene, camera, document.output.size, pixel);
    if (!hit)
        edgesplat::fail("--at {}: no surface is visible at this pixel of {}x{}", spot.text, document.output.size.x,
                        document.output.size.y);
    return edgesplat::measure::place_of(*hit);
}

Place place_at(const Spot& spot, const MeasureCommand& command, const SceneDocument& document, const Volume& volume,
               const Scene& scene) {
    if (spot.numbers.size() == 2) return visible_surface(spot, document, volume, scene);
    const glm::dvec3 given(spot.numbers[0], spot.numbers[1], spot.numbers[2]);
    const glm::dvec3 world = document.camera.voxel ? volume.geometry.to_world(given) : given;
    if (command.exact) return {world};
    const auto surface = edgesplat::measure::nearest_surface(volume, scene.iso_values, world);
    if (!surface)
        edgesplat::fail(
            "--at {}: no surface is within {} voxels of this position; --exact measures the position itself", spot.text,
            edgesplat::viewer::kCrossingReach);
    return *surface;
}

Json to_json(const Quantity& quantity) {
    return {{"value", quantity.value}, {"uncertainty", quantity.uncertainty}};
}

/// "12.34 ± 0.05": the uncertainty rounded up to two digits, and the value to the same decimal place.
std::string text(const Json& quantity) {
    const double value = quantity["value"].get<double>(), uncertainty = quantity["uncertainty"].get<double>();
    if (!(uncertainty > 0)) return fmt::format("{:.7g}", value);
    const int digits = 1 - static_cast<int>(std::floor(std::log10(uncertainty)));
    const double unit = std::pow(10.0, -digits);
    const int places = std::clamp(digits, 0, 12);
    return fmt::format("{:.{}f} ± {:.{}f}", value, places, std::ceil(uncertainty / unit - 1e-9) * unit, places);
}

Json places_measured(const MeasureCommand& command, const SceneDocument& document, const Volume& volume,
                     const Scene& scene) {
    using edgesplat::measure::angle;
    using edgesplat::measure::distance;
    std::vector<Place> places;
    for (const Spot& spot : command.spots)
        places.push_back(place_at(spot, command, document, volume, scene));
    Json json;
    for (const Place& place : places) {
        Json entry{{"world_mm", {place.world.x, place.world.y, place.world.z}}, {"uncertainty_mm", place.uncertainty}};
        if (place.iso && !volume.is_label_mask()) entry["iso_value"] = volume.in_file_unit(*place.iso);
        if (const Json label = described_label_at(volume, place.world); !label.is_null()) entry.update(label);
        json["places"].push_back(entry);
    }
    for (std::size_t i = 1; i < places.size(); ++i)
        json["distances_mm"].push_back(to_json(distance(places[i - 1], places[i])));
    for (std::size_t i = 2; i < places.size(); ++i)
        json["angles_degrees"].push_back(to_json(angle(places[i - 2], places[i - 1], places[i])));
    return json;
}

Json extents_measured(const MeasureCommand& command, const Volume& volume, const Scene& scene) {
    if (scene.iso_values.empty())
        edgesplat::fail("measure: a transfer function without iso-values does not separate materials; give --iso");
    ProgressBar bar(command.quiet);
    const auto start = std::chrono::steady_clock::now();
    const auto extents =
        edgesplat::measure::measure_extents(volume, scene.iso_values, scene.effects.clip, [&](double done) {
            const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
            bar.update(done, spent.count() * (1 - done) / done, "measuring");
            return true;
        });
    Json json;
    for (std::size_t m = 0; m < extents.volumes.size(); ++m) {
        Json material;
        if (!scene.materials[m].name.empty()) material["name"] = scene.materials[m].name;
        if (m > 0) material["from"] = volume.in_file_unit(scene.iso_values[m - 1]);
        if (m < scene.iso_values.size()) material["below"] = volume.in_file_unit(scene.iso_values[m]);
        material["volume_mm3"] = to_json(extents.volumes[m]);
        json["materials"].push_back(material);
    }
    for (std::size_t j = 0; j < extents.surfaces.size(); ++j)
        json["surfaces"].push_back(
            {{"iso_value", volume.in_file_unit(scene.iso_values[j])}, {"area_mm2", to_json(extents.surfaces[j])}});
    return json;
}

/// An iso-value with all its digits, up to ten.
std::string value(const Json& iso) {
    return fmt::format("{:.10g}", iso.get<double>());
}

std::string interval(const Json& material) {
    std::string words;
    if (material.contains("from")) words += fmt::format("from {}", value(material["from"]));
    if (material.contains("below"))
        words += fmt::format("{}below {}", words.empty() ? "" : ", ", value(material["below"]));
    if (material.contains("name")) words += fmt::format(" ({})", material["name"].get<std::string>());
    return words;
}

/// "7 spleen"
std::string label_text(const Json& entry) {
    return entry["label"].dump() + (entry.contains("name") ? " " + entry["name"].get<std::string>() : "");
}

void print(const Json& json) {
    int number = 0;
    for (const Json& place : json.value("places", Json::array())) {
        const Json& at = place["world_mm"];
        std::cout << fmt::format("place {:<3} {:.7g}, {:.7g}, {:.7g} mm", ++number, at[0].get<double>(),
                                 at[1].get<double>(), at[2].get<double>());
        if (place.contains("iso_value"))
            std::cout << fmt::format(" ± {:.2g}, on the surface at {}", place["uncertainty_mm"].get<double>(),
                                     value(place["iso_value"]));
        else if (place["uncertainty_mm"].get<double>() > 0)
            std::cout << fmt::format(" ± {:.2g}", place["uncertainty_mm"].get<double>());
        if (place.contains("label")) std::cout << fmt::format(", label {}", label_text(place));
        std::cout << '\n';
    }
    number = 0;
    for (const Json& length : json.value("distances_mm", Json::array())) {
        std::cout << fmt::format("distance {} to {}: {} mm\n", number + 1, number + 2, text(length));
        ++number;
    }
    number = 0;
    for (const Json& angle : json.value("angles_degrees", Json::array())) {
        std::cout << fmt::format("angle at {}: {} degrees\n", number + 2, text(angle));
        ++number;
    }
    for (const Json& material : json.value("materials", Json::array()))
        std::cout << fmt::format("volume {}: {} mm^3\n", interval(material), text(material["volume_mm3"]));
    for (const Json& surface : json.value("surfaces", Json::array()))
        std::cout << fmt::format("surface at {}: {} mm^2\n", value(surface["iso_value"]), text(surface["area_mm2"]));
    for (const Json& label : json.value("labels", Json::array()))
        std::cout << fmt::format(
            "label {}: {} mm^3, {} voxels{}\n", label_text(label), text(label["volume_mm3"]),
            label["voxels"].get<std::size_t>(),
            label.contains("mean") ? fmt::format(", mean {:.6g}, standard deviation {:.3g}",
                                                 label["mean"].get<double>(), label["standard_deviation"].get<double>())
                                   : "");
}

void run(const MeasureCommand& command) {
    SceneDocument document;
    std::vector<std::filesystem::path> folders;
    read_source(command.source, document, folders);
    apply(command.volume, document.volume);
    command.edits.apply(document);
    if (!command.json.empty() && command.json != "-") {
        constexpr std::array<std::string_view, 1> kJson{".json"};
        edgesplat::check_output_path(command.json, kJson);
    }
    const edgesplat::VolumeSource chosen = document.volume;
    // Values of labels are those of the scan before matter of hidden labels is removed.
    if (command.spots.empty() && !document.volume.segmentation.empty()) {
        document.volume.only.clear();
        document.volume.hide.clear();
    }
    const Volume volume = load_with_progress(document, folders, command.quiet);
    Json json{{"volume", volume.name}};
    const Scene scene = resolve_scene(document, volume);
    json.update(!command.spots.empty() ? places_measured(command, document, volume, scene)
                : volume.shown_labels  ? labels_measured(volume, scene.effects.clip, chosen)
                                       : extents_measured(command, volume, scene));
    if (command.json.empty())
        print(json);
    else
        write_json(command.json, json);
}

}  // namespace

void add_measure_command(CLI::App& app) {
    CLI::App& sub = *app.add_subcommand("measure", "Measure volumes and surfaces, or distances and angles");
    const auto command = std::make_shared<MeasureCommand>();
    sub.add_option("VOLUME", command->source, "A volume or a scene file (.toml), as for `edgesplat render`")
        ->required()
        ->type_name("");
    sub.add_option_function<std::vector<std::string>>(
           "--at",
           [command](const std::vector<std::string>& texts) {
               for (const std::string& text : texts)
                   command->spots.push_back(read_spot(text));
           },
           "Place to measure. X,Y,Z: a position in world mm (with --voxel: voxel indices), moved to the nearest "
           "surface. X,Y: the surface at a pixel of the picture that these options render. Repeat it to measure "
           "distances between successive places, and angles")
        ->type_name("X,Y,Z|X,Y")
        ->allow_extra_args(false);
    sub.add_flag("--exact", command->exact, "Do not move positions X,Y,Z to a surface");
    sub.add_option("--json", command->json, "Write JSON to a file, or to stdout with -")->type_name("FILE");
    sub.add_flag("-q,--quiet", command->quiet, "Print no progress");
    add_camera_options(sub, command->edits);
    add_scene_options(sub, command->edits);
    add_effects_options(sub, command->edits);
    add_volume_options(sub, command->volume);
    sub.footer(
        "Measures the volume of each material between iso-values and the area of each iso-surface, inside the clip\n"
        "planes; of a segmentation the volume of each label that is shown, and with --segmentation the mean of the\n"
        "volume's values in it. The number after ± is the uncertainty from "
        "rounding, spacing and blur of the samples. It does not\n"
        "include noise or a wrong iso-value.\n"
        "Examples:\n"
        "  edgesplat measure head.nrrd --iso 300\n"
        "  edgesplat measure aneurysm.nrrd --iso 180 --clip-box=-20,-5,30,0,15,50\n"
        "  edgesplat measure head.nrrd --iso 300 --at 12,-40,8 --at 15,-38,30\n"
        "  edgesplat measure head.nrrd --iso 300 --view front --size 800x600 --at 400,210 --at 420,330 --at 500,330");
    sub.callback([command] { run(*command); });
}
