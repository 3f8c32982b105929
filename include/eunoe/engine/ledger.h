#ifndef eunoe_engine_ledger_h
#define eunoe_engine_ledger_h

#include <eunoe/core/exact_sum.h>

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <mpi.h>
#include <vector>

namespace eunoe {

/// A number of particles and their mass, exact.
struct Tally
{
  std::uint64_t number = 0;
  ExactSum mass; ///< (kg)

  void count(double m)
  {
    ++number;
    mass += m;
  }

  Tally &operator+=(const Tally &other)
  {
    number += other.number;
    mass += other.mass;
    return *this;
  }

  /// Sum over all ranks; collective.
  Tally global(MPI_Comm comm) const
  {
    Tally sum = *this;
    MPI_Allreduce(MPI_IN_PLACE, &sum.number, 1, MPI_UINT64_T, MPI_SUM, comm);
    sum.mass.reduce(comm);
    return sum;
  }
};

/// Where particles came from and went: inserted = inside + through outlets + taken out + lost, in
/// number and, without any rounding, in mass.
struct Ledger
{
  explicit Ledger(std::size_t n_outlets) : through_outlet(n_outlets) {}

  /// Of all ranks; collective.
  nlohmann::ordered_json save(MPI_Comm comm) const;
  /// Gives what was saved to the first rank.
  void load(const nlohmann::ordered_json &saved, MPI_Comm comm);

  Tally inserted;
  Tally taken_out;                   ///< by a process
  Tally lost;                        ///< left the mesh other than through an outlet, or NaN
  std::vector<Tally> through_outlet; ///< in the order of Domain::outlets
};

} // namespace eunoe

#endif
