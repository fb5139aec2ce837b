// The table of everything a scene file can say. Reading, checking and writing files, the list in docs/scene_files.md,
// --set on the command line and animated parameters are all made from it.
#pragma once

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

/// A value as TOML knows it. Numbers of both kinds are doubles.
using KeyValue = std::variant<bool, double, std::string, std::vector<double>, std::vector<std::string>>;

enum class KeyType { Flag, Number, Integer, Text, Numbers, Integers, Texts };

/// Values a number (each number of a list) may have; both ends included unless said otherwise. Not finite: never.
struct KeyRange {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
    bool above_low = false, below_high = false;  ///< that end is excluded
};

/// One key. `index` is that of the list it is in ("[]" in its path), 0 for others.
struct SceneKey {
    std::string path;  ///< "effects.clip.keep[].point"
    KeyType type = KeyType::Number;
    std::size_t count = 0;  ///< numbers in a list; 0: any
    std::string unit, help;
    KeyRange range;
    std::vector<std::string> choices;  ///< the texts that are allowed; empty: any
    std::string absent;                ///< what holds where the key is not given, in words; empty: `default_value`
    bool direction = false;            ///< a vector other than 0,0,0
    bool points = false;               ///< a list of [x, y, z]
    std::optional<KeyValue> default_value;
    /// Nothing where the document leaves it open. The table the key is in must be there.
    std::function<std::optional<KeyValue>(const SceneDocument&, std::size_t index)> get;
    std::function<void(SceneDocument&, std::size_t index, const KeyValue&)> set;

    /// The path with `index` in place of "[]".
    std::string path_at(std::size_t index) const;
    /// "a number from 0 to 1", ...
    std::string expectation() const;
    /// What is wrong with the value; empty: nothing.
    std::string refusal(const KeyValue& value) const;
};

/// A table that is there or not ("effects.fog"), or a list of tables ("lights").
struct SceneTable {
    std::string path, help;
    bool list = false;
    std::size_t most = 1;
    std::function<std::size_t(const SceneDocument&)> count;
    std::function<void(SceneDocument&, std::size_t count)> resize;
};

/// All keys, in the order in which files are written. Keys of one table are neighbours, those without a table first.
std::span<const SceneKey> scene_keys();
std::span<const SceneTable> scene_tables();

/// The table a key is in: "effects.clip.keep[]"; empty for those without one.
std::string table_of(const SceneKey& key);

/// The key or table of that path ("[]" for indices), or null.
const SceneKey* find_key(std::string_view path);
const SceneTable* find_table(std::string_view path);

/// "lights[2].color" -> "lights[].color" and 2; "camera.eye[1]" stays whole with `component` 1.
struct KeyAddress {
    std::string path;
    std::size_t index = 0;
    std::optional<std::size_t> component;  ///< of a list of numbers
};
/// Throws Error where it is no path.
KeyAddress key_address(std::string_view concrete);

/// What is wrong with a path that is no key: that it was one once, or "unknown key", with the nearest if one is near.
std::string unknown_key(std::string_view concrete);

/// The path of the table spelled most like an unknown one, with indices as given; empty if none is near.
std::string nearest_key(std::string_view concrete);

/// A value as TOML spells it; numbers in as few digits as are read back to the same bits.
std::string toml_text(const KeyValue& value, KeyType type);

/// The number at a key ("effects.fog.density", "iso_values[0]", "camera.eye[2]"). Throws Error: no such key, no number
/// there, or the scene leaves it open.
double number_at(const SceneDocument& document, std::string_view key);

/// Sets such a number, for animated parameters; what is not there (an effect, an entry of a list) must be made by the
/// scene first. Throws Error naming key, value and range.
void set_number(SceneDocument& document, std::string_view key, double value);

}  // namespace edgesplat
