#ifndef eunoe_discovery_measured_csv_h
#define eunoe_discovery_measured_csv_h

#include <eunoe/core/problems.h>
#include <eunoe/discovery/experiment.h>
#include <eunoe/discovery/measured_data.h>

namespace eunoe::discovery {

/// Reads a table "experiment,observable,index,value,std,repeats,use" that follows lines
/// "# key: value".
/// All that is wrong with it goes to @p problems, each with its line.
/// @param experiments of the study, which say what names there are and what is held out
MeasuredData read_measured(const std::string &text, const std::string &file,
                           const std::vector<Experiment> &experiments, Problems &problems);

/// The text of such a table, with full precision and the header's lines first.
std::string write_measured(const MeasuredData &data);

/// Key of the header's line with the unit of an observable.
inline std::string unit_key(const std::string &observable)
{
  return "unit of " + observable;
}

/// Adds data points that the experiments do not give to the problems, with what they give instead.
/// @param points of the simulator, by experiment
void check_data_points(const MeasuredData &data,
                       const std::map<std::string, std::vector<DataPoint>> &points,
                       const std::string &file, Problems &problems);

} // namespace eunoe::discovery

#endif
