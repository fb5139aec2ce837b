#include "engine/reference/pixel_rows.h"

#include <algorithm>
#include <atomic>
#include <numeric>
#include <thread>

#include "engine/volume/parallel.h"

namespace edgesplat::reference {

void check_picture_size(int width, int height) {
    if (width < 1 || height < 1 || width > 16384 || height > 16384) {
        fail("picture of {} x {} pixels, expected 1 to 16384 each", width, height);
    }
}

namespace {

void for_each_row(int height, const Progress& progress, const std::function<void(int)>& row) {
    // A stride coprime to the height visits every row once, and neighbouring rows at distant times.
    int stride = std::max(height * 5 / 13, 1);
    while (std::gcd(stride, height) != 1)
        ++stride;

    const std::thread::id caller = std::this_thread::get_id();
    std::atomic<int> done{0};
    std::atomic<bool> stopped{false};
    parallel_for(height, [&](int begin, int end) {
        for (int i = begin; i < end && !stopped; ++i) {
            row(static_cast<int>(static_cast<long long>(i) * stride % height));
            const int rows = ++done;
            if (progress && std::this_thread::get_id() == caller && !progress(static_cast<double>(rows) / height))
                stopped = true;
        }
    });
    if (stopped || (progress && !progress(1))) throw Cancelled("cancelled");
}

}  // namespace

RayFrame trace_rays(int width, int height, RayValue value, const Progress& progress,
                    const std::function<RayTracer()>& make) {
    const auto w = static_cast<std::size_t>(width);
    const auto h = static_cast<std::size_t>(height);
    RayFrame frame;
    frame.pixels.assign(w * h, glm::dvec4(0));
    std::vector<double> errors(h, 0.0);
    std::vector<std::uint64_t> samples(h, 0);
    for_each_row(height, progress, [&](int y) {
        const auto row = static_cast<std::size_t>(y);
        const RayTracer tracer = make();
        for (int x = 0; x < width; ++x) {
            const RaySum sum = tracer(x, y);
            frame.pixels[row * w + static_cast<std::size_t>(x)] =
                glm::dvec4(sum.color, value == RayValue::Tau ? sum.tau : 1 - sum.transmittance);
            errors[row] = std::max(errors[row], sum.error);
            samples[row] += sum.samples;
        }
    });
    frame.error = *std::max_element(errors.begin(), errors.end());
    frame.samples = std::accumulate(samples.begin(), samples.end(), std::uint64_t{0});
    return frame;
}

}  // namespace edgesplat::reference
