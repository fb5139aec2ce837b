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

std::string label() {
    return {};
}

}  // namespace ranks
