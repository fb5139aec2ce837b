// Writes docs/paper.md and its pictures: the paper's figures, and its misprints with proofs.
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
Visualization 1998. This page repeats its Figures 4, 6, 7, 8, 9, 10, 11 and 12 and proves its misprints. The page and its pictures
are written by

```sh
./dev paper
```

| name | method |
|---|---|
| *plain* | conventional splatting with our kernel |
| *the paper's own* | the paper's method: distance to the edge from value and gradient (`--edges taylor`), its curve, corrected (`--warp paper`), as a warp of the two-dimensional footprint (`--footprints warp2d`) |
| *ours* | the default of `edgesplat render` |

| quantity | definition |
|---|---|
| *width* | from 10 to 90 % across an edge, median over the steepest places: of luminance inside the nose, elsewhere of the opacity of the opaque surface alone, which is its outline |
| *gradient energy* | sum of squared differences of luminance. It counts everything steep, also the staircase that plain splatting makes of a smooth surface: a smaller value need not mean blur |
| times | only comparable between columns: the machine had other work |

The print was not at hand, and the public texts that could be searched do not contain it. Sources of the statements about it:

| statement | source |
|---|---|
| Figures 4, 6, 7 and 8 show the profile, its inverse, the warped splats and the two-tone reconstruction | notes on the paper |
| Figures 9 to 12 show the cube, the nasal passages and the iron protein | notes on the paper |
| t2 = 0.8 and m2 = 0.4 | on record |
| t1 = 0.2 and m1 = 0.3 | chosen to match (an edge at 0.35) |
| the kernel | ours (K7), not the paper's |

The figures therefore show the same objects and methods; they are not copies.
)";

std::string text_of(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

/// Renders the figure; if its volume is missing, keeps the section of the earlier page.
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
        fail("figure {} needs {} in the folder that EDGESPLAT_DATA names; no earlier page contains the figure",
             figure.number, figure.volume_path);
    fmt::print("figure {}: pictures and text of the earlier page kept; the folder EDGESPLAT_DATA lacks {} ({})\n",
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
