#ifndef eunoe_tests_discovery_recorded_cases_h
#define eunoe_tests_discovery_recorded_cases_h

// Studies on a simulator of recorded simulations: of truths at any amplitude, and of data that are
// recorded simulations themselves, which are then left out of the simulator.

#include "recorded.h"
#include "suite.h"

namespace test {

struct RecordedStudy
{
  SuiteCase one;
  Discovery discovery;
};

/// A truth of any strength, and data that are drawn like the simulator's runs, with other seeds.
struct DrawnCase
{
  DrawnCase(const RecordedTable &table, const StudyKind &kind, std::uint32_t seed)
      : simulator(table, seed)
  {
    RandomStream random(seed, 98);
    one = draw_case(simulator, kind, table.fit, seed, random);
    repeats = 3 + static_cast<unsigned int>(random.index(4));
    instrument = 0.4 * random.uniform();
    data = simulator.measure(table.fit, table.held_out, one.truth, repeats, instrument, seed);
  }

  RecordedSimulator simulator;
  SuiteCase one;
  unsigned int repeats = 1;
  double instrument = 0.;
  MeasuredData data;
};

inline RecordedStudy interpolated_study(const RecordedTable &table, const StudyKind &kind,
                                        std::uint32_t seed, const StudyOptions &options)
{
  DrawnCase drawn(table, kind, seed);
  return {drawn.one, study_of(drawn.one, drawn.simulator, drawn.data, options)};
}

/// Means and deviations of recorded runs of one experiment as data.
inline std::vector<MeasuredPoint> as_data(const RecordedTable &table, const std::string &experiment,
                                          const std::string &factor, double amplitude,
                                          const std::set<std::uint32_t> &seeds)
{
  std::vector<const RecordedTable::Run *> runs;
  for (const RecordedTable::Run *run : table.of(experiment, factor))
    if (run->amplitude == amplitude && (seeds.empty() || seeds.count(run->seed) > 0))
      runs.push_back(run);
  std::vector<MeasuredPoint> data;
  for (std::size_t c = 0; c < table.points.at(experiment).size(); ++c) {
    const auto k = static_cast<Eigen::Index>(c);
    const auto n = static_cast<double>(runs.size());
    double mean = 0., square = 0.;
    for (const auto *run : runs)
      mean += run->values(k) / n;
    for (const auto *run : runs)
      square += std::pow(run->values(k) - mean, 2);
    data.push_back({table.points.at(experiment)[c], mean, std::sqrt(square / (n - 1.)),
                    static_cast<unsigned int>(runs.size())});
  }
  return data;
}

/// A study whose data are simulations: runs of the base model with some seeds, or of one factor at
/// one amplitude, which the simulator interpolates from the others.
inline RecordedStudy simulated_study(const RecordedTable &table, const LeftOut &left_out,
                                     std::uint32_t seed, const StudyOptions &options)
{
  RecordedSimulator simulator(table, seed, left_out);
  SuiteCase one;
  one.seed = seed;
  one.kind = left_out.factor.empty() ? "none" : "single";
  const std::string factor = left_out.factor.empty() ? "base" : left_out.factor;
  if (!left_out.factor.empty()) {
    // The strength of the factor, from all of its runs.
    const double strength =
        RecordedSimulator(table, seed).strength({{left_out.factor, left_out.amplitude}}, table.fit);
    const bool below = left_out.amplitude < simulator.factor(left_out.factor).null_value;
    one.strengths[left_out.factor] = below ? -strength : strength;
    one.truth[left_out.factor] = left_out.amplitude;
  }
  MeasuredData data;
  for (const std::string &e : table.fit)
    for (const MeasuredPoint &point :
         as_data(table, e, factor, left_out.amplitude, left_out.base_seeds))
      data.fit.push_back(point);
  for (const std::string &e : table.held_out)
    for (const MeasuredPoint &point :
         as_data(table, e, factor, left_out.amplitude, left_out.base_seeds))
      data.held_out.push_back(point);
  return {one, study_of(one, simulator, data, options)};
}

/// All data that the table has for simulated studies: groups of four runs of the base model, and
/// the amplitudes of effects that lie between two other amplitudes or between one and zero.
inline std::vector<LeftOut> simulated_data(const RecordedTable &table)
{
  std::vector<LeftOut> result;
  constexpr std::uint32_t repeats = 4;
  const auto base = table.of(table.fit.front(), "base");
  for (std::size_t k = 0; k + repeats <= base.size(); k += repeats) {
    result.push_back({});
    for (std::size_t r = k; r < k + repeats; ++r)
      result.back().base_seeds.insert(base[r]->seed);
  }
  for (const Factor &factor : table.factors) {
    if (factor.kind != Factor::Kind::effect)
      continue;
    std::set<double> amplitudes;
    for (const RecordedTable::Run *run : table.of(table.fit.front(), factor.name))
      amplitudes.insert(run->amplitude);
    for (const double amplitude : amplitudes) {
      const bool is_last = amplitude > factor.null_value ? amplitude == *amplitudes.rbegin()
                                                         : amplitude == *amplitudes.begin();
      if (!is_last)
        result.push_back({{}, factor.name, amplitude});
    }
  }
  return result;
}

} // namespace test

#endif
