// soak [FRAMES [SEED [LOOKS [validation]]]]: draws many frames in one process, by default 10000. Fails if a picture is
// not finite or changes, or on validation messages. Without validation, whose layer keeps memory of its own, it also
// fails if the process grows by more than 1 % from frame 1000 to the end.
#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string_view>

#include "tests/stability/soak.h"

int main(int argc, char** argv) {
    using namespace edgesplat::test;
    leave_no_holes();
    try {
        SoakOptions options{.frames = 10000};
        if (argc > 1) options.frames = std::atoi(argv[1]);
        if (argc > 2) options.seed = static_cast<std::uint32_t>(std::atoi(argv[2]));
        if (argc > 3) options.looks = std::atoi(argv[3]);
        options.validation = argc > 4 && std::string_view(argv[4]) == "validation";
        fmt::print("{:>8} {:>10} {:>10} {:>12} {:>8} {:>10}\n", "frame", "host MiB", "heap MiB", "device MiB", "files",
                   "ms/frame");
        const SoakResult result = soak(options, [](const SoakSample& s) {
            fmt::print("{:>8} {:>10.2f} {:>10.2f} {:>12.3f} {:>8} {:>10.1f}\n", s.frame, s.host_mib, s.heap_mib,
                       static_cast<double>(s.device_bytes) / (1024.0 * 1024.0), s.descriptors, s.milliseconds);
            std::fflush(stdout);
        });
        for (const std::string& problem : result.problems)
            fmt::print("{}\n", problem);
        const double growth = host_growth(result.samples, 1000);
        fmt::print("host memory from frame 1000 on: {:+.3f} %\n", 100 * growth);
        return result.problems.empty() && (options.validation || growth <= 0.01) ? 0 : 1;
    } catch (const std::exception& error) {
        fmt::print(stderr, "soak: {}\n", error.what());
        return 1;
    }
}
