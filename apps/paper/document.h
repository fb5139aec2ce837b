// docs/paper.md: a text of sections, some of which can stay as they are.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace edgesplat {

/// A part of the page. In the file it stands between comments with its key, so that a later run finds it again.
struct Section {
    std::string key;
    std::string text;
};

/// The text of a section in an earlier page; empty where there is none.
std::string kept_section(std::string_view page, std::string_view key);

/// Paragraphs filled up to 120 columns; headings, tables, pictures and code stay as they are.
std::string filled(std::string_view text);

/// The page: all sections in order, one empty line between them.
std::string page_of(const std::vector<Section>& sections);

/// Targets of all pictures in the page.
std::vector<std::string> pictures_in(std::string_view page);

}  // namespace edgesplat
