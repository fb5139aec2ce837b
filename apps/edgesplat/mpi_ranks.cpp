#include "apps/edgesplat/mpi_ranks.h"

#include <fmt/format.h>
#include <mpi.h>

#include <unistd.h>
#include <cstdio>

#include "apps/edgesplat/mpi_exchange.h"
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
    if (all > 1) MPI_Bcast(bytes.data(), mpi_count(bytes.size()), MPI_BYTE, 0, MPI_COMM_WORLD);
}

std::vector<std::byte> gather_bytes(std::span<const std::byte> bytes) {
    if (all == 1) return {bytes.begin(), bytes.end()};
    std::vector<std::byte> gathered(first() ? bytes.size() * static_cast<std::size_t>(all) : 0);
    const int count = mpi_count(bytes.size());
    MPI_Gather(bytes.data(), count, MPI_BYTE, gathered.data(), count, MPI_BYTE, 0, MPI_COMM_WORLD);
    return gathered;
}

std::string label() {
    return all > 1 ? fmt::format("rank {} of {}: ", own_index, all) : "";
}

std::unique_ptr<edgesplat::PartExchange> part_exchange() {
    if (all == 1) return nullptr;
    return std::make_unique<MpiExchange>(edgesplat::SheetPart{own_index, all});
}

}  // namespace ranks
