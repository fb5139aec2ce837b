// The header of NRRD files: fields, key/value pairs, data files. Internal to engine/volume.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/volume/volume.h"

namespace edgesplat::detail {

struct NrrdHeader {
    std::string path;                               ///< the user's path, used in messages
    std::map<std::string, std::string> fields;      ///< by the field's name in lower case without blanks
    std::map<std::string, std::string> key_values;  ///< lines "key:=value"
    std::vector<std::string> listed_files;          ///< lines after "data file: LIST"
    std::size_t bytes = 0;                          ///< offset of attached data
    std::vector<std::string> warnings;              ///< lines without effect that look like fields

    bool has(const std::string& field) const { return fields.count(field) > 0; }
    std::string value(const std::string& field) const {
        const auto found = fields.find(field);
        return found == fields.end() ? "" : found->second;
    }
    /// Words of a field; a text in double quotes is one word, without the quotes. Fails unless there are `count`.
    std::vector<std::string> words(const std::string& field, std::size_t count) const;
    /// Numbers of a per-axis field, NaN for axes without one. Fails unless there are `count` and none is infinite.
    std::vector<double> numbers(const std::string& field, std::size_t count) const;
    /// Vectors "(1,0,0)" of a field; nullopt for "none". Fails if a component is no number.
    std::vector<std::optional<std::vector<double>>> vectors(const std::string& field) const;
    /// Words of any number in a text that belongs to a field.
    static std::vector<std::string> split(const std::string& text);
    long long whole(const std::string& field, long long otherwise) const;
    /// The text as a whole number; messages name the field.
    long long whole_in(const std::string& field, const std::string& text) const;
    [[noreturn]] void refuse(const std::string& field, const std::string& reason) const;
};

/// Reads the header of `file`; messages name `path`. Fails if a line is neither a field, a comment nor a key/value
/// pair, if a field occurs twice with different values, or if the header is longer than 16 MiB.
NrrdHeader nrrd_header(const std::string& path, const std::string& file);

/// A layer of a Slicer segmentation: numbers, names and colours of its segments; empty if there is none.
std::vector<std::vector<Label>> nrrd_segments(const NrrdHeader& header);
/// Sets `volume.labels` of a volume whose values are read: its numbers, with the names and colours of `segments`.
void name_segments(const std::vector<Label>& segments, Volume& volume);

}  // namespace edgesplat::detail
