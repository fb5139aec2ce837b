// The smallest program that renders with the library: volume, scene and camera in; picture and number of splats out.
#include <cstdio>
#include <exception>
#include <memory>

#include "engine/image/image_file.h"
#include "engine/renderer.h"
#include "engine/scene/views.h"
#include "engine/volume/load_volume.h"

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "usage: embed PICTURE.png\n");
        return 2;
    }
    try {
        const auto volume = std::make_shared<const edgesplat::Volume>(edgesplat::load_volume("builtin:sphere:32"));
        const edgesplat::Scene scene{.iso_values = {0.5},
                                     .materials = {{.extinction = 0}, {.color = {1, 0.85, 0.75}, .extinction = 8}},
                                     .background = {0.1, 0.1, 0.1}};
        const edgesplat::Camera camera = edgesplat::named_view(
            "front", {.volume = volume.get(), .scene = &scene, .fov_y = 45, .width = 128, .height = 128});

        edgesplat::Renderer renderer;
        renderer.set_volume(volume);
        const edgesplat::RenderResult result = renderer.render(scene, camera, {}, 128, 128);
        edgesplat::write_image(argv[1], result.color);
        std::printf("%llu splats on %s\n", static_cast<unsigned long long>(result.stats.splats_drawn),
                    renderer.device().name.c_str());
    } catch (const std::exception& error) {
        std::fprintf(stderr, "embed: %s\n", error.what());
        return 1;
    }
}
