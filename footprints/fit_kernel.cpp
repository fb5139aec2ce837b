// Refits the reconstruction kernels and prints them beside the built-in ones. Usage: fit_kernel [steps]
#include <fmt/format.h>

#include <cstdlib>
#include <exception>

#include "footprints/kernel_fit.h"

int main(int argc, char** argv) try {
    using namespace edgesplat;
    const int steps = argc > 1 ? std::atoi(argv[1]) : 24;
    for (const Kernel& built_in : {kKernel, kNarrowKernel}) {
        const Kernel fitted = fit_kernel(steps, built_in.radius);
        fmt::print("radius {}, linear program on {} points per half voxel\n\n        fitted        built in\n",
                   built_in.radius, steps);
        for (std::size_t i = 0; i < fitted.coefficients.size(); ++i)
            fmt::print("w^{}  {:12.9f}  {:12.9f}\n", i + 2, fitted.coefficients[i], built_in.coefficients[i]);
        fmt::print("\nripple in 3-D: fitted {:.3g}, built in {:.3g}\n", kernel_ripple(60, fitted),
                   kernel_ripple(60, built_in));
        fmt::print("ripple of the built-in footprints: along an axis {:.3g}, along (1 2 3) {:.3g}\n\n",
                   footprint_ripple({0, 0, 1}, 40, built_in), footprint_ripple({1, 2, 3}, 40, built_in));
    }
    return 0;
} catch (const std::exception& error) {
    fmt::print(stderr, "fit_kernel: {}\n", error.what());
    return 1;
}
