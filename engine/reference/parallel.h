// Splits independent work over the machine's threads.
#pragma once

#include <functional>

namespace edgesplat::reference {

/// Calls `work(begin, end)` on contiguous pieces of [0, count), several at a time, and waits for all of them. What is
/// computed must not depend on how the range is cut; an exception of a piece is thrown again here.
void parallel_for(int count, const std::function<void(int begin, int end)>& work);

}  // namespace edgesplat::reference
