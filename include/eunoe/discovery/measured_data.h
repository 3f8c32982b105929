#ifndef eunoe_discovery_measured_data_h
#define eunoe_discovery_measured_data_h

#include <eunoe/discovery/cell.h>

#include <map>
#include <string>
#include <vector>

namespace eunoe::discovery {

/// What is known of one cell by measurement. SI units.
struct MeasuredCell
{
  Cell cell;
  double value = 0.;              ///< mean of the repeats
  double standard_deviation = 0.; ///< of a single repeat, instrument and process together
  unsigned int repeats = 1;
};

/// A table of measurements. What is held out is a condition of its own (another layer thickness,
/// velocity or length: an experiment), and no stage before the validation reads it.
struct MeasuredData
{
  std::vector<MeasuredCell> fit, held_out;
  std::map<std::string, std::string> header; ///< what the file says of itself
};

} // namespace eunoe::discovery

#endif
