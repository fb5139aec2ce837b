// What pages of reports are made of.
#pragma once

#include <string>
#include <vector>

#include "engine/image/image.h"

namespace edgesplat::accuracy {

/// Up to and with the headline; the style sheet is in it. `title` is plain text.
std::string page_begin(const std::string& title);
std::string page_end();

/// A table with a column of names and columns of numbers. Cells are plain text.
class HtmlTable {
  public:
    explicit HtmlTable(const std::vector<std::string>& head);
    void group(const std::string& title);  ///< a headline across the table
    void row(const std::vector<std::string>& cells, const std::string& css_class);
    std::string html() const { return html_ + "</tbody></table></div>\n"; }

  private:
    std::string html_;
    std::size_t columns_;
};

/// A picture (linear light, its alpha is ignored) as data, with a caption.
std::string figure(const Image& image, const std::string& caption);

std::string base64(const std::string& bytes);

}  // namespace edgesplat::accuracy
