// Many pictures in one process, as an application draws them: one renderer for all of it, others that come and go, and
// whatever scene, settings and size a seed says. What grows is noted.
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
    int looks = 24;           ///< settings and effects to choose from; each takes a software driver long to compile
    bool validation = false;  ///< its layer keeps some 70 KiB for every renderer that was
};

/// What the process holds after so many frames, with every renderer gone but one, which has drawn a picture that is
/// always the same.
struct SoakSample {
    int frame = 0;
    double host_mib = 0;             ///< resident, after what is free was given back
    double heap_mib = 0;             ///< allocated and not freed, by the account of the C library
    std::uint64_t device_bytes = 0;  ///< by the engine's own account
    int descriptors = 0;             ///< open files
    double milliseconds = 0;         ///< a frame, on average since the last sample
};

struct SoakResult {
    std::vector<SoakSample> samples;
    std::vector<std::string> problems;  ///< what was not finite, differed, was refused, or not valid Vulkan
};

/// From now on blocks that are freed go back to the system, and threads share one heap: what is resident is then what
/// is held, not the holes between.
void leave_no_holes();

/// What the process holds in memory, after what is free was given back to the system.
double resident_mib();

/// Draws the frames; `note` is called with each sample.
SoakResult soak(const SoakOptions& options, const std::function<void(const SoakSample&)>& note = {});

/// Growth of resident memory over the samples from frame `from` on, by the line that fits them best, as a share of
/// their mean.
double host_growth(const std::vector<SoakSample>& samples, int from);

}  // namespace edgesplat::test
