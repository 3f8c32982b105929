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

/// What was found: the keys of summary.json, and the same as measurements, with the profile.
struct Findings
{
  nlohmann::ordered_json keys = nlohmann::ordered_json::object();
  std::vector<Measurement> measured;
};

/// Measures the heap, now: writes heap.csv, heap_profile.csv and heap_map.pgm; collective.
/// @param tube_height of the tube's lower end (m)
Findings measure(Simulation &simulation, const HeapParameters &parameters,
                 const Apparatus &apparatus, double tube_height);

/// The same measurements of a heap that was not simulated here, but for the mass that was drained.
/// Throws a UserError if there is nothing on the disc.
std::vector<Measurement> measure(const HeapParameters &parameters,
                                 const PhysicalProperties &physics,
                                 const std::vector<GivenParticle> &particles);

/// What measure() finds.
std::vector<ObservableDescription> observables();

} // namespace eunoe::heap

#endif
