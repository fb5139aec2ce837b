// The processes (ranks) that mpirun started together: their numbers, exchange of values, and how they end. Without
// mpirun there is one rank, and MPI is not used.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <type_traits>

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

template <typename T>
void share(std::span<T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    share_bytes(std::as_writable_bytes(values));
}

/// Prefix of messages, "rank 2 of 4: "; empty if there is one rank.
std::string label();

}  // namespace ranks
