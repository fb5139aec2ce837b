// Writes docs/paper.md and its pictures: the figures of the paper, and its misprints with their proofs.
#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <sstream>

#include "apps/paper/curve_sections.h"
#include "apps/paper/picture_sections.h"
#include "engine/error.h"
#include "engine/image/image_file.h"
#include "tests/properties/test_renderer.h"

namespace {

using namespace edgesplat;
namespace fs = std::filesystem;

constexpr const char* kIntroduction =
    R"(# The paper's figures

J. Huang, R. Crawfis, D. Stredney, *Edge Preservation in Volume Rendering Using Splatting*, IEEE/ACM Symposium on Volume
Visualization 1998: its Figures 4, 6, 7, 8, 9, 10, 11 and 12 made anew, and its misprints proved. This page and its pictures
are written by

```sh
./dev paper
```

*Plain* is conventional splatting with our kernel. *The paper's own* is the paper's method: distance to the edge from value
and gradient (`--edges taylor`), its curve, corrected (`--warp paper`), as a warp of the two-dimensional footprint
(`--footprints warp2d`). *Ours* is what `edgesplat render` does by default.

The pictures' *width* is from 10 to 90 % across an edge, median over the steepest places: of luminance inside the nose,
elsewhere of the opacity of the opaque surface alone, that is its outline. *Gradient energy* of luminance counts all that is
steep, so also the staircase that plain splatting makes of a smooth surface: less of it need not be blur. Times are to be
compared between columns: the machine had other work.

What is certain and what is not: the print was not at hand, nor is it among the public texts that could be searched. That
Figures 4, 6, 7 and 8 show the profile, its inverse, the warped splats and the two-tone reconstruction, and Figures 9 to 12
the cube, the nasal passages and the iron protein, is taken from notes on it. Of the curve's parameters only t2 = 0.8 and
m2 = 0.4 are on record; t1 = 0.2 and m1 = 0.3 are chosen to go with them (an edge at 0.35). The kernel is ours (K7), not
the paper's. So the figures are of the same things, not copies.
)";

std::string text_of(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

/// The figure anew, or as the page has it where the volume is not here.
Section figure_section(const PictureFigure& figure, Renderer& renderer, const std::string& before,
                       const fs::path& images) {
    const char* folder = std::getenv("EDGESPLAT_DATA");
    const fs::path data = folder == nullptr ? "" : folder;
    if (figure.is_builtin() || fs::exists(data / figure.volume_path)) {
        fmt::print("figure {}: {}\n", figure.number, figure.volume_name);
        std::fflush(stdout);
        return picture_section(figure, renderer, data, images);
    }
    Section kept{"figure " + figure.number, kept_section(before, "figure " + figure.number)};
    if (kept.text.empty())
        fail("figure {} needs {} in the folder EDGESPLAT_DATA names, and there is no earlier page to keep it from",
             figure.number, figure.volume_path);
    fmt::print("figure {}: kept as it is, pictures and text; {} is not in the folder EDGESPLAT_DATA names ({})\n",
               figure.number, figure.volume_path, folder == nullptr ? "not set" : folder);
    return kept;
}

void write_page(const fs::path& docs) {
    const fs::path page = docs / "paper.md", images = docs / "images" / "paper";
    const std::string before = text_of(page);
    const CurveExample example;
    std::vector<Section> sections = {{"introduction", kIntroduction}};
    fmt::print("figures 4, 6, 7, 8\n");
    for (Section& section : curve_sections(example, images))
        sections.push_back(std::move(section));
    {
        Renderer renderer;
        for (const PictureFigure& figure : picture_figures())
            sections.push_back(figure_section(figure, renderer, before, images));
    }
    fmt::print("seams, misprints\n");
    sections.push_back(seam_section());
    sections.push_back(misprint_section(example.profile));
    const FileContent file{page, page_of(sections)};
    write_files({&file, 1});
    fmt::print("{}\n", page.string());
}

}  // namespace

int main(int argc, char** argv) {
    if (argc > 2 || (argc == 2 && argv[1][0] == '-')) {
        fmt::print(stderr, "usage: edgesplat_paper [DOCS_FOLDER]\n");
        return 2;
    }
    int status = 0;
    try {
        write_page(argc == 2 ? argv[1] : "docs");
    } catch (const std::exception& error) {
        fmt::print(stderr, "edgesplat_paper: {}\n", error.what());
        status = 1;
    }
    test::close_test_renderer();
    return status;
}
