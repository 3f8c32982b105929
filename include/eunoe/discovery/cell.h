#ifndef eunoe_discovery_cell_h
#define eunoe_discovery_cell_h

#include <string>
#include <tuple>

namespace eunoe::discovery {

/// The place of one number among all that are measured: which experiment, which observable of it,
/// and where (layer, bin of a profile; 0 for a single number). What an index means, and the unit,
/// stand with the observable.
struct Cell
{
  std::string experiment, observable;
  int index = 0;

  bool operator==(const Cell &other) const { return tie() == other.tie(); }
  bool operator<(const Cell &other) const { return tie() < other.tie(); }

private:
  std::tuple<const std::string &, const std::string &, int> tie() const
  {
    return std::tie(experiment, observable, index);
  }
};

} // namespace eunoe::discovery

#endif
