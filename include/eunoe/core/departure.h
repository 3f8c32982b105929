#ifndef eunoe_core_departure_h
#define eunoe_core_departure_h

#include <mpi.h>
#include <string>

namespace eunoe {

/// Ends a program whose ranks cannot continue. Most errors occur on all ranks, which then end in
/// order. If only one rank has an error, the others would wait for it for ever.
class Departure
{
public:
  /// Collective, like the destructor.
  explicit Departure(MPI_Comm comm);
  ~Departure();
  Departure(const Departure &) = delete;
  Departure &operator=(const Departure &) = delete;

  /// Prints the reason once. Waits until all ranks are here; if some do not come, ends them, too.
  /// @param patience how long it waits (s)
  void leave(const std::string &sentence, double patience) const;

private:
  /// Whether all ranks come in time.
  bool meet(double patience) const;
  /// Whether a rank before this one is here, too.
  bool is_preceded() const;

  MPI_Comm comm; ///< of its own, as others may have messages on their way
};

} // namespace eunoe

#endif
