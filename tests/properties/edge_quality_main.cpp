// Prints the tables of docs/accuracy.md. The tests check the figures with the same measuring code.
//   edge_quality [planes] [silhouettes] [unity] [walls]
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <set>
#include <string>

#include "tests/properties/edge_quality.h"

namespace {

using namespace edgesplat;
using namespace edgesplat::test;

void print_edges(const std::string& name, const EdgeProfiles& p) {
    fmt::print("| {:<28} | {:6.3f} | {:6.3f} | {:8.4f} | {:8.4f} | {:8.4f} | {:9.3f} | {:6} |\n", name, mean(p.rise),
               largest_magnitude(p.rise), mean_magnitude(p.location), largest_magnitude(p.location), mean(p.location),
               mean(p.overshoot), p.missed);
}

void edge_header(const char* what) {
    fmt::print("\n{}\n\n", what);
    fmt::print("| {:<28} | {:>6} | {:>6} | {:>8} | {:>8} | {:>8} | {:>9} | {:>6} |\n", "method", "rise", "max",
               "location", "max", "bias", "overshoot", "missed");
    fmt::print("|{:-<30}|{:->7}:|{:->7}:|{:->9}:|{:->9}:|{:->9}:|{:->10}:|{:->7}:|\n", "", "", "", "", "", "", "", "");
}

void planes() {
    for (const double cut_away : {1.0, 0.0}) {
        edge_header(cut_away > 0 ? "Planes seen edge-on, 24 orientations, without the voxel beside the grid's border"
                                 : "Planes seen edge-on, 24 orientations, the grid's border included");
        for (const Method& method : compared_methods())
            print_edges(method.name, plane_edges(method.settings, cut_away));
    }
}

void silhouettes() {
    for (const bool torus : {false, true}) {
        edge_header(torus ? "Silhouettes of an opaque torus, radii 16 and 8 (16 outside, 8 in the hole), alpha"
                          : "Silhouettes of an opaque sphere, radius 9.3, 16 directions, alpha");
        for (const Method& method : compared_methods())
            print_edges(method.name, torus ? torus_silhouettes(method.settings) : sphere_silhouettes(method.settings));
    }
}

void unity() {
    fmt::print("\nPartition of unity next to planes, 24 orientations: sum of weights - 1\n\n");
    fmt::print("| {:<28} | {:<20} | {:>7} | {:>11} | {:>7} |\n", "method", "measured", "rms", "mean of max", "max");
    fmt::print("|{:-<30}|{:-<22}|{:->8}:|{:->12}:|{:->8}:|\n", "", "", "", "", "");
    for (const Method& method : compared_methods()) {
        const auto line = [&](const char* what, const Unity& u) {
            fmt::print("| {:<28} | {:<20} | {:7.4f} | {:11.4f} | {:7.4f} |\n", method.name, what, u.rms, u.mean_of_max,
                       u.max);
        };
        const bool pointwise = method.name.starts_with("default") || method.name.starts_with("paper's c");
        if (pointwise) line("points, exact edges", plane_unity(method.settings, false));
        if (pointwise) line("points, estimated", plane_unity(method.settings, true));
        const bool in_pictures = pointwise || method.name.starts_with("paper");
        if (in_pictures) line("pictures", picture_unity(method.settings));
    }
    fmt::print("\nSpheres, estimated edges: sum of weights - 1, and two-tone data against the truth (rms)\n\n");
    fmt::print("| {:>6} | {:<28} | {:>7} | {:>11} | {:>7} | {:>12} | {:>10} |\n", "radius", "method", "rms",
               "mean of max", "max", "two-tone raw", "normalised");
    fmt::print("|{:->7}:|{:-<30}|{:->8}:|{:->12}:|{:->8}:|{:->13}:|{:->11}:|\n", "", "", "", "", "", "", "");
    for (const double radius : {10.0, 5.0, 3.0}) {
        for (const Method& method : compared_methods()) {
            if (!(method.name.starts_with("default") || method.name.starts_with("paper's c") || method.name == "off"))
                continue;
            const SphereUnity s = sphere_unity(method.settings, radius);
            fmt::print("| {:6} | {:<28} | {:7.4f} | {:11.4f} | {:7.4f} | {:12.4f} | {:10.4f} |\n", radius, method.name,
                       s.unity.rms, s.unity.mean_of_max, s.unity.max, s.raw, s.normalised);
        }
    }
}

void walls() {
    fmt::print("\nPlates between two cavities, 12 orientations; face-on tau, edge-on rise and place (voxels)\n\n");
    fmt::print("| {:>5} | {:<28} | {:>8} | {:>6} | {:>8} | {:>6} | {:>8} | {:>6} |\n", "thick", "method", "min/mean",
               "CoV", "tau/true", "rise", "location", "missed");
    fmt::print("|{:->6}:|{:-<30}|{:->9}:|{:->7}:|{:->9}:|{:->7}:|{:->9}:|{:->7}:|\n", "", "", "", "", "", "", "", "");
    for (const double thickness : {0.6, 1.0, 1.5, 2.0, 3.0}) {
        for (const Method& method : compared_methods()) {
            if (!(method.name.starts_with("default") || method.name.starts_with("paper") || method.name == "off"))
                continue;
            const Wall w = wall(method.settings, thickness);
            fmt::print("| {:5} | {:<28} | {:8.3f} | {:6.3f} | {:8.3f} | {:6.3f} | {:8.4f} | {:6} |\n", thickness,
                       method.name, w.low, w.variation, w.depth, w.rise, w.location, w.missed);
        }
    }
}

}  // namespace

int main(int argc, char** argv) {
    try {
        const std::set<std::string> wanted(argv + 1, argv + argc);
        const auto runs = [&](const char* name) { return wanted.empty() || wanted.contains(name); };
        const DeviceInfo& device = test_renderer().device();
        fmt::print("Device: {} ({}), {} {}, Vulkan {}\n", device.name, device.type, device.driver,
                   device.driver_version, device.api_version);
        if (runs("planes")) planes();
        if (runs("silhouettes")) silhouettes();
        if (runs("unity")) unity();
        if (runs("walls")) walls();
        const auto messages = test_renderer().validation_messages();
        fmt::print("\nValidation messages: {}\n", messages);
        close_test_renderer();
        return messages == 0 ? 0 : 1;
    } catch (const std::exception& error) {
        close_test_renderer();
        fmt::print(stderr, "edge_quality: {}\n", error.what());
        return 1;
    }
}
