// Whether an MPI launcher started this process, told without MPI.
#pragma once

#include <cstdlib>
#include <initializer_list>

namespace ranks {

/// How many processes mpirun, mpiexec or srun say they started together; 0: none of them started this one.
inline int launched_ranks() {
    for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"})
        if (const char* value = std::getenv(name)) return std::atoi(value);  // NOLINT(cert-err34-c): 0 is no number
    // PMIx tells the size only to those who ask it.
    return std::getenv("PMIX_RANK") != nullptr ? 2 : 0;
}

}  // namespace ranks
