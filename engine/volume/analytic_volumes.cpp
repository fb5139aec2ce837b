#include "engine/volume/analytic_volumes.h"

#include <array>
#include <charconv>
#include <optional>
#include <utility>

#include "engine/error.h"
#include "engine/volume/analytic_internal.h"

namespace edgesplat {
namespace {

/// A scene's name and the function that makes it with its default grid.
struct Entry {
    std::string_view name;
    AnalyticScene (*make)();
};

AnalyticScene cube_hole() {
    return cube_hole_scene(glm::ivec3(20), 12, 3.5, {.binary = true});
}
AnalyticScene sphere() {
    return sphere_scene(glm::ivec3(64), glm::dvec3(31.7, 31.4, 31.2), 20, {});
}
AnalyticScene torus() {
    return torus_scene({64, 64, 32}, glm::dvec3(31.6, 31.3, 15.4), 18, 7, {});
}
AnalyticScene plane() {
    return plane_scene(glm::ivec3(64), {0.6, 0.3, 0.74}, glm::dvec3(31.6, 31.3, 31.4), {});
}
AnalyticScene rounded_box() {
    return analytic::box("rounded-box", 4);
}
AnalyticScene sharp_box() {
    return analytic::box("box", 0);
}
AnalyticScene small_ball() {
    return analytic::ball("small-ball", 4, false);
}
AnalyticScene binary_ball() {
    return analytic::ball("binary-ball", 12.4, true);
}

constexpr std::array<Entry, 20> kScenes = {{{"cube-hole", cube_hole},
                                            {"sphere", sphere},
                                            {"torus", torus},
                                            {"plates", analytic::plates},
                                            {"plane", plane},
                                            {"marschner-lobb", analytic::marschner_lobb},
                                            {"orbital", analytic::orbital},
                                            {"phantom", analytic::phantom},
                                            {"ellipsoid", analytic::ellipsoid},
                                            {"rounded-box", rounded_box},
                                            {"box", sharp_box},
                                            {"tilted-torus", analytic::tilted_torus},
                                            {"tube", analytic::tube},
                                            {"shell", analytic::shell},
                                            {"balls", analytic::balls},
                                            {"gyroid", analytic::gyroid},
                                            {"small-ball", small_ball},
                                            {"binary-ball", binary_ball},
                                            {"vessels", analytic::vessels},
                                            {"specks", analytic::specks}}};

constexpr std::array<std::string_view, kScenes.size()> names_of_scenes() {
    std::array<std::string_view, kScenes.size()> names;
    for (std::size_t i = 0; i < names.size(); ++i)
        names[i] = kScenes[i].name;
    return names;
}
constexpr auto kNames = names_of_scenes();

// Approximately normal noise (sum of 12 uniforms) from integers, identical on every machine.
double noise_of(std::uint64_t index, std::uint32_t seed) {
    std::uint64_t sum = 0;
    std::uint64_t state = (index + 1) * 0x9e3779b97f4a7c15ULL + seed * 0xd1b54a32d192ed03ULL;
    for (int i = 0; i < 3; ++i) {
        state += 0x9e3779b97f4a7c15ULL;
        std::uint64_t z = state;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
        z ^= z >> 31;
        sum += (z & 0xffff) + ((z >> 16) & 0xffff) + ((z >> 32) & 0xffff) + (z >> 48);
    }
    return static_cast<double>(sum) / 65536.0 - 6.0 * 65535.0 / 65536.0;
}

/// Parses one number of voxels, or three separated by x; nullopt for other texts.
std::optional<glm::ivec3> grid_of(std::string_view text) {
    std::array<int, 3> dims{};
    int count = 0;
    const char* at = text.data();
    const char* const end = at + text.size();
    while (at < end && count < 3) {
        const auto [next, error] = std::from_chars(at, end, dims[static_cast<std::size_t>(count)]);
        if (error != std::errc()) break;
        ++count;
        at = next;
        if (at < end && *at == 'x' && count < 3 && at + 1 < end)
            ++at;
        else
            break;
    }
    if (at != end || (count != 1 && count != 3)) return {};
    return count == 1 ? glm::ivec3(dims[0]) : glm::ivec3(dims[0], dims[1], dims[2]);
}

/// Parses the whole text as a number; nullopt for other texts.
template <typename Number>
std::optional<Number> number_of(std::string_view text) {
    Number value{};
    const char* const end = text.data() + text.size();
    const auto [next, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc() || next != end) return {};
    return value;
}

/// Applies one field of a path after the name: a grid, noise=SHARE or seed=NUMBER. `path` is for messages.
void apply_field(AnalyticScene& scene, std::string_view path, std::string_view text) {
    if (text.starts_with("noise=")) {
        const auto share = number_of<double>(text.substr(6));
        // Written so that NaN fails.
        if (!share || !(*share >= 0 && *share <= 10))
            fail("builtin:{}: noise: '{}': expected a share of the step from 0 to 10, for example noise=0.02", path,
                 text.substr(6));
        scene.noise = *share * scene.rise;
    } else if (text.starts_with("seed=")) {
        const auto seed = number_of<std::uint32_t>(text.substr(5));
        if (!seed) fail("builtin:{}: seed: '{}': expected a whole number from 0 to 4294967295", path, text.substr(5));
        scene.noise_seed = *seed;
    } else {
        const auto grid = grid_of(text);
        if (!grid)
            fail(
                "builtin:{}: '{}' is neither one number of voxels nor three like 64x48x32, nor noise=SHARE, nor "
                "seed=NUMBER",
                path, text);
        scene = resized(scene, *grid);
    }
}

}  // namespace

std::span<const std::string_view> analytic_scene_names() {
    return kNames;
}

AnalyticScene analytic_scene(std::string_view name) {
    for (const Entry& entry : kScenes)
        if (entry.name == name) return entry.make();
    fail("no built-in volume '{}'; expected one of: {}", name, fmt::join(kNames, ", "));
}

AnalyticScene resized(const AnalyticScene& scene, const glm::ivec3& dims) {
    if (dims.x < 2 || dims.y < 2 || dims.z < 2 || scene.dims.x < 2 || scene.dims.y < 2 || scene.dims.z < 2)
        fail("{}: cannot be resized to {} x {} x {}: each must be at least 2", scene.name, dims.x, dims.y, dims.z);
    const auto factor = (glm::dvec3(scene.dims) - 1.0) / (glm::dvec3(dims) - 1.0);
    AnalyticScene result = scene;
    result.dims = dims;
    result.spacing = scene.spacing * factor;
    result.value = [f = scene.value, factor](const glm::dvec3& x) { return f(x * factor); };
    result.gradient = [f = scene.gradient, factor](const glm::dvec3& x) { return f(x * factor) * factor; };
    result.signed_distance = nullptr;
    if (scene.signed_distance && factor.x == factor.y && factor.y == factor.z)
        result.signed_distance = [f = scene.signed_distance, factor](const glm::dvec3& x) {
            return f(x * factor) / factor.x;
        };
    return result;
}

float sample_at(const AnalyticScene& scene, const glm::ivec3& voxel) {
    double value = scene.value(glm::dvec3(voxel));
    if (scene.noise > 0) {
        const auto dims = glm::u64vec3(scene.dims), at = glm::u64vec3(voxel);
        value += scene.noise * noise_of((at.z * dims.y + at.y) * dims.x + at.x, scene.noise_seed);
    }
    return static_cast<float>(value);
}

Volume sample(const AnalyticScene& scene) {
    Volume volume;
    volume.name = "builtin:" + scene.name;
    volume.stored_type = "float64";
    volume.geometry.dims = scene.dims;
    for (int axis = 0; axis < 3; ++axis) {
        if (scene.dims[axis] < 1 || scene.dims[axis] > 65535)
            fail("{}: dims {} x {} x {}: each must be 1 to 65535", scene.name, scene.dims.x, scene.dims.y,
                 scene.dims.z);
        volume.geometry.index_to_world_axes[axis][axis] = scene.spacing[axis];
    }
    if (volume.geometry.voxel_count() > std::size_t{1} << 31) fail("{}: more than 2^31 voxels", scene.name);
    volume.values.resize(volume.geometry.voxel_count());
    std::size_t index = 0;
    for (int z = 0; z < scene.dims.z; ++z)
        for (int y = 0; y < scene.dims.y; ++y)
            for (int x = 0; x < scene.dims.x; ++x)
                volume.values[index++] = sample_at(scene, {x, y, z});
    finish_volume(volume);
    return volume;
}

bool is_builtin(std::string_view path) {
    return path.starts_with("builtin:");
}

AnalyticScene builtin_scene(std::string_view path) {
    if (is_builtin(path)) path.remove_prefix(8);
    auto colon = path.find(':');
    AnalyticScene scene = analytic_scene(path.substr(0, colon));
    while (colon != std::string_view::npos) {
        const std::string_view rest = path.substr(colon + 1);
        apply_field(scene, path, rest.substr(0, rest.find(':')));
        colon = path.find(':', colon + 1);
    }
    return scene;
}

Volume builtin_volume(std::string_view path) {
    return sample(builtin_scene(path));
}

}  // namespace edgesplat
