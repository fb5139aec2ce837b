#include "engine/accuracy/page_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "engine/accuracy/svg_plot.h"
#include "engine/image/image_file.h"

namespace edgesplat::accuracy {
namespace {

constexpr const char* kStyle = R"(
:root { color-scheme: light; --ink: #1c2430; --soft: #5b6675; --line: #dfe4ea; --accent: #b3421b; --blue: #2b6cb0; }
* { box-sizing: border-box; }
body { margin: 0 auto; padding: 2rem clamp(1rem, 4vw, 3rem) 4rem; max-width: 84rem; background: #fff; color: var(--ink);
  font: 16px/1.5 system-ui, "Segoe UI", Roboto, "Helvetica Neue", Arial, sans-serif; }
h1 { font-size: 1.7rem; line-height: 1.2; margin: 0 0 .3rem; overflow-wrap: anywhere; }
h2 { font-size: 1.2rem; margin: 2.6rem 0 .8rem; border-bottom: 2px solid var(--line); padding-bottom: .25rem; }
h3 { font-size: 1rem; margin: 1.4rem 0 .5rem; }
.facts, .note { color: var(--soft); font-size: .85rem; overflow-wrap: anywhere; }
.lead { font-size: 1.08rem; max-width: 60rem; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; font-size: .85rem; font-variant-numeric: tabular-nums; width: 100%; }
th, td { padding: .22rem .42rem; text-align: right; white-space: nowrap; border-bottom: 1px solid var(--line); }
th { color: var(--soft); font-weight: 600; position: sticky; top: 0; background: #fff; }
th:first-child, td:first-child { text-align: left; padding-left: .2rem; white-space: normal; min-width: 9rem; }
tr.group td { font-weight: 650; padding-top: .8rem; background: #f6f8fa; }
tbody tr:not(.group):hover { background: #f1f6fc; }
tr.best td { font-weight: 650; }
tr.base td { color: #98a2ae; }
.plot { width: 100%; height: auto; max-width: 60rem; display: block; }
.front-list { font-size: .85rem; columns: 26rem; padding-left: 1.6rem; }
.pictures { display: grid; grid-template-columns: repeat(auto-fill, minmax(150px, 1fr)); gap: .7rem; }
figure { margin: 0; } figure img { width: 100%; height: auto; display: block; border-radius: 3px; background: #000; }
figcaption { font-size: .8rem; color: var(--soft); padding-top: .15rem; }
.scale { max-width: 30rem; margin-top: 1rem; } .scale .bar { height: .8rem; border-radius: 2px; }
.scale .ticks { display: flex; justify-content: space-between; font-size: .8rem; color: var(--soft); }
code { font-size: .9em; }
@media print { body { max-width: none; padding: 0; } h2 { break-after: avoid; } figure, tr { break-inside: avoid; } }
)";

}  // namespace

std::string page_begin(const std::string& title) {
    return "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
           "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
           escaped(title) + "</title>\n<style>" + kStyle + "</style>\n</head>\n<body>\n<h1>" + escaped(title) +
           "</h1>\n";
}

std::string page_end() {
    return "</body>\n</html>\n";
}

HtmlTable::HtmlTable(const std::vector<std::string>& head)
    : html_("<div class=\"scroll\"><table><thead><tr>"), columns_(head.size()) {
    for (const std::string& cell : head)
        html_ += "<th>" + escaped(cell) + "</th>";
    html_ += "</tr></thead>\n<tbody>\n";
}

void HtmlTable::group(const std::string& title) {
    html_ += fmt::format("<tr class=\"group\"><td colspan=\"{}\">{}</td></tr>\n", columns_, escaped(title));
}

void HtmlTable::row(const std::vector<std::string>& cells, const std::string& css_class) {
    html_ += css_class.empty() ? "<tr>" : "<tr class=\"" + css_class + "\">";
    for (const std::string& cell : cells)
        html_ += "<td>" + escaped(cell) + "</td>";
    html_ += "</tr>\n";
}

std::string figure(const Image& image, const std::string& caption) {
    Image opaque(image.width, image.height, 3);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            for (int c = 0; c < 3; ++c)
                opaque.at(x, y, c) = image.at(x, y, std::min(c, image.channels - 1));
    return fmt::format(
        "<figure><img alt=\"{0}\" width=\"{1}\" height=\"{2}\" src=\"data:image/png;base64,{3}\">"
        "<figcaption>{0}</figcaption></figure>\n",
        escaped(caption), image.width, image.height, base64(encode_png(opaque, {})));
}

std::string base64(const std::string& bytes) {
    constexpr const char* kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve(bytes.size() * 4 / 3 + 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t group = 0;
        const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
        for (std::size_t k = 0; k < 3; ++k)
            group = group << 8 | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0U);
        for (std::size_t k = 0; k < 4; ++k)
            text += k <= count ? kLetters[group >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

}  // namespace edgesplat::accuracy
