#ifndef eunoe_tests_discovery_recorded_table_h
#define eunoe_tests_discovery_recorded_table_h

// The table that record_runs.cc writes: simulations of a study's experiments.

#include <eunoe/discovery/data_point.h>
#include <eunoe/discovery/factor.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace test {

using namespace eunoe::discovery;

struct RecordedTable
{
  /// One simulation: the base model ("base"), or one factor at one amplitude.
  struct Run
  {
    std::string experiment, factor;
    double amplitude = 0.;
    std::uint32_t seed = 0;
    Eigen::VectorXd values;
  };

  std::vector<Factor> factors;
  std::vector<std::string> fit, held_out; ///< experiments
  std::map<std::string, std::vector<DataPoint>> points;
  std::vector<Run> runs;
  unsigned int n_failed = 0;

  /// @param only_complete leaves out data points that a run lacks, or that do not vary in runs of
  /// the base model
  explicit RecordedTable(const std::string &path, const bool only_complete = true)
  {
    std::ifstream file(path);
    if (!file)
      throw std::runtime_error("cannot read " + path);
    for (std::string line; std::getline(file, line);) {
      std::istringstream words(line);
      std::string first;
      words >> first;
      if (first.empty() || first[0] == '#')
        continue;
      if (first == "factor")
        read_factor(words);
      else if (first == "cells")
        read_cells(words);
      else
        read_run(first, words);
    }
    if (only_complete)
      keep_complete_cells();
  }

  std::vector<const Run *> of(const std::string &experiment, const std::string &factor) const
  {
    std::vector<const Run *> result;
    for (const Run &run : runs)
      if (run.experiment == experiment && run.factor == factor)
        result.push_back(&run);
    return result;
  }

private:
  void read_factor(std::istringstream &words)
  {
    Factor f;
    std::string kind, sign;
    words >> f.name >> kind >> f.null_value >> f.scale >> f.lower >> f.upper >> sign >>
        f.prior_deviation;
    f.kind = kind == "effect" ? Factor::Kind::effect : Factor::Kind::nuisance;
    f.sign = sign == "above"   ? Factor::Sign::above
             : sign == "below" ? Factor::Sign::below
                               : Factor::Sign::both;
    factors.push_back(f);
  }

  void read_cells(std::istringstream &words)
  {
    std::string experiment;
    int is_held_out = 0;
    words >> experiment >> is_held_out;
    (is_held_out != 0 ? held_out : fit).push_back(experiment);
    for (std::string point; words >> point;) {
      const std::size_t colon = point.rfind(':');
      points[experiment].push_back(
          {experiment, point.substr(0, colon), std::stoi(point.substr(colon + 1))});
    }
  }

  void read_run(const std::string &experiment, std::istringstream &words)
  {
    Run run;
    run.experiment = experiment;
    words >> run.factor >> run.amplitude >> run.seed;
    run.values.resize(static_cast<Eigen::Index>(points.at(experiment).size()));
    for (double &value : run.values) {
      // The stream does not read "nan".
      std::string word;
      if (!(words >> word) || word == "failed") {
        ++n_failed;
        return;
      }
      value = std::strtod(word.c_str(), nullptr);
    }
    runs.push_back(run);
  }

  void keep_complete_cells()
  {
    for (auto &[experiment, list] : points) {
      const std::vector<const Run *> base = of(experiment, "base");
      std::vector<Eigen::Index> kept;
      std::vector<DataPoint> left;
      for (std::size_t c = 0; c < list.size(); ++c) {
        const auto k = static_cast<Eigen::Index>(c);
        bool complete = true, varies = false;
        for (const Run &run : runs)
          complete = complete && (run.experiment != experiment || std::isfinite(run.values(k)));
        for (const Run *run : base)
          varies = varies || run->values(k) != base.front()->values(k);
        if (complete && varies) {
          kept.push_back(k);
          left.push_back(list[c]);
        }
      }
      list = left;
      for (Run &run : runs)
        if (run.experiment == experiment)
          run.values = Eigen::VectorXd(run.values(kept));
    }
  }
};

} // namespace test

#endif
