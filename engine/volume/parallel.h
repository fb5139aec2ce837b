// Distributes independent work over the machine's threads.
#pragma once

#include <functional>

namespace edgesplat {

/// Calls `work(begin, end)` on contiguous pieces of [0, count) in parallel and waits for all of them. The result must
/// not depend on how the range is cut. Rethrows an exception of a piece.
void parallel_for(int count, const std::function<void(int begin, int end)>& work);

}  // namespace edgesplat
