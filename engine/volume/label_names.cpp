#include "engine/volume/label_names.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <unordered_set>

#include "engine/error.h"
#include "engine/image/srgb.h"

namespace edgesplat {
namespace {
namespace names_file {  // other files of this library have helpers of the same names

using Words = std::vector<std::string>;

constexpr std::size_t kMostBytes = std::size_t{1} << 24;

bool is_space(char c) {
    return c == ' ' || c == '\t' || c == '\r';
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && is_space(text.front()))
        text.remove_prefix(1);
    while (!text.empty() && is_space(text.back()))
        text.remove_suffix(1);
    return text;
}

std::string lower_case(std::string_view text) {
    std::string out(text);
    std::ranges::transform(out, out.begin(),
                           [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
    return out;
}

/// The number as `Label::id`.
std::optional<std::uint64_t> label_number(std::string_view text) {
    const char* end = text.data() + text.size();
    std::uint64_t id = 0;
    std::int64_t negative = 0;
    const auto whole = std::from_chars(text.data(), end, id);
    if (whole.ec == std::errc() && whole.ptr == end) return id;
    const auto below = std::from_chars(text.data(), end, negative);
    if (below.ec == std::errc() && below.ptr == end) return static_cast<std::uint64_t>(negative);
    return std::nullopt;
}

std::optional<double> color_number(std::string_view text) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !(value >= 0 && value <= 255)) return std::nullopt;
    return value;
}

/// Colour of sRGB components from 0 to 255.
glm::dvec3 linear_color(const std::array<double, 3>& srgb) {
    glm::dvec3 color;
    for (int c = 0; c < 3; ++c)
        color[c] = to_linear(srgb[static_cast<std::size_t>(c)] / 255);
    return color;
}

/// Three numbers from 0 to 255, or from 0 to 1 with a decimal point in one.
std::optional<glm::dvec3> color_of(std::span<const std::string> words) {
    std::array<double, 3> color{};
    bool fraction = false;
    for (std::size_t i = 0; i < 3; ++i) {
        const auto value = color_number(words[i]);
        if (!value) return std::nullopt;
        color[i] = *value;
        fraction = fraction || words[i].find('.') != std::string::npos;
    }
    if (fraction && *std::ranges::max_element(color) <= 1)
        for (double& value : color)
            value *= 255;
    return linear_color(color);
}

/// "1f9d5a" or "#1F9D5A".
std::optional<glm::dvec3> hex_color(std::string_view text) {
    if (text.starts_with('#')) text.remove_prefix(1);
    std::uint32_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, 16);
    if (text.size() != 6 || error != std::errc() || end != text.data() + 6) return std::nullopt;
    return linear_color(
        {static_cast<double>(value >> 16), static_cast<double>(value >> 8 & 255), static_cast<double>(value & 255)});
}

/// The words of a line; a word in quotation marks may contain spaces.
Words words_of(std::string_view line) {
    Words words;
    for (std::size_t i = 0; i < line.size();) {
        if (is_space(line[i])) {
            ++i;
            continue;
        }
        const bool quoted = line[i] == '"';
        const std::size_t begin = quoted ? i + 1 : i;
        std::size_t end = begin;
        while (end < line.size() && (quoted ? line[end] != '"' : !is_space(line[end])))
            ++end;
        words.emplace_back(line.substr(begin, end - begin));
        i = quoted ? end + 1 : end;
    }
    return words;
}

/// The fields of a line of a table; a field in quotation marks may contain the separator, and "" for one such mark.
Words fields_of(std::string_view line, char separator) {
    Words fields{""};
    bool quoted = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
        const char c = line[i];
        if (c == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"')
            fields.back() += line[++i];
        else if (c == '"')
            quoted = !quoted;
        else if (c == separator && !quoted)
            fields.emplace_back();
        else
            fields.back() += c;
    }
    for (std::string& field : fields)
        field = std::string(trimmed(field));
    return fields;
}

/// "NUMBER NAME... R G B [A]" or "NUMBER R G B A VIS MESH NAME"; nullopt for another line.
std::optional<Label> spaced_label(std::string_view line) {
    const Words words = words_of(line);
    const auto number = words.empty() ? std::nullopt : label_number(words[0]);
    if (!number) return std::nullopt;
    constexpr std::size_t kSnapWords = 8;
    if (words.size() == kSnapWords && line.find('"') != std::string_view::npos)
        if (const auto color = color_of(std::span(words).subspan(1, 3))) return Label{*number, 0, words.back(), color};
    // The name may have spaces, and may end in numbers: the colour is the last three or four words.
    std::size_t numbers = 0;
    while (numbers < 4 && numbers + 2 < words.size() && color_number(words[words.size() - 1 - numbers]))
        ++numbers;
    if (numbers < 3) return std::nullopt;
    const std::size_t first = words.size() - numbers;
    const auto color = color_of(std::span(words).subspan(first, 3));
    if (!color) return std::nullopt;
    Label label{*number, 0, words[1], color};
    for (std::size_t i = 2; i < first; ++i)
        label.name += " " + words[i];
    return label;
}

/// The columns of a table with a header.
struct Columns {
    char separator = ',';
    std::size_t number = 0, name = 0;
    std::optional<std::size_t> hex;
    std::optional<std::array<std::size_t, 3>> rgb;
    std::size_t least = 0;  ///< number of fields that a line needs
};

std::optional<std::size_t> column_named(const Words& header, std::initializer_list<std::string_view> names) {
    for (const std::string_view name : names)
        for (std::size_t i = 0; i < header.size(); ++i)
            if (lower_case(header[i]) == name) return i;
    return std::nullopt;
}

std::optional<Columns> columns_of(std::string_view line) {
    for (const char separator : {',', '\t', ';'}) {
        if (line.find(separator) == std::string_view::npos) continue;
        const Words header = fields_of(line, separator);
        const auto number = column_named(header, {"id", "label", "labelvalue", "label_value", "value", "index", "idx",
                                                  "number", "no", "label_id", "labelid", "key"});
        const auto name = column_named(header, {"name", "safe_name", "label_name", "labelname", "structure", "region",
                                                "description", "text", "acronym", "label"});
        if (!number || !name || *number == *name) continue;
        Columns columns{separator, *number, *name, {}, {}, std::max(*number, *name) + 1};
        columns.hex = column_named(header, {"color_hex_triplet", "color_hex", "hex", "color", "colour", "rgb"});
        const auto r = column_named(header, {"r", "red", "color_r"}),
                   g = column_named(header, {"g", "green", "color_g"}),
                   b = column_named(header, {"b", "blue", "color_b"});
        if (r && g && b) columns.rgb = {*r, *g, *b};
        return columns;
    }
    return std::nullopt;
}

std::optional<Label> label_in(const Columns& columns, std::string_view line) {
    const Words fields = fields_of(line, columns.separator);
    if (fields.size() < columns.least) return std::nullopt;
    const auto number = label_number(fields[columns.number]);
    if (!number) return std::nullopt;
    Label label{*number, 0, fields[columns.name], {}};
    if (columns.rgb) {
        const auto [r, g, b] = *columns.rgb;
        if (std::max({r, g, b}) < fields.size()) label.color = color_of(Words{fields[r], fields[g], fields[b]});
    } else if (columns.hex && *columns.hex < fields.size()) {
        // Spreadsheets drop leading zeros.
        const std::string& hex = fields[*columns.hex];
        if (!hex.empty()) label.color = hex_color(hex.size() < 6 ? std::string(6 - hex.size(), '0') + hex : hex);
    }
    return label;
}

}  // namespace names_file
}  // namespace

std::vector<Label> parse_label_names(std::string_view text, std::string_view source) {
    std::vector<Label> labels;
    std::unordered_set<std::uint64_t> known;
    std::optional<names_file::Columns> columns;
    if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
    int number = 0;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::string_view line = names_file::trimmed(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
        ++number;
        if (line.empty() || line.starts_with('#')) continue;
        if (labels.empty() && !columns && (columns = names_file::columns_of(line))) continue;
        auto label = columns ? names_file::label_in(*columns, line) : names_file::spaced_label(line);
        if (!label)
            fail("{}: line {}: '{}': expected {}", source, number, line.substr(0, 80),
                 columns ? "a number and a name in the columns of the header"
                         : "NUMBER NAME R G B A, or NUMBER R G B A VIS MESH \"NAME\", or a header with the columns id "
                           "and name");
        if (known.insert(label->id).second) labels.push_back(std::move(*label));
    }
    if (labels.empty()) fail("{}: has no labels: expected lines with a number, a name and a colour", source);
    return labels;
}

std::vector<Label> read_label_names(const std::filesystem::path& path) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error))
        fail("{}: no such file; expected a table of labels", path.string());
    if (std::filesystem::file_size(path, error) > names_file::kMostBytes)
        fail("{}: more than {} bytes; expected a table of labels", path.string(), names_file::kMostBytes);
    std::ifstream in(path, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    if (!in) fail("{}: cannot be read", path.string());
    return parse_label_names(text.str(), path.string());
}

LabelTable with_names(LabelTable table, const std::vector<Label>& named) {
    std::vector<const Label*> sorted;
    for (const Label& label : named)
        sorted.push_back(&label);
    std::ranges::sort(sorted, {}, &Label::id);
    for (Label& label : table.labels) {
        const auto at = std::ranges::lower_bound(sorted, label.id, {}, &Label::id);
        if (at == sorted.end() || (*at)->id != label.id) continue;
        if (!(*at)->name.empty()) label.name = (*at)->name;
        if ((*at)->color) label.color = (*at)->color;
    }
    return table;
}

}  // namespace edgesplat
