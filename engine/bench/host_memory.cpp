#include "engine/bench/host_memory.h"

#include <fstream>
#include <string>

namespace edgesplat::bench {

std::uint64_t host_peak_bytes() {
    std::ifstream in("/proc/self/status");
    for (std::string key; in >> key;) {
        std::uint64_t kib = 0;
        if (key == "VmHWM:" && in >> kib) return kib * 1024;
        in.ignore(1 << 16, '\n');
    }
    return 0;
}

bool reset_host_peak() {
    std::ofstream out("/proc/self/clear_refs");
    out << "5" << std::flush;
    return out.good();
}

}  // namespace edgesplat::bench
