// Builds scene-file keys from members of SceneDocument.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "engine/scene/scene_keys.h"

namespace edgesplat {

template <typename T>
struct is_optional : std::false_type {};
template <typename T>
struct is_optional<std::optional<T>> : std::true_type {};

/// Converts a member of the document to a value of a file, and back.
template <typename T>
KeyValue to_value(const T& v, const std::vector<std::string>& choices) {
    if constexpr (std::is_enum_v<T>)
        return choices[static_cast<std::size_t>(v)];
    else if constexpr (std::is_same_v<T, int>)
        return static_cast<double>(v);
    else if constexpr (std::is_same_v<T, glm::dvec3> || std::is_same_v<T, glm::ivec3>)
        return std::vector<double>{static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
    else if constexpr (std::is_same_v<T, glm::ivec2>)
        return std::vector<double>{static_cast<double>(v.x), static_cast<double>(v.y)};
    else
        return v;
}

template <typename T>
T from_value(const KeyValue& value, const std::vector<std::string>& choices) {
    if constexpr (std::is_enum_v<T>) {
        const auto found = std::find(choices.begin(), choices.end(), std::get<std::string>(value));
        return static_cast<T>(found - choices.begin());
    } else if constexpr (std::is_same_v<T, int>) {
        return static_cast<int>(std::get<double>(value));
    } else if constexpr (std::is_same_v<T, glm::dvec3> || std::is_same_v<T, glm::ivec3>) {
        const auto& v = std::get<std::vector<double>>(value);
        return T(v[0], v[1], v[2]);
    } else if constexpr (std::is_same_v<T, glm::ivec2>) {
        const auto& v = std::get<std::vector<double>>(value);
        return T(v[0], v[1]);
    } else {
        return std::get<T>(value);
    }
}

template <typename T>
void describe(SceneKey& key) {
    if constexpr (std::is_same_v<T, bool>) key.type = KeyType::Flag;
    if constexpr (std::is_same_v<T, double>) key.type = KeyType::Number;
    if constexpr (std::is_same_v<T, int>) key.type = KeyType::Integer;
    if constexpr (std::is_same_v<T, std::string> || std::is_enum_v<T>) key.type = KeyType::Text;
    if constexpr (std::is_same_v<T, std::vector<std::string>>) key.type = KeyType::Texts;
    if constexpr (std::is_same_v<T, std::vector<double>>) key.type = KeyType::Numbers;
    if constexpr (std::is_same_v<T, glm::dvec3>) key.type = KeyType::Numbers, key.count = 3;
    if constexpr (std::is_same_v<T, glm::ivec3>) key.type = KeyType::Integers, key.count = 3;
    if constexpr (std::is_same_v<T, glm::ivec2>) key.type = KeyType::Integers, key.count = 2;
}

/// Collects the rows of the key table, each from a member of the document.
class KeyTable {
  public:
    /// Adds a key for the member that `access` returns. `facts` holds the row's data except path and type.
    template <typename Access>
    void add(const char* path, Access access, SceneKey facts) {
        using Member = std::remove_reference_t<decltype(access(std::declval<SceneDocument&>(), std::size_t{}))>;
        SceneKey key = std::move(facts);
        key.path = path;
        if constexpr (is_optional<Member>::value) {
            using T = typename Member::value_type;
            describe<T>(key);
            key.get = [access, choices = key.choices](const SceneDocument& d, std::size_t i) {
                const auto& member = access(d, i);
                return member ? std::optional(to_value(*member, choices)) : std::nullopt;
            };
            key.set = [access, choices = key.choices](SceneDocument& d, std::size_t i, const KeyValue& v) {
                access(d, i) = from_value<T>(v, choices);
            };
        } else {
            describe<Member>(key);
            key.get = [access, choices = key.choices](const SceneDocument& d, std::size_t i) {
                std::optional<KeyValue> value = to_value(access(d, i), choices);
                // In a document, an empty text or list means "not given".
                if constexpr (requires(const Member& m) { m.empty(); })
                    if (access(d, i).empty()) value.reset();
                return value;
            };
            key.set = [access, choices = key.choices](SceneDocument& d, std::size_t i, const KeyValue& v) {
                access(d, i) = from_value<Member>(v, choices);
            };
        }
        keys.push_back(std::move(key));
    }

    std::vector<SceneKey> keys;
};

}  // namespace edgesplat
