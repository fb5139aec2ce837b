#include "engine/viewer/preferences.h"

#include <toml++/toml.h>
#include <algorithm>
#include <cmath>
#include <exception>
#include <sstream>

#include "engine/image/image_file.h"
#include "engine/scene/scene_presets.h"
#include "engine/scene/text_file.h"
#include "engine/volume/analytic_volumes.h"

namespace edgesplat::viewer {
namespace {

namespace fs = std::filesystem;

void read(const toml::table& table, const char* key, double& out, double low, double high) {
    const double value = table[key].value<double>().value_or(out);
    if (std::isfinite(value) && value >= low && value <= high) out = value;
}

void read(const toml::table& table, const char* key, int& out, int low, int high) {
    // Only integers are accepted (8e1 is not): toml++ casts doubles beyond the range of an integer.
    const toml::value<std::int64_t>* integer = table[key].as_integer();
    const std::int64_t value = integer ? integer->get() : out;
    if (value >= low && value <= high) out = static_cast<int>(value);
}

}  // namespace

fs::path preferences_path() {
    const fs::path folder = config_folder();
    return folder.empty() ? folder : folder / "fly.toml";
}

Preferences read_preferences(const fs::path& path) {
    Preferences out;
    toml::table table;
    try {
        table = toml::parse(read_text_file(path, "preferences"));
    } catch (const std::exception&) {
        return out;
    }
    if (const toml::array* recent = table["recent"].as_array())
        for (const toml::node& entry : *recent)
            if (const auto text = entry.value<std::string>(); text && out.recent.size() < kMostRecent)
                out.recent.push_back(*text);
    read(table, "width", out.width, 320, 16384);
    read(table, "height", out.height, 240, 16384);
    read(table, "target_ms", out.target, 0, 10000);
    read(table, "turn", out.turn, 0.05, 20);
    read(table, "speed", out.speed, 0.05, 20);
    read(table, "text_scale", out.text_scale, 0, 8);
    out.collisions = table["collisions"].value<bool>().value_or(out.collisions);
    out.invert_look = table["invert_look"].value<bool>().value_or(out.invert_look);
    out.device = table["device"].value<std::string>().value_or(out.device);
    return out;
}

void write_preferences(const Preferences& preferences, const fs::path& path) {
    toml::array recent;
    for (const std::string& entry : preferences.recent)
        recent.push_back(entry);
    const toml::table table{{"recent", recent},
                            {"width", preferences.width},
                            {"height", preferences.height},
                            {"target_ms", preferences.target},
                            {"turn", preferences.turn},
                            {"speed", preferences.speed},
                            {"text_scale", preferences.text_scale},
                            {"collisions", preferences.collisions},
                            {"invert_look", preferences.invert_look},
                            {"device", preferences.device}};
    std::ostringstream text;
    text << table << '\n';
    std::error_code error;
    fs::create_directories(path.parent_path(), error);
    const FileContent content{path, text.str()};
    write_files({&content, 1});
}

void remember(Preferences& preferences, const std::string& path) {
    std::string entry = path;
    std::error_code error;
    if (!is_builtin(path)) entry = fs::absolute(path, error).lexically_normal().string();
    std::erase(preferences.recent, entry);
    preferences.recent.insert(preferences.recent.begin(), entry);
    if (preferences.recent.size() > kMostRecent) preferences.recent.resize(kMostRecent);
}

void remove_missing(Preferences& preferences) {
    std::erase_if(preferences.recent, [](const std::string& path) {
        std::error_code error;
        return !is_builtin(path) && fs::status(path, error).type() == fs::file_type::not_found;
    });
}

}  // namespace edgesplat::viewer
