#include "engine/volume/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace edgesplat {

void parallel_for(int count, const std::function<void(int, int)>& work) {
    const int threads = std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, std::max(count, 1));
    // More pieces than threads, since their costs differ strongly (background or tissue).
    const int piece = std::max(1, count / (threads * 8));
    std::atomic<int> next{0};
    std::exception_ptr failure;
    std::mutex failure_mutex;
    const auto run = [&] {
        try {
            for (int begin = next.fetch_add(piece); begin < count; begin = next.fetch_add(piece)) {
                work(begin, std::min(begin + piece, count));
            }
        } catch (...) {
            const std::lock_guard lock(failure_mutex);
            failure = std::current_exception();
        }
    };
    {
        std::vector<std::jthread> pool;
        for (int i = 1; i < threads; ++i)
            pool.emplace_back(run);
        run();
    }
    if (failure) std::rethrow_exception(failure);
}

}  // namespace edgesplat
