#ifndef eunoe_discovery_data_point_h
#define eunoe_discovery_data_point_h

#include <string>
#include <tuple>

namespace eunoe::discovery {

/// The name of one measured number: which experiment, which observable of it, and which index
/// (layer, bin of a profile; 0 for a single number). The observable says what the index means and
/// what the unit is. Files and tables call it a cell.
struct DataPoint
{
  std::string experiment, observable;
  int index = 0;

  bool operator==(const DataPoint &other) const { return tie() == other.tie(); }
  bool operator<(const DataPoint &other) const { return tie() < other.tie(); }

private:
  std::tuple<const std::string &, const std::string &, int> tie() const
  {
    return std::tie(experiment, observable, index);
  }
};

} // namespace eunoe::discovery

#endif
