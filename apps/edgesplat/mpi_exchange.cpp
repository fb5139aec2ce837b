#include "apps/edgesplat/mpi_exchange.h"

#include <limits>

#include "engine/error.h"

namespace ranks {
namespace {

// NOLINTBEGIN(readability-non-const-parameter): the type is MPI's.
/// MPI_User_function: behind = front over behind. MPI passes the pixels of the lower ranks as `front`.
void fold_pixels(void* front, void* behind, int* count, MPI_Datatype* /*pixel*/) {
    const auto* in = static_cast<const glm::vec4*>(front);
    auto* out = static_cast<glm::vec4*>(behind);
    for (int i = 0; i < *count; ++i)
        out[i] = edgesplat::over(in[i], out[i]);
}
// NOLINTEND(readability-non-const-parameter)

/// Reduces the values of all ranks to rank 0.
void reduce(void* values, int count, MPI_Datatype type, MPI_Op operation, int rank) {
    if (rank == 0)
        MPI_Reduce(MPI_IN_PLACE, values, count, type, operation, 0, MPI_COMM_WORLD);
    else
        MPI_Reduce(values, nullptr, count, type, operation, 0, MPI_COMM_WORLD);
}

}  // namespace

int mpi_count(std::size_t count) {
    if (count > static_cast<std::size_t>(std::numeric_limits<int>::max()))
        edgesplat::fail("{} elements: MPI transfers at most 2^31 - 1 at once", count);
    return static_cast<int>(count);
}

MpiExchange::MpiExchange(const edgesplat::SheetPart& part) : part_(part) {
    MPI_Type_contiguous(4, MPI_FLOAT, &pixel_);
    MPI_Type_commit(&pixel_);
    MPI_Op_create(&fold_pixels, /*commute=*/0, &over_);
}

MpiExchange::~MpiExchange() {
    MPI_Op_free(&over_);
    MPI_Type_free(&pixel_);
}

void MpiExchange::wait() {
    MPI_Barrier(MPI_COMM_WORLD);
}

int MpiExchange::largest(int value) {
    MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
    return value;
}

void MpiExchange::pass_back(std::span<float> transmittance) {
    MPI_Exscan(MPI_IN_PLACE, transmittance.data(), mpi_count(transmittance.size()), MPI_FLOAT, MPI_PROD,
               MPI_COMM_WORLD);
}

void MpiExchange::fold(std::span<glm::vec4> pixels) {
    reduce(pixels.data(), mpi_count(pixels.size()), pixel_, over_, part_.index);
}

void MpiExchange::add(std::span<glm::vec4> pixels) {
    reduce(pixels.data(), mpi_count(4 * pixels.size()), MPI_FLOAT, MPI_SUM, part_.index);
}

void MpiExchange::share(std::span<std::uint32_t> words) {
    MPI_Bcast(words.data(), mpi_count(words.size()), MPI_UINT32_T, 0, MPI_COMM_WORLD);
}

}  // namespace ranks
