#include "tests/image/image_cases.h"

#include <algorithm>

#include "engine/scene/views.h"
#include "engine/volume/labels.h"

namespace edgesplat::test {
namespace {

using reference::Output;

constexpr int kSide = 96;

/// A builtin scene on a grid, opaque above its (last) iso-value.
Shot builtin(const char* name, const glm::ivec3& dims, double extinction = 3) {
    const AnalyticScene scene = resized(analytic_scene(name), dims);
    Shot shot;
    shot.volume = std::make_shared<const Volume>(sample(scene));
    shot.scene.iso_values = scene.iso_values;
    shot.scene.materials.resize(scene.iso_values.size() + 1);
    if (scene.iso_values.size() > 1) shot.scene.materials[1] = {{0.3, 0.5, 1}, 0.12};
    shot.scene.materials.back() = {{1, 0.8, 0.55}, extinction};
    shot.width = shot.height = kSide;
    return shot;
}

/// A ball of two labels.
Shot two_labels() {
    Volume ball;
    ball.geometry.dims = glm::ivec3(16);
    for (int z = 0; z < 16; ++z)
        for (int y = 0; y < 16; ++y)
            for (int x = 0; x < 16; ++x)
                ball.values.push_back(glm::length(glm::dvec3(x, y, z) - 7.5) > 6 ? 0.0F : x + z < 15 ? 1.0F : 2.0F);
    finish_volume(ball);
    Shot shot;
    shot.volume = std::make_shared<const Volume>(drawn_labels(ball));
    shot.scene.iso_values = {0.5};
    shot.scene.materials = {{}, {.extinction = 8}};
    shot.scene.label_colors = {glm::dvec3(0), {1, 0.3, 0.1}, {0.1, 0.4, 1}};
    shot.width = shot.height = kSide;
    return shot;
}

void from(Shot& shot, const char* view, double fov = 45) {
    shot.camera = named_view(view, {shot.volume.get(), &shot.scene, fov, shot.width, shot.height});
}

Shot oblique_orbital() {
    Shot shot = builtin("orbital", {26, 22, 28});
    const double top = static_cast<double>(shot.volume->max_value);
    shot.scene.iso_values = {0.08 * top, 0.4 * top};
    shot.scene.materials = {{}, {{0.3, 0.5, 1}, 0.15}, {{1, 0.8, 0.3}, 3}};
    shot.scene.lights = {directional_light({0.3, -1, 0.5})};
    shot.volume = placed(shot.volume,
                         glm::dmat3(glm::dvec3(0.9, 0.2, 0.1), glm::dvec3(0.2, -1.1, 0.15), glm::dvec3(0.1, 0.3, 1.7)),
                         {-40, 12, 7});
    shot.camera = look(*shot.volume, {44, -22, 12}, {12, 11, 14}, 38);
    return shot;
}

/// A wall of 1.6 voxels seen from nearby.
Shot near_wall() {
    Shot shot;
    shot.volume =
        std::make_shared<const Volume>(sample(slab_scene({24, 24, 24}, {0.3, 1, 0.2}, {11.5, 13, 11.5}, 1.6)));
    shot.scene.iso_values = {0.5};
    shot.scene.materials = {{}, {{1, 1, 1}, 2}};
    shot.camera = look(*shot.volume, {11, 8, 11}, {13, 13, 12}, 70);
    shot.width = shot.height = kSide;
    return shot;
}

Shot inside_torus() {
    Shot shot = torus_shot();
    shot.scene.materials[1] = {{0.4, 1, 0.5}, 0.4};
    shot.camera = look(*shot.volume, {14.3, 13.6, 9.4}, {20, 8, 8}, 100);
    return shot;
}

Shot with(Shot shot, FootprintMode footprints, EdgeEstimator edges = EdgeEstimator::Cubic,
          WarpFamily warp = WarpFamily::Face) {
    shot.settings.footprints = footprints;
    shot.settings.edges = edges;
    shot.settings.warp = warp;
    return shot;
}

/// With the paper's settings.
Shot flat(Shot shot) {
    shot.settings = paper_settings(shot.settings);
    return shot;
}

Shot sliced(Shot shot, double spacing) {
    shot.settings.sheets = SheetCut::Sliced;
    shot.settings.sheet_spacing = spacing;
    return shot;
}

Shot small(Shot shot, int side = 48) {
    shot.width = shot.height = side;
    // The device tests saturation after its own groups of sheets, which costs up to 1 - saturation.
    shot.settings.saturation = 1;
    return shot;
}

/// A ball with a cavity in it, cut by a plane through both, seen at 40 degrees to the cut.
Shot cut_cavity() {
    Shot shot;
    const glm::dvec3 middle(15.4, 15.6, 15.5), cavity(18.2, 13.1, 16.9);
    const auto value = [&](const glm::dvec3& x) {
        return std::min(blurred_step(glm::length(x - middle) - 12.2), 1 - blurred_step(glm::length(x - cavity) - 4.6));
    };
    shot.volume = sampled(glm::ivec3(32), value);
    shot.scene.iso_values = {0.5};
    shot.scene.materials = {{}, {{1, 0.7, 0.5}, 4}};
    shot.scene.effects.clip.keep = {{{15.5, 15.5, 16.2}, {0.3, -1, 0.5}}};
    shot.camera = look(*shot.volume, {30, -14, 42}, {15.5, 15.5, 15.5}, 42);
    shot.width = shot.height = kSide;
    return shot;
}

/// The orbital with a box cut out.
Shot cut_out_box() {
    Shot shot = oblique_orbital();
    const glm::dvec3 middle = shot.volume->geometry.to_world({12, 11, 14}), low = middle - glm::dvec3(1, 40, 1),
                     high = middle + glm::dvec3(40, 2, 40);
    shot.scene.effects.clip.remove = {{low, {-1, 0, 0}}, {low, {0, -1, 0}}, {low, {0, 0, -1}},
                                      {high, {1, 0, 0}}, {high, {0, 1, 0}}, {high, {0, 0, 1}}};
    return shot;
}

/// Kernels cut by clip planes, with every method of integration.
std::vector<ImageCase> clip_cases() {
    using E = EdgeEstimator;
    using F = FootprintMode;
    std::vector<ImageCase> cases;
    const Shot cavity = small(cut_cavity()), orbital = small(cut_out_box());
    cases.push_back({"cut cavity", cavity});
    cases.push_back({"cut cavity, plain", with(cavity, F::Isotropic, E::Off)});
    cases.push_back({"cut cavity, warp2d", flat(cavity)});
    cases.push_back({"cut cavity, sliced", sliced(cavity, 0.5)});
    cases.push_back({"cut cavity, depth", cavity, Output::Depth});
    cases.push_back({"cut cavity, normals", cavity, Output::Normal});
    cases.push_back({"cut-out box", orbital});
    cases.push_back({"cut-out box, sliced", sliced(orbital, 0.5)});
    cases.push_back({"cut-out box, optical depth", orbital, Output::Tau});
    cases.push_back({"cut-out box, normals", orbital, Output::Normal});
    Shot glossy = cavity;
    glossy.scene.materials[1].response = {.ambient = 1, .diffuse = 0.8, .specular = 0.6, .shininess = 40};
    cases.push_back({"cut cavity, glossy", glossy});
    Shot both = cavity;
    both.scene.effects.clip.remove = {{{12, 0, 0}, {-1, 0, 0}}, {{12.4, 0, 0}, {1, 0, 0}}};
    cases.push_back({"cut cavity, a slit under one voxel", both});
    Shot inside = small(inside_torus(), 32);
    inside.scene.effects.clip.keep = {{inside.camera.eye, {0.2, 0.1, 1}}};
    cases.push_back({"inside the torus, eye on the plane", inside});
    Shot wall = small(near_wall(), 32);
    wall.scene.effects.clip.keep = {{{12, 13, 12}, {-1, -0.3, 0.4}}};
    cases.push_back({"near wall, cut", wall});
    for (ImageCase& c : cases)
        // If a ray only touches a face, rounding decides.
        c.smallest_psnr = !draws_faces(c.shot.settings) ? 95 : c.output == Output::Normal ? 50 : 65;
    return cases;
}

/// Kernels cut by the planes of sliced sheets.
std::vector<ImageCase> later_cases() {
    using E = EdgeEstimator;
    using F = FootprintMode;
    std::vector<ImageCase> cases;
    const Shot torus = small(torus_shot());
    cases.push_back({"torus, sliced", sliced(with(torus, F::Procedural), 0.25)});
    cases.push_back({"torus, sliced into thick sheets", sliced(with(torus, F::Procedural), 2)});
    cases.push_back({"torus, sliced, plain", sliced(with(torus, F::Isotropic, E::Off), 0.5)});
    cases.push_back({"torus, sliced, warp2d", sliced(flat(torus), 0.5)});
    const Shot oblique = small(oblique_orbital());
    cases.push_back({"oblique orbital, sliced", sliced(with(oblique, F::Procedural), 0.5)});
    cases.push_back({"oblique orbital, sliced, depth", sliced(with(oblique, F::Procedural), 0.5), Output::Depth});
    const Shot wall = small(near_wall());
    cases.push_back({"near wall, sliced", sliced(with(wall, F::Procedural), 0.25)});
    const Shot inside = small(inside_torus());
    cases.push_back({"inside the torus, sliced", sliced(with(inside, F::Procedural), 0.5)});
    Shot plane = small(builtin("plane", glm::ivec3(20)));
    from(plane, "oblique");
    plane = with(plane, F::Procedural, E::March, WarpFamily::Paper);
    cases.push_back({"plane, paper's curve, sliced", sliced(plane, 2)});
    plane.settings.footprints = F::Warp2d;
    cases.push_back({"plane, paper warp2d, sliced", sliced(plane, 0.5)});
    // Float32 sums of tens of splats per sheet limit the agreement.
    for (ImageCase& c : cases)
        c.smallest_psnr = draws_faces(c.shot.settings) ? 80 : 95;  // as above
    return cases;
}

/// Seen from far away: a pixel covers several voxels.
Shot far_orbital() {
    Shot shot = oblique_orbital();
    shot.camera.eye += 6.0 * (shot.camera.eye - shot.volume->geometry.to_world({12, 11, 14}));
    shot.scene.effects.antialias = true;
    shot.width = shot.height = 32;
    return shot;
}

/// Footprints widened to pixels and several samples per pixel, with every method of integration.
std::vector<ImageCase> sampling_cases() {
    using E = EdgeEstimator;
    using F = FootprintMode;
    std::vector<ImageCase> cases;
    Shot orbital = far_orbital(), between = orbital;
    orbital.settings.saturation = 1;
    between.width = between.height = 96;  // pixels of half a voxel to one: sharp and widened footprints mixed
    between.settings.saturation = 1;
    cases.push_back({"orbital, far, antialiased", orbital});
    cases.push_back({"orbital, far, antialiased, plain", with(orbital, F::Isotropic, E::Off)});
    cases.push_back({"orbital, far, antialiased, sliced", sliced(orbital, 0.5)});
    cases.push_back({"orbital, far, antialiased, optical depth", orbital, Output::Tau});
    cases.push_back({"orbital, far, antialiased, normals", orbital, Output::Normal});
    cases.push_back({"orbital, antialiased in part", between});
    Shot cut = orbital;
    cut.scene.effects.clip = cut_out_box().scene.effects.clip;
    cases.push_back({"orbital, far, antialiased, cut", cut});
    cases.push_back({"orbital, far, antialiased, cut, sliced", sliced(cut, 0.5)});
    Shot sampled = small(torus_shot(), 24);
    sampled.scene.effects.samples = 3;
    cases.push_back({"torus, 3 x 3 samples", sampled});
    orbital.scene.effects.samples = 2;
    cases.push_back({"orbital, far, antialiased, 2 x 2 samples", orbital});
    for (ImageCase& c : cases)
        c.smallest_psnr = 90;
    Shot outlined = torus_shot(), hole = builtin("cube-hole", glm::ivec3(28));
    from(hole, "oblique");
    for (Shot* shot : {&outlined, &hole})
        shot->scene.effects.smooth_outlines = true;
    cases.push_back({"torus, smooth outlines", outlined, Output::Color, 70});
    cases.push_back({"cube with a hole, smooth outlines", hole, Output::Color, 70});
    return cases;
}

/// Footprints from the table, and cases that it does not cover: walls, kernels at clip planes and at the border.
std::vector<ImageCase> table_cases() {
    using F = FootprintMode;
    std::vector<ImageCase> cases;
    Shot hole = builtin("cube-hole", glm::ivec3(28));
    from(hole, "oblique");
    cases.push_back({"cube with a hole, from the table", with(small(hole), F::Table)});
    const Shot torus = with(small(torus_shot()), F::Table);
    cases.push_back({"torus, from the table", torus});
    cases.push_back({"torus, from the table, normals", torus, Output::Normal});
    cases.push_back(
        {"oblique orbital, from the table, optical depth", with(small(oblique_orbital()), F::Table), Output::Tau});
    Shot wall = with(small(near_wall()), F::Table);
    cases.push_back({"near wall, from the table", wall});
    wall.settings.sheet_format = SheetFormat::Layers;
    cases.push_back({"near wall, from the table, in layers", wall});
    cases.push_back({"cut cavity, from the table", with(small(cut_cavity()), F::Table)});
    cases.push_back({"orbital, far, antialiased, from the table", with(far_orbital(), F::Table)});
    for (ImageCase& c : cases)
        c.smallest_psnr = c.output == Output::Normal ? 50 : 65;
    return cases;
}

std::vector<ImageCase> shading_cases() {
    std::vector<ImageCase> cases;
    Shot glossy = torus_shot();
    Light light;
    light.kind = Light::Kind::Point;
    light.position = {30, -10, 30};
    glossy.scene.lights = {light};
    glossy.scene.materials[2].response = {.ambient = 1, .diffuse = 0.8, .specular = 0.6, .shininess = 40};
    cases.push_back({"point_light_and_gloss", glossy});
    Shot foggy = torus_shot();
    foggy.camera = look(*foggy.volume, {14, -16, 15}, {14, 13, 9}, 60);
    foggy.scene.effects.fog = Fog{{0.35, 0.45, 0.55}, 0.06, 14};
    cases.push_back({"fog", foggy});
    Shot outlined = torus_shot();
    outlined.scene.effects.silhouette = Silhouette{{0.02, 0.02, 0.1}, 0.9, 2};
    cases.push_back({"silhouette", outlined});
    Shot orbital = oblique_orbital();
    const double top = static_cast<double>(orbital.volume->max_value);
    orbital.scene.iso_values = {0.4 * top};
    orbital.scene.materials = {{}, {}};
    orbital.scene.transfer = {{0.03 * top, {0.1, 0.2, 1}, 0},
                              {0.15 * top, {0.1, 0.8, 0.6}, 0.1},
                              {0.39 * top, {0.9, 0.9, 0.2}, 0.15},
                              {0.4 * top, {1, 0.5, 0.1}, 2},
                              {top, {1, 0.1, 0.1}, 4}};
    cases.push_back({"transfer_function", orbital});
    // Away from the iso-value, matter is no longer lit by the gradient.
    orbital.scene.lit = Lit::Edges;
    cases.push_back({"light_on_edges_only", orbital});
    Shot labels = two_labels();
    from(labels, "oblique", 40);
    cases.push_back({"labels", labels});
    Shot several = torus_shot();
    several.scene.ambient = 0.05;
    several.scene.lights = {directional_light({1, -1, 0.3}), directional_light({-1, -0.5, 0.2}),
                            directional_light({0, 0.4, 1})};
    several.scene.lights[0].color = {1, 0.25, 0.1};
    several.scene.lights[1].color = {0.1, 0.4, 1};
    several.scene.lights[2].color = {0.2, 0.9, 0.3};
    cases.push_back({"three_lights", several});
    return cases;
}

}  // namespace

std::vector<ImageCase> reference_cases() {
    using E = EdgeEstimator;
    using F = FootprintMode;
    std::vector<ImageCase> cases;
    cases.push_back({"torus far", torus_shot()});
    Shot sphere = builtin("sphere", glm::ivec3(32));
    from(sphere, "close", 30);
    cases.push_back({"sphere close", sphere});
    Shot hole = builtin("cube-hole", glm::ivec3(28));
    from(hole, "oblique");
    hole.settings.sheet_spacing = 0.5;
    cases.push_back({"cube with a hole, warp2d, thin sheets", flat(hole)});
    cases.push_back({"near wall", near_wall()});
    cases.push_back({"oblique orbital, directional light", oblique_orbital()});
    Shot lobb = builtin("marschner-lobb", glm::ivec3(30));
    from(lobb, "top");
    cases.push_back({"marschner-lobb, plain", with(lobb, F::Isotropic, E::Off)});
    Shot plane = builtin("plane", glm::ivec3(24));
    from(plane, "oblique");
    cases.push_back({"plane, paper's curve", with(plane, F::Procedural, E::March, WarpFamily::Paper)});
    cases.push_back({"torus, the paper's own", flat(torus_shot())});
    cases.push_back({"torus, march", with(torus_shot(), F::Procedural, E::March)});
    Shot inside = inside_torus();
    inside.settings.sheet_format = SheetFormat::Layers;
    inside.settings.saturation = 1;
    cases.push_back({"inside the torus", inside});
    Shot phantom = builtin("phantom", {36, 42, 36}, 0.5);
    phantom.settings.sheet_spacing = 2;
    from(phantom, "left");
    cases.push_back({"phantom, taylor, thick sheets", with(phantom, F::Procedural, E::Taylor)});
    cases.push_back({"oblique orbital, optical depth", oblique_orbital(), Output::Tau});
    cases.push_back({"torus, depth", torus_shot(), Output::Depth});
    Shot core = torus_shot();
    core.scene.materials.back().extinction = 8;
    cases.push_back({"opaque torus behind translucent matter", core});
    cases.push_back({"opaque torus behind translucent matter, normals", core, Output::Normal});
    Shot several = core;
    auto beside = std::make_shared<Volume>(*core.volume);
    beside->geometry.index_to_world_axes *= glm::dmat3({0.5, 0.2, 0}, {-0.2, 0.6, 0.1}, {0.1, 0, -0.5});
    beside->geometry.origin += core.volume->geometry.center() - beside->geometry.center() + glm::dvec3(5, -8, 4);
    several.scene.added = {{.volume = beside,
                            .iso_values = {core.scene.iso_values.back()},
                            .materials = {{}, {{0.4, 0.6, 1}, 20}},
                            .transfer = {},
                            .label_colors = {}}};
    cases.push_back({"opaque torus and another one on its own grid", several});
    Shot clouds = several;
    for (Material& material : clouds.scene.materials)
        material.extinction /= 80;
    clouds.scene.added[0].materials[1].extinction = 0.2;
    cases.push_back({"translucent torus and another one on its own grid", clouds});
    several.scene.added[0].replaces = clouds.scene.added[0].replaces = true;
    cases.push_back({"opaque torus, another one inside", several});
    cases.push_back({"translucent torus, another one inside", clouds});
    cases.push_back({"oblique orbital, normals", oblique_orbital(), Output::Normal});
    cases.push_back({"near wall, edge distance", near_wall(), Output::Distance});
    for (ImageCase& c : later_cases())
        cases.push_back(std::move(c));
    for (ImageCase& c : clip_cases())
        cases.push_back(std::move(c));
    for (ImageCase& c : sampling_cases())
        cases.push_back(std::move(c));
    for (ImageCase& c : table_cases())
        cases.push_back(std::move(c));
    return cases;
}

std::vector<ImageCase> golden_cases() {
    std::vector<ImageCase> cases;
    cases.push_back({"torus", torus_shot()});
    Shot hole = builtin("cube-hole", glm::ivec3(28));
    from(hole, "oblique", 35);
    cases.push_back({"cube_hole", hole});
    Shot table_value = torus_shot();
    table_value.settings.sheet_format = SheetFormat::Layers;
    cases.push_back({"torus_from_the_table_in_layers", with(table_value, FootprintMode::Table)});
    cases.push_back({"orbital", oblique_orbital()});
    Shot plates = builtin("plates", glm::ivec3(48));
    from(plates, "oblique", 35);
    cases.push_back({"plates", plates});
    Shot phantom = builtin("phantom", {48, 56, 48}, 0.6);
    from(phantom, "front", 40);
    cases.push_back({"phantom", phantom});
    cases.push_back({"inside_torus", inside_torus()});
    cases.push_back({"cut_cavity", cut_cavity()});
    cases.push_back({"cut_out_box", cut_out_box()});
    Shot two = torus_shot();
    two.scene.background = {0.02, 0.02, 0.04};
    two.scene.effects.background_top = glm::dvec3(0.5, 0.65, 0.9);
    cases.push_back({"background_of_two_colours", two});
    Shot shadow = ball_over_plate_shot();
    shadow.scene.ambient = 0.15;
    cases.push_back({"shadow_of_a_ball", shadow});
    hole.scene.ambient = 0.9;
    hole.scene.lights[0].intensity = 0.1;
    hole.scene.effects.occlusion = AmbientOcclusion{.strength = 1, .radius = 8};
    cases.push_back({"ambient_occlusion", hole});
    for (ImageCase& c : shading_cases())
        cases.push_back(std::move(c));
    Shot signs = oblique_orbital();
    signs.scene.effects.overlays = {.orientation = true, .scale_bar = true, .legend = true};
    cases.push_back({"overlays", signs});
    for (ImageCase& c : cases)
        c.shot.width = c.shot.height = 128;
    Shot lobb = builtin("marschner-lobb", glm::ivec3(64));
    from(lobb, "oblique");
    lobb.width = lobb.height = 48;
    lobb.scene.effects.samples = 3;
    cases.push_back({"samples", lobb});
    lobb.scene.effects.samples = 1;
    lobb.scene.effects.antialias = true;
    cases.push_back({"antialias", lobb});
    return cases;
}

std::string refusal_of_layers(const ImageCase& c) {
    if (c.shot.settings.sheet_format == SheetFormat::Tiles) return {};
    static const std::string refusal = [] {
        Shot layered = torus_shot();
        layered.settings.sheet_format = SheetFormat::Layers;
        layered.width = layered.height = 8;
        try {
            render(layered);
        } catch (const Error& error) {
            if (std::string_view(error.what()).find("no shaderOutputLayer") == std::string_view::npos) throw;
            return std::string(error.what());
        }
        return std::string();
    }();
    return refusal;
}

Image render_on_device(const ImageCase& c) {
    const RenderResult r = render(c.shot, {.tau = c.output == Output::Tau,
                                           .depth = c.output == Output::Depth,
                                           .normal = c.output == Output::Normal,
                                           .distance = c.output == Output::Distance});
    switch (c.output) {
        case Output::Tau:
            return *r.tau;
        case Output::Depth:
            return *r.depth;
        case Output::Normal:
            return *r.normal;
        case Output::Distance:
            return *r.distance;
        case Output::Color:
            break;
    }
    return r.color;
}

}  // namespace edgesplat::test
