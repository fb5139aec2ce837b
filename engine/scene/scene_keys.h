// The table of all scene-file keys. Reading, checking and writing files, the list in docs/scene_files.md, --set on the
// command line and animated parameters use it.
#pragma once

#include <array>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "engine/scene/scene_document.h"

namespace edgesplat {

/// A TOML value. Integers and floats are doubles.
using KeyValue = std::variant<bool, double, std::string, std::vector<double>, std::vector<std::string>>;

enum class KeyType { Flag, Number, Integer, Text, Numbers, Integers, Texts };

/// Range of a number (of each number of a list); both ends are included by default. Only finite numbers are allowed.
struct KeyRange {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
    bool above_low = false, below_high = false;  ///< excludes that end
};

/// One key. `index` is the index in its list ("[]" in the path), 0 for other keys.
struct SceneKey {
    std::string path;  ///< "effects.clip.keep[].point"
    KeyType type = KeyType::Number;
    std::size_t count = 0;  ///< length of a list of numbers; 0: any
    std::string unit, help;
    KeyRange range;
    std::vector<std::string> choices;  ///< allowed texts; empty: any
    std::string absent;                ///< description of the default; empty: `default_value`
    bool direction = false;            ///< a vector that is not 0,0,0
    bool points = false;               ///< a list of [x, y, z]
    std::optional<KeyValue> default_value;
    /// The value; nullopt if the document omits it. The key's table must exist.
    std::function<std::optional<KeyValue>(const SceneDocument&, std::size_t index)> get;
    std::function<void(SceneDocument&, std::size_t index, const KeyValue&)> set;

    /// The path with `index` in place of "[]".
    std::string path_at(std::size_t index) const;
    /// "a number from 0 to 1", ...
    std::string expectation() const;
    /// Why the value is invalid; empty: it is valid.
    std::string refusal(const KeyValue& value) const;
};

/// An optional table ("effects.fog") or a list of tables ("lights").
struct SceneTable {
    std::string path, help;
    bool list = false;
    std::size_t most = 1;
    std::function<std::size_t(const SceneDocument&)> count;
    std::function<void(SceneDocument&, std::size_t count)> resize;
};

/// The keys at the top of an entry of `volumes`, each with all that is below it.
inline constexpr std::array<std::string_view, 7> kAddedKeys{"iso_values", "iso_sigmas", "transfer_preset", "volume",
                                                            "materials",  "below",      "transfer"};
inline constexpr std::string_view kAddedHelp =
    "A volume beside the first one, with the keys of its own volume and matter: iso_values, iso_sigmas, "
    "transfer_preset, [volumes.volume], [[volumes.materials]], [volumes.below], [[volumes.transfer]]";

/// Whether the key may stand in an entry of `volumes`.
bool is_of_added(std::string_view path);

/// "volumes[2].iso_values[0]" -> 2 and "iso_values[0]"; nullopt for other paths.
std::optional<std::pair<std::size_t, std::string_view>> added_address(std::string_view path);

/// All keys, in the order of files. Keys of one table are adjacent; keys without a table come first.
std::span<const SceneKey> scene_keys();
std::span<const SceneTable> scene_tables();

/// The table of a key, e.g. "effects.clip.keep[]"; empty for keys without one.
std::string table_of(const SceneKey& key);

/// The key or table with this path ("[]" for indices), or null.
const SceneKey* find_key(std::string_view path);
const SceneTable* find_table(std::string_view path);

/// "lights[2].color" -> "lights[].color" and 2; "camera.eye[1]" stays whole with `component` 1.
struct KeyAddress {
    std::string path;
    std::size_t index = 0;
    std::optional<std::size_t> component;  ///< of a list of numbers
};
/// Parses an address. Throws Error if it is invalid.
KeyAddress key_address(std::string_view concrete);

/// The message for an unknown key: that it was removed, or "unknown key" with the closest key, if any.
std::string unknown_key(std::string_view concrete);

/// The closest key to an unknown one, with its indices; empty if none is close.
std::string nearest_key(std::string_view concrete);

/// A value as TOML; numbers with the fewest digits that restore the same bits.
std::string toml_text(const KeyValue& value, KeyType type);

/// The number at a key ("effects.fog.density", "iso_values[0]", "camera.eye[2]"). Throws Error if the key does not
/// exist, is not a number, or is omitted in the scene.
double number_at(const SceneDocument& document, std::string_view key);

/// Sets the number at a key, for animated parameters. Its effect or list entry must exist in the scene. Throws Error
/// naming key, value and range.
void set_number(SceneDocument& document, std::string_view key, double value);

/// Sets a key to an animated value between others: `value` is rounded if the key holds whole numbers. Keys of the
/// volume may be open before; effects and list entries must exist. Throws Error naming key, value and range.
void animate_number(SceneDocument& document, std::string_view key, double value);

}  // namespace edgesplat
