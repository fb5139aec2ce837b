// Joins and splits docs/paper.md, a page of sections; a run can keep sections of an earlier page.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace edgesplat {

/// A part of the page. The file has comments with its key around it, so that a later run finds it.
struct Section {
    std::string key;
    std::string text;
};

/// The text of a section in an earlier page; empty if the page lacks it.
std::string kept_section(std::string_view page, std::string_view key);

/// Fills paragraphs up to 120 columns; headings, tables, pictures and code are unchanged.
std::string filled(std::string_view text);

/// The page: all sections in order, separated by one empty line.
std::string page_of(const std::vector<Section>& sections);

/// File names of all pictures in the page, as its links spell them.
std::vector<std::string> pictures_in(std::string_view page);

}  // namespace edgesplat
