#include "engine/scene/label_choice.h"

#include <algorithm>
#include <map>
#include <string_view>

#include "engine/error.h"
#include "engine/scene/nearest_name.h"
#include "engine/volume/labels.h"

namespace edgesplat {
namespace {

std::string lower(std::string_view text) {
    std::string out(text);
    std::ranges::transform(out, out.begin(),
                           [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
    return out;
}

std::string_view stripped(std::string_view text) {
    while (text.starts_with(' '))
        text.remove_prefix(1);
    while (text.ends_with(' '))
        text.remove_suffix(1);
    return text;
}

/// Whether `text` fits the pattern, in which * stands for any letters.
bool fits_pattern(std::string_view text, std::string_view pattern) {
    std::size_t t = 0, p = 0, star = std::string_view::npos, resumed = 0;
    while (t < text.size()) {
        if (p < pattern.size() && pattern[p] == '*') {
            star = p++;
            resumed = t;
        } else if (p < pattern.size() && pattern[p] == text[t]) {
            ++p;
            ++t;
        } else if (star != std::string_view::npos) {
            p = star + 1;
            t = ++resumed;
        } else {
            return false;
        }
    }
    while (p < pattern.size() && pattern[p] == '*')
        ++p;
    return p == pattern.size();
}

class Labels {
  public:
    Labels(const Volume& volume, const LabelTable& table) : volume_(volume), table_(table) {
        for (std::size_t place = 0; place < table.labels.size(); ++place) {
            places_[table.number_of(table.labels[place])].push_back(place);
            names_.push_back(lower(table.labels[place].name));
            if (!names_.back().empty()) by_name_[names_.back()].push_back(place);
        }
    }

    std::vector<std::size_t> named(const std::string& entry, std::string_view key) const {
        std::vector<std::size_t> found = matching(entry);
        if (!found.empty()) return found;
        for (std::size_t begin = 0; begin <= entry.size() && entry.find(',') != std::string::npos;) {
            const std::size_t end = std::min(entry.find(',', begin), entry.size());
            const std::string part = entry.substr(begin, end - begin);
            const std::vector<std::size_t> more = matching(part);
            if (more.empty()) refuse(part, key);
            found.insert(found.end(), more.begin(), more.end());
            begin = end + 1;
        }
        if (found.empty()) refuse(entry, key);
        return found;
    }

  private:
    std::vector<std::size_t> matching(std::string_view entry) const {
        const std::string wanted = lower(stripped(entry));
        if (wanted.empty()) return {};
        if (const auto at = places_.find(wanted); at != places_.end()) return at->second;
        if (const auto at = by_name_.find(wanted); at != by_name_.end()) return at->second;
        std::vector<std::size_t> found;
        if (wanted.find('*') == std::string::npos) return found;
        for (std::size_t place = 0; place < names_.size(); ++place)
            if (fits_pattern(names_[place], wanted)) found.push_back(place);
        return found;
    }

    [[noreturn]] void refuse(std::string_view entry, std::string_view key) const {
        const std::string wanted = lower(stripped(entry));
        std::vector<std::string> known;
        for (const auto& [name, places] : by_name_)
            known.push_back(name);
        std::string hint;
        const auto add = [&](const std::string& name) {
            if (hint.find("'" + name + "'") == std::string::npos)
                hint += fmt::format("{}'{}'", hint.empty() ? "; did you mean " : " or ", name);
        };
        std::size_t hints = 0;
        if (const std::string nearest = nearest_name(wanted, known); !nearest.empty()) {
            add(table_.labels[by_name_.at(nearest).front()].name);
            ++hints;
        }
        for (std::size_t i = 0; i < known.size() && hints < 3 && wanted.size() > 2; ++i)
            if (known[i].find(wanted) != std::string::npos) {
                add(table_.labels[by_name_.at(known[i]).front()].name);
                ++hints;
            }
        if (hint.empty())
            hint = by_name_.empty() ? fmt::format(
                                          "; its {} labels have numbers, from {} to {}, and no names "
                                          "(--label-names FILE gives them)",
                                          table_.labels.size(), table_.number_of(table_.labels.front()),
                                          table_.number_of(table_.labels.back()))
                                    : "; `edgesplat info` lists them";
        else
            hint += "?";
        fail("volume.{0} (--{0}): {1} has no label '{2}'{3}", key, volume_.name, stripped(entry), hint);
    }

    const Volume& volume_;
    const LabelTable& table_;
    std::vector<std::string> names_;
    std::map<std::string, std::vector<std::size_t>> places_, by_name_;
};

}  // namespace

std::vector<bool> chosen_labels(const Volume& volume, const LabelTable& table, const std::vector<std::string>& only,
                                const std::vector<std::string>& hide) {
    std::vector<bool> shown(table.labels.size(), only.empty());
    const std::size_t background = background_label(volume, table);
    if (only.empty() && background < shown.size()) shown[background] = false;
    if (only.empty() && hide.empty()) return shown;
    const Labels labels(volume, table);
    for (const std::string& entry : only)
        for (const std::size_t place : labels.named(entry, "only"))
            shown[place] = true;
    for (const std::string& entry : hide)
        for (const std::size_t place : labels.named(entry, "hide"))
            shown[place] = false;
    if (std::ranges::find(shown, true) == shown.end())
        fail("volume.hide (--hide): no label of {} is left", volume.name);
    return shown;
}

std::string text_of(const LabelTable& table, const Label& label) {
    return label.name.empty() ? table.number_of(label) : table.number_of(label) + " " + label.name;
}

}  // namespace edgesplat
