// Draws many pictures in one process, like an application: one permanent renderer, others that come and go; random
// scenes, settings and sizes. Records the growth of resources.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace edgesplat::test {

struct SoakOptions {
    int frames = 200;
    std::uint32_t seed = 1;
    int every = 100;          ///< frames between samples
    int looks = 24;           ///< number of different settings and effects; a software driver compiles long for each
    bool validation = false;  ///< the validation layer keeps about 70 KiB for every renderer that existed
};

/// Resources of the process after some frames. All renderers except one are destroyed, and that one has drawn a picture
/// that is always the same.
struct SoakSample {
    int frame = 0;
    double host_mib = 0;             ///< resident memory, after free memory was returned
    double heap_mib = 0;             ///< allocated and not freed, according to the C library
    std::uint64_t device_bytes = 0;  ///< according to the engine
    int descriptors = 0;             ///< open files
    double milliseconds = 0;         ///< mean per frame since the last sample
};

struct SoakResult {
    std::vector<SoakSample> samples;
    std::vector<std::string> problems;  ///< frames with non-finite values, other results, errors or validation messages
};

/// Makes freed blocks return to the system, and threads share one heap. Then resident memory is the used memory,
/// without holes.
void leave_no_holes();

/// Resident memory of the process, MiB, after free memory was returned to the system.
double resident_mib();

/// Draws the frames; `note` is called with each sample.
SoakResult soak(const SoakOptions& options, const std::function<void(const SoakSample&)>& note = {});

/// Growth of resident memory over the samples from frame `from` on, by a least-squares line, relative to their mean.
double host_growth(const std::vector<SoakSample>& samples, int from);

}  // namespace edgesplat::test
