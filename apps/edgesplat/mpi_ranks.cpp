#include "apps/edgesplat/mpi_ranks.h"

#include <fmt/format.h>
#include <mpi.h>

#include <unistd.h>
#include <cstdio>

#include "apps/edgesplat/mpi_launcher.h"

namespace ranks {
namespace {

int own_index = 0, all = 1;
bool joined = false;

}  // namespace

void join() {
    if (launched_ranks() == 0) return;
    MPI_Init(nullptr, nullptr);
    joined = true;
    MPI_Comm_rank(MPI_COMM_WORLD, &own_index);
    MPI_Comm_size(MPI_COMM_WORLD, &all);
    if (own_index == 0) return;
    // Only the first rank prints to stdout.
    std::fflush(stdout);
    if (std::freopen("/dev/null", "w", stdout) == nullptr)
        fmt::print(stderr, "edgesplat: /dev/null: cannot be opened\n");
}

void leave() {
    if (joined) MPI_Finalize();
    joined = false;
}

void end_all(int status) {
    if (joined) MPI_Abort(MPI_COMM_WORLD, status);
}

int index() {
    return own_index;
}

int count() {
    return all;
}

void wait() {
    if (all > 1) MPI_Barrier(MPI_COMM_WORLD);
}

bool any(bool here) {
    int value = here ? 1 : 0;
    if (all > 1) MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_INT, MPI_LOR, MPI_COMM_WORLD);
    return value != 0;
}

void share_bytes(std::span<std::byte> bytes) {
    if (all > 1) MPI_Bcast(bytes.data(), static_cast<int>(bytes.size()), MPI_BYTE, 0, MPI_COMM_WORLD);
}

std::string label() {
    return all > 1 ? fmt::format("rank {} of {}: ", own_index, all) : "";
}

}  // namespace ranks
