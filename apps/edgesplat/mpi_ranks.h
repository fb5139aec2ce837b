// The processes (ranks) that mpirun started together: their numbers, exchange of values, and how they end. Without
// mpirun there is one rank, and MPI is not used.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "engine/distribute/part_exchange.h"

namespace ranks {

/// Joins the other ranks if mpirun (or another MPI launcher) started this process. Throws edgesplat::Error if several
/// processes were started but this program was built without MPI.
void join();
/// Must be the last call of a rank that was not stopped; waits for the others.
void leave();
/// Aborts all ranks, including this one. Does nothing without mpirun.
void end_all(int status);

int index();
int count();
/// Whether this is rank 0, which prints and writes for all ranks.
inline bool first() {
    return index() == 0;
}

void wait();
/// Whether `here` is true on any rank.
bool any(bool here);
/// Overwrites the bytes with those of rank 0.
void share_bytes(std::span<std::byte> bytes);
/// Rank 0 receives the bytes of all ranks in order; the result of other ranks is unspecified. Every rank passes the
/// same number of bytes.
std::vector<std::byte> gather_bytes(std::span<const std::byte> bytes);

template <typename T>
void share(std::span<T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    share_bytes(std::as_writable_bytes(values));
}

template <typename T>
std::vector<T> gather(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    const std::vector<std::byte> bytes = gather_bytes(std::as_bytes(std::span(&value, 1)));
    std::vector<T> values(bytes.size() / sizeof(T));
    std::copy(bytes.begin(), bytes.end(), std::as_writable_bytes(std::span(values)).begin());
    return values;
}

/// Prefix of messages, "rank 2 of 4: "; empty if there is one rank.
std::string label();

/// Exchange for one picture that all ranks draw together; null if there is one rank.
std::unique_ptr<edgesplat::PartExchange> part_exchange();

}  // namespace ranks
