// Building blocks of report pages.
#pragma once

#include <string>
#include <vector>

#include "engine/image/image.h"

namespace edgesplat::accuracy {

/// The beginning of a page, with style sheet and headline. `title` is plain text.
std::string page_begin(const std::string& title);
std::string page_end();

/// A table with a first column of names and further columns of numbers. Cells are plain text.
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

/// A picture (linear light; alpha is ignored) as embedded data, with a caption.
std::string figure(const Image& image, const std::string& caption);

std::string base64(const std::string& bytes);

}  // namespace edgesplat::accuracy
