#ifndef eunoe_discovery_measured_data_h
#define eunoe_discovery_measured_data_h

#include <eunoe/discovery/data_point.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

namespace eunoe::discovery {

/// What was measured at one data point. SI units.
struct MeasuredPoint
{
  DataPoint point;
  double value = 0.;              ///< mean of the repeats
  double standard_deviation = 0.; ///< of a single repeat, instrument and process together; > 0
  unsigned int repeats = 1;
};

/// A table of measurements. Held-out data belong to experiments of their own (another layer
/// thickness, velocity or length), and no stage before the validation reads them.
struct MeasuredData
{
  std::vector<MeasuredPoint> fit, held_out;
  std::map<std::string, std::string> header; ///< lines "# key: value" of the file
};

/// Names of the experiments of data points, in the order of their first ones.
inline std::vector<std::string> experiments_of(const std::vector<MeasuredPoint> &points)
{
  std::vector<std::string> names;
  for (const MeasuredPoint &point : points)
    if (std::find(names.begin(), names.end(), point.point.experiment) == names.end())
      names.push_back(point.point.experiment);
  return names;
}

} // namespace eunoe::discovery

#endif
