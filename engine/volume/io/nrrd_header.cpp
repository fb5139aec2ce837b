#include "engine/volume/io/nrrd_header.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <fstream>
#include <memory>
#include <string_view>

#include "engine/volume/io/readers.h"

namespace edgesplat::detail {
namespace {

constexpr std::size_t kMaxNrrdHeader = std::size_t{16} << 20;
constexpr std::size_t kMaxNrrdLine = std::size_t{1} << 20;

// Names without blanks, as the definition of the format lists them; "centerings" is the same field as "centers".
constexpr std::array<std::string_view, 33> kNrrdFields = {"content",
                                                          "number",
                                                          "type",
                                                          "blocksize",
                                                          "dimension",
                                                          "space",
                                                          "spacedimension",
                                                          "sizes",
                                                          "spacings",
                                                          "thicknesses",
                                                          "axismins",
                                                          "axismaxs",
                                                          "spacedirections",
                                                          "centers",
                                                          "centerings",
                                                          "kinds",
                                                          "labels",
                                                          "units",
                                                          "min",
                                                          "max",
                                                          "oldmin",
                                                          "oldmax",
                                                          "endian",
                                                          "encoding",
                                                          "lineskip",
                                                          "byteskip",
                                                          "sampleunits",
                                                          "spaceunits",
                                                          "spaceorigin",
                                                          "measurementframe",
                                                          "datafile",
                                                          "center",
                                                          "unit"};

/// The field that a name denotes; empty if it is none.
std::string nrrd_field(std::string_view name) {
    std::string plain;
    for (const char c : name)
        if (c != ' ') plain += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (std::ranges::find(kNrrdFields, plain) == kNrrdFields.end()) return "";
    if (plain == "centerings" || plain == "center") return "centers";
    return plain == "unit" ? "units" : plain;
}

// "\n" and "\\" are the only escapes of key/value pairs.
std::string unescaped(std::string_view text) {
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool escaped = text[i] == '\\' && i + 1 < text.size() && (text[i + 1] == 'n' || text[i + 1] == '\\');
        if (escaped) ++i;
        out += escaped && text[i] == 'n' ? '\n' : text[i];
    }
    return out;
}

double nrrd_number(const NrrdHeader& header, const std::string& field, std::string_view text) {
    double value = 0;
    std::string_view digits = text;
    if (digits.starts_with('+')) digits.remove_prefix(1);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc() || end != digits.data() + digits.size())
        header.refuse(field, fmt::format("'{}' is not a number", text));
    if (std::isinf(value)) header.refuse(field, fmt::format("'{}' is infinite", text));
    return value;
}

}  // namespace

void NrrdHeader::refuse(const std::string& field, const std::string& reason) const {
    static const std::map<std::string, std::string> spelled = {{"spacedirections", "space directions"},
                                                               {"spaceorigin", "space origin"},
                                                               {"spaceunits", "space units"},
                                                               {"spacedimension", "space dimension"},
                                                               {"axismins", "axis mins"},
                                                               {"axismaxs", "axis maxs"},
                                                               {"byteskip", "byte skip"},
                                                               {"lineskip", "line skip"},
                                                               {"datafile", "data file"}};
    const auto found = spelled.find(field);
    fail("{}: NRRD field '{}': {}", path, found == spelled.end() ? field : found->second, reason);
}

std::vector<std::string> NrrdHeader::split(const std::string& text) {
    std::vector<std::string> found;
    for (std::size_t at = 0; at < text.size();) {
        if (text[at] == ' ' || text[at] == '\t') {
            ++at;
            continue;
        }
        std::string word;
        if (text[at] == '"') {
            for (++at; at < text.size() && text[at] != '"'; ++at) {
                if (text[at] == '\\' && at + 1 < text.size() && text[at + 1] == '"') ++at;
                word += text[at];
            }
            ++at;
        } else {
            for (; at < text.size() && text[at] != ' ' && text[at] != '\t'; ++at)
                word += text[at];
        }
        found.push_back(word);
    }
    return found;
}

std::vector<std::string> NrrdHeader::words(const std::string& field, std::size_t count) const {
    auto found = split(value(field));
    if (found.size() != count) refuse(field, fmt::format("{} values, expected {}", found.size(), count));
    return found;
}

std::vector<double> NrrdHeader::numbers(const std::string& field, std::size_t count) const {
    std::vector<double> out(count, std::nan(""));
    if (!has(field)) return out;
    const auto texts = words(field, count);
    for (std::size_t i = 0; i < count; ++i)
        out[i] = nrrd_number(*this, field, texts[i]);
    return out;
}

std::vector<std::optional<std::vector<double>>> NrrdHeader::vectors(const std::string& field) const {
    const std::string text = value(field);
    std::vector<std::optional<std::vector<double>>> found;
    for (std::size_t at = text.find_first_not_of(" \t"); at != std::string::npos;
         at = text.find_first_not_of(" \t", at)) {
        if (text[at] != '(') {
            const auto end = std::min(text.find_first_of(" \t", at), text.size());
            std::string word = text.substr(at, end - at);
            std::ranges::transform(word, word.begin(), [](unsigned char c) { return std::tolower(c); });
            if (word != "none") refuse(field, fmt::format("'{}' is neither a vector like (1,0,0) nor none", word));
            found.emplace_back(std::nullopt);
            at = end;
            continue;
        }
        const auto close = text.find(')', at);
        if (close == std::string::npos) refuse(field, "a vector has no ')'");
        std::vector<double> vector;
        for (std::size_t begin = at + 1; begin <= close;) {
            const auto end = std::min(text.find(',', begin), close);
            vector.push_back(nrrd_number(*this, field, trimmed(text.substr(begin, end - begin))));
            begin = end + 1;
        }
        found.emplace_back(std::move(vector));
        at = close + 1;
    }
    return found;
}

long long NrrdHeader::whole(const std::string& field, long long otherwise) const {
    return has(field) ? whole_in(field, value(field)) : otherwise;
}

long long NrrdHeader::whole_in(const std::string& field, const std::string& text) const {
    long long number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size())
        refuse(field, fmt::format("'{}' is not a whole number", text));
    return number;
}

NrrdHeader nrrd_header(const std::string& path, const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    NrrdHeader header;
    header.path = path;
    std::array<char, 64> first{};
    in.getline(first.data(), first.size());
    std::string line = first.data();
    const std::string magic = trimmed(line);
    static constexpr std::array<std::string_view, 7> kMagics = {"NRRD00.01", "NRRD0001", "NRRD0002", "NRRD0003",
                                                                "NRRD0004",  "NRRD0005", "NRRD0006"};
    if (std::ranges::find(kMagics, magic) == kMagics.end())
        fail("{}: '{}' is no version of NRRD, expected NRRD0001 to NRRD0006", path, magic.substr(0, 40));
    bool in_list = false;
    const auto buffer = std::make_unique_for_overwrite<char[]>(kMaxNrrdLine);
    for (std::size_t number = 2; in.getline(buffer.get(), kMaxNrrdLine); ++number) {
        line.assign(buffer.get(), static_cast<std::size_t>(in.gcount()) - (in.eof() ? 0 : 1));
        header.bytes = in.eof() ? 0 : static_cast<std::size_t>(in.tellg());
        if (header.bytes > kMaxNrrdHeader)
            fail("{}: its NRRD header is longer than {} MiB", path, kMaxNrrdHeader >> 20);
        if (line.ends_with('\r')) line.pop_back();
        if (line.empty()) break;
        if (line.front() == '#') continue;
        if (in_list) {
            header.listed_files.push_back(trimmed(line));
            continue;
        }
        // As NRRD's own library decides: a known field before ": ", else a key before ":=".
        const auto blank = line.find(": "), assign = line.find(":="), colon = line.find(':');
        std::string field = blank == std::string::npos ? "" : nrrd_field(trimmed(line.substr(0, blank)));
        auto value_at = blank + 2;
        if (field.empty() && assign != std::string::npos) {
            const std::string key = trimmed(line.substr(0, assign));
            header.key_values[unescaped(key)] = unescaped(line.substr(assign + 2));
            if (!nrrd_field(key).empty())
                header.warnings.push_back(
                    fmt::format("'{}:=' is a key/value pair without effect; the field is written '{}:'.", key, key));
            continue;
        }
        if (field.empty() && colon != std::string::npos) {
            field = nrrd_field(trimmed(line.substr(0, colon)));
            value_at = colon + 1;
        }
        if (field.empty() && colon == std::string::npos)
            fail("{}: line {} of its NRRD header is neither 'field: value' nor 'key:=value'", path, number);
        if (field.empty()) {
            header.warnings.push_back(fmt::format("'{}' is no field of NRRD and was ignored.", line.substr(0, 80)));
            continue;
        }
        const auto [entry, is_new] = header.fields.emplace(field, trimmed(line.substr(value_at)));
        if (!is_new && entry->second != trimmed(line.substr(value_at)))
            header.refuse(field, "it occurs twice, with different values");
        in_list = field == "datafile" && entry->second.starts_with("LIST");
    }
    if (in.fail() && !in.eof()) fail("{}: a line of its NRRD header is longer than {} MiB", path, kMaxNrrdLine >> 20);
    if (!line.empty()) header.bytes = 0;  // no blank line: no attached data
    if (header.bytes == 0 && !header.has("datafile"))
        fail("{}: truncated: its NRRD header does not end with an empty line, and it names no data file", path);
    return header;
}

}  // namespace edgesplat::detail
