// Detects without MPI whether an MPI launcher started this process.
#pragma once

#include <cstdlib>
#include <initializer_list>

namespace ranks {

/// Number of processes that mpirun, mpiexec or srun started together; 0: none of them started this process.
inline int launched_ranks() {
    for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"})
        if (const char* value = std::getenv(name)) return std::atoi(value);  // NOLINT(cert-err34-c): 0 is no number
    // PMIx does not put the size into the environment; 2 means several.
    return std::getenv("PMIX_RANK") != nullptr ? 2 : 0;
}

}  // namespace ranks
