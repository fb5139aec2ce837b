// Rank functions of a program built without MPI: there is one rank.

#include "apps/edgesplat/mpi_launcher.h"
#include "apps/edgesplat/mpi_ranks.h"
#include "engine/error.h"

namespace ranks {

void join() {
    if (launched_ranks() > 1)
        edgesplat::fail(
            "this program was built without MPI, so each process would draw the same; run it without mpirun, or build "
            "it with -D EDGESPLAT_MPI=ON (Debian: libopenmpi-dev)");
}

void leave() {}

void end_all(int /*status*/) {}

int index() {
    return 0;
}

int count() {
    return 1;
}

void wait() {}

bool any(bool here) {
    return here;
}

void share_bytes(std::span<std::byte> /*bytes*/) {}

std::vector<std::byte> gather_bytes(std::span<const std::byte> bytes) {
    return {bytes.begin(), bytes.end()};
}

std::string label() {
    return {};
}

std::unique_ptr<edgesplat::PartExchange> part_exchange() {
    return nullptr;
}

}  // namespace ranks
