#ifndef eunoe_simulation_measurement_h
#define eunoe_simulation_measurement_h

#include <eunoe/core/vec3.h>

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace eunoe {

/// One number that a run has measured, as discovery compares it with measured data. SI units.
struct Measurement
{
  std::string observable;
  int index; ///< layer or bin; 0 for a single number
  double value;
};

/// What an observable is: for lists, and for the header of tables.
struct ObservableDescription
{
  std::string name, unit, index_meaning, text;
};

/// A particle that was not simulated here: of another program, or of a scan. SI units.
struct GivenParticle
{
  Vec3 centre;
  double radius, mass;
};

/// Measurements as a table: `observable,index,value,unit`.
std::string table_of(const std::vector<Measurement> &measurements,
                     const std::vector<ObservableDescription> &descriptions);

/// Measurements for a checkpoint, and their return. Throws a std::invalid_argument for what is
/// none.
///@{
nlohmann::ordered_json to_json(const std::vector<Measurement> &measurements);
std::vector<Measurement> measurements_in(const nlohmann::ordered_json &json);
///@}

} // namespace eunoe

#endif
