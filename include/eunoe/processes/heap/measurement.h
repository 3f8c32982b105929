#ifndef eunoe_processes_heap_measurement_h
#define eunoe_processes_heap_measurement_h

#include <eunoe/processes/heap/apparatus.h>
#include <eunoe/processes/heap/silhouettes.h>
#include <eunoe/simulation/simulation.h>

#include <nlohmann/json.hpp>

namespace eunoe::heap {

/// A measured profile, in ascending order of x (m).
struct MeasuredProfile
{
  std::vector<double> x, height;

  /// Height by linear interpolation; not a number beyond its ends.
  double at(double place) const;
  /// Area below it (m2).
  double area() const;
};

/// Reads a table with the columns "x" and "height". Throws a UserError that says what is wrong.
MeasuredProfile read_profile(const std::string &file);

/// Measures the heap, now: writes heap.csv, heap_profile.csv and heap_map.pgm; collective.
/// @param tube_height of the tube's lower end (m)
/// @return the keys of summary.json
nlohmann::ordered_json measure(Simulation &simulation, const HeapParameters &parameters,
                               const Apparatus &apparatus, double tube_height);

} // namespace eunoe::heap

#endif
