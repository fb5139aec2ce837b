#include "apps/paper/picture_sections.h"

namespace edgesplat {
namespace {

const glm::dvec3 kSkin{1.0, 0.85, 0.75}, kBlue{0.45, 0.70, 1.0}, kGold{1.0, 0.72, 0.25};
constexpr double kOpaque = 8, kTranslucent = 0.15;  // per voxel of 1 mm

Scene surface(double iso, double extinction) {
    Scene scene;
    scene.iso_values = {iso};
    scene.materials = {{glm::dvec3(0), 0}, {kSkin, extinction}};
    return scene;
}

Scene protein() {
    Scene scene;
    scene.iso_values = {20, 128};
    scene.materials = {{glm::dvec3(0), 0}, {kBlue, kTranslucent}, {kGold, kOpaque}};
    return scene;
}

}  // namespace

std::vector<PictureFigure> picture_figures() {
    std::vector<PictureFigure> figures;
    PictureFigure cube{.number = "9",
                       .title = "the cube with a hole",
                       .volume_path = "builtin:cube-hole",
                       .volume_name = "builtin:cube-hole, 3x3x3 box filter",
                       .text =
                           "A binary cube of 12^3 voxels with a cylindrical hole, filtered with a 3x3x3 box, surface "
                           "at one half. The data follow the\nnotes on the paper. Our assumptions: that Figure 9 "
                           "shows this cube, the hole's radius (3.5 voxels), and the view.",
                       .scene = surface(0.5, kOpaque)};
    cube.direction = {0.12, 0.18, -1};
    cube.eye = glm::dvec3(9.5, 9.5, 9.5) - 24.0 * glm::normalize(cube.direction);
    cube.up = {0, 1, 0};
    cube.fov_y = 42;
    cube.box_filter = true;
    figures.push_back(cube);

    PictureFigure nose{.number = "10",
                       .title = "inside a nose",
                       .volume_path = "cranium_ct/cranium.nhdr",
                       .volume_name = "cranium_ct",
                       .text =
                           "The paper shows the nasal passages of a head CT of its authors, which are not public. "
                           "This is another head in a similar view.\nThe eye is in the nasopharynx at voxel (128, "
                           "148, 14) and looks forward along (0, 1, 0.05) at the septum and the turbinates.\n"
                           "Surface at -400 HU, 256 x 256 x 108 voxels of 0.96 x 0.96 x 1.5 mm.",
                       .scene = surface(-400, kOpaque / 1.138)};
    nose.eye = {128, 148, 14};
    nose.direction = {0, 1, 0.05};
    nose.fov_y = 90;
    nose.outline = false;
    figures.push_back(nose);

    PictureFigure close{.number = "11",
                        .title = "iron protein, close-up",
                        .volume_path = "hipip/ironProt.vtk",
                        .volume_name = "hipip",
                        .text =
                            "High-potential iron protein, 68^3 voxels of 8 bits, a translucent surface at 20 around "
                            "an opaque one at 128, close to a lobe.\nThe data set is the paper's, as VTK ships it. "
                            "Our assumptions: the camera, the colours, and which of Figures 11 and 12 is\nthe "
                            "close-up.",
                        .scene = protein()};
    close.eye = {44, 2, 60};
    close.direction = glm::dvec3(33.5, 33.5, 48) - close.eye;
    close.fov_y = 52;
    figures.push_back(close);

    PictureFigure whole = close;
    whole.number = "12";
    whole.title = "iron protein, whole";
    whole.text = "The same two surfaces: the whole molecule seen from -y. The assumptions are those of Figure 11.";
    whole.eye = {33.5, -58, 33.5};
    whole.direction = {0, 1, 0};
    whole.fov_y = 60;
    figures.push_back(whole);
    return figures;
}

}  // namespace edgesplat
