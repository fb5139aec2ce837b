#include "engine/scene/scene_presets.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>

#include "engine/scene/embedded_presets.h"
#include "engine/scene/nearest_name.h"
#include "engine/scene/scene_file.h"

namespace edgesplat {
namespace {

namespace fs = std::filesystem;

/// Whether it sets more than materials and transfer functions can.
bool sets_light(const SceneDocument& content) {
    const SceneDocument usual;
    return content.ambient != usual.ambient || content.lights != usual.lights || content.lit != usual.lit ||
           content.background != usual.background || content.effects != usual.effects || content.volume.labels;
}

/// Parses a preset's text; throws if it is not a valid preset.
ScenePreset parsed(std::string_view name, const std::string& file, std::string_view text) {
    const std::string called = file == "built in" ? "preset " + std::string(name) : file;
    ScenePreset preset{std::string(name), file, PresetKind::Look, parse_scene(text, called, {.preset = true})};
    const SceneDocument& content = preset.content;
    const std::size_t materials = content.materials.size(), points = content.transfer.size();
    if (!sets_light(content) && content.iso_sigmas.empty()) {
        if (materials == 1 && points == 0 && content.iso_values.size() <= 1) preset.kind = PresetKind::Material;
        if (materials == 0 && points > 0) preset.kind = PresetKind::Transfer;
    }
    const std::size_t surfaces = std::max(content.iso_values.size(), content.iso_sigmas.size());
    const bool matched = materials == surfaces || materials == 0 || (surfaces == 0 && materials == 1);
    if ((materials > 0 && points > 0) || (materials == 0 && points == 0 && !sets_light(content)) || !matched)
        throw SceneFileError({called +
                              ": expected one [[materials]] for each of iso_values or iso_sigmas (optional for "
                              "a single material), or [[transfer]] points with optional iso_values"});
    if (preset.kind == PresetKind::Material && !content.materials.front().preset.empty())
        throw SceneFileError({called + ": materials[0].preset: a preset cannot use another preset"});
    return preset;
}

}  // namespace

fs::path config_folder() {
    const char* config = std::getenv("XDG_CONFIG_HOME");
    const char* home = std::getenv("HOME");
    if (config && *config != '\0') return fs::path(config) / "edgesplat";
    if (home && *home != '\0') return fs::path(home) / ".config" / "edgesplat";
    return {};
}

std::vector<fs::path> preset_folders() {
    std::vector<fs::path> folders;
    if (const char* text = std::getenv("EDGESPLAT_PRESETS")) {
        std::istringstream in(text);
        for (std::string folder; std::getline(in, folder, ':');)
            if (!folder.empty()) folders.emplace_back(folder);
    }
    if (const fs::path config = config_folder(); !config.empty()) folders.push_back(config / "presets");
    return folders;
}

std::vector<std::string> scene_preset_names() {
    std::set<std::string> names;
    std::error_code ignored;
    for (const fs::path& folder : preset_folders())
        for (const auto& entry : fs::directory_iterator(folder, ignored))
            if (entry.path().extension() == ".toml") names.insert(entry.path().stem().string());
    for (const EmbeddedPreset& preset : embedded_presets())
        names.emplace(preset.name);
    return {names.begin(), names.end()};
}

ScenePreset scene_preset(std::string_view name) {
    std::error_code ignored;
    const bool plain = !name.empty() && name.find('/') == std::string_view::npos;
    for (const fs::path& folder : preset_folders()) {
        const fs::path path = folder / (std::string(name) + ".toml");
        if (!plain || !fs::is_regular_file(path, ignored)) continue;
        std::ifstream in(path, std::ios::binary);
        std::ostringstream text;
        text << in.rdbuf();
        return parsed(name, path.string(), text.str());
    }
    for (const EmbeddedPreset& preset : embedded_presets())
        if (preset.name == name) return parsed(name, "built in", preset.text);
    const std::vector<std::string> names = scene_preset_names();
    const std::string nearest = nearest_name(name, names);
    fail("\"{}\": no preset has this name; {}", name,
         nearest.empty() ? fmt::format("expected one of: {}", fmt::join(names, ", "))
                         : "did you mean \"" + nearest + "\"?");
}

void apply_look(SceneDocument& document, std::string_view name) {
    const SceneDocument content = scene_preset(name).content;
    document.iso_values = content.iso_values;
    document.iso_sigmas = content.iso_sigmas;
    document.below = content.below;
    document.materials = content.materials;
    document.transfer = content.transfer;
    document.transfer_preset.clear();
    document.ambient = content.ambient;
    document.lights = content.lights;
    document.lit = content.lit;
    document.background = content.background;
    document.effects = content.effects;
    if (content.volume.labels) document.volume.labels = content.volume.labels;
}

}  // namespace edgesplat
