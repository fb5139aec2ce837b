// Composites partial pictures with MPI: a reduction with the non-commutative operator `over`.
#pragma once

#include <mpi.h>

#include "engine/distribute/part_exchange.h"

namespace ranks {

/// Converts a number of elements to the type that MPI counts with. Throws edgesplat::Error beyond 2^31 - 1.
int mpi_count(std::size_t count);

/// Exchange among all processes of MPI_COMM_WORLD, in order of rank. May exist only between MPI_Init and MPI_Finalize.
class MpiExchange : public edgesplat::PartExchange {
  public:
    explicit MpiExchange(const edgesplat::SheetPart& part);
    ~MpiExchange() override;
    MpiExchange(const MpiExchange&) = delete;
    MpiExchange& operator=(const MpiExchange&) = delete;

    edgesplat::SheetPart part() const override { return part_; }
    void wait() override;
    int largest(int value) override;
    void pass_back(std::span<float> transmittance) override;
    void fold(std::span<glm::vec4> pixels) override;
    void add(std::span<glm::vec4> pixels) override;
    void share(std::span<std::uint32_t> words) override;

  private:
    edgesplat::SheetPart part_;
    MPI_Datatype pixel_ = MPI_DATATYPE_NULL;  ///< four floats, so that a reduction never splits a pixel
    MPI_Op over_ = MPI_OP_NULL;
};

}  // namespace ranks
