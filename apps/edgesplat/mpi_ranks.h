// The processes that mpirun started together, as far as commands are concerned: who is who, what all must know, and how
// they end. Without mpirun there is one, and nothing of MPI is touched.
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

/// Joins the others, if mpirun (or another MPI launcher) started this process. Throws edgesplat::Error where this
/// program was built without MPI and others were started.
void join();
/// The last word of a rank that was not stopped; waits for the others.
void leave();
/// Ends all ranks, this one included, unless it is alone.
void end_all(int status);

int index();
int count();
/// Whether this rank speaks and writes for all.
inline bool first() {
    return index() == 0;
}

void wait();
/// Whether any of the ranks says so.
bool any(bool here);
/// Overwrites the bytes with those of the first rank.
void share_bytes(std::span<std::byte> bytes);
/// With the first rank, the bytes of all in their order; elsewhere of no use. All have the same number.
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

/// "rank 2 of 4: " for messages; nothing where there is one.
std::string label();

/// One picture by all ranks; null where there is one.
std::unique_ptr<edgesplat::PartExchange> part_exchange();

}  // namespace ranks
