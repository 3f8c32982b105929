#include <eunoe/discovery/stages/stages.h>

#include <algorithm>

namespace eunoe::discovery {

namespace {

Table flag_points(const StudyState &study, const NullDistribution &null_distribution)
{
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(study.value.size());
  for (const Replicate &run : study.base())
    mean += study.measured(run.values) / static_cast<double>(study.base().size());
  const Eigen::VectorXd deviation = (study.value - mean).cwiseQuotient(study.modes.deviations());
  const Eigen::VectorXd errors = standard_errors(study);
  Table rows = Table::array();
  for (std::size_t c = 0; c < study.data_points.size(); ++c) {
    const auto k = static_cast<Eigen::Index>(c);
    const double z = deviation(k) / errors(k), p = null_distribution.p_largest_deviation(z);
    rows.push_back({{"experiment", study.data_points[c].experiment},
                    {"observable", study.data_points[c].observable},
                    {"index", study.data_points[c].index},
                    {"deviation", z},
                    {"p", p},
                    {"flagged", p <= study.options.level}});
  }
  return rows;
}

} // namespace

void make_base_null_distribution(StudyState &study, Findings &findings)
{
  findings.base_null_distribution = make_null_distribution(study, {});
  study.misfit.tail = findings.base_null_distribution.tail;
}

Table stage_detect(StudyState &study, Findings &findings)
{
  make_base_null_distribution(study, findings);
  findings.statistics = test_statistics(study, {});
  findings.p_global = findings.base_null_distribution.p_joint(findings.statistics, false);

  Table table = {
      {"p", findings.p_global},
      {"distance", findings.statistics.distance},
      {"p of distance", findings.base_null_distribution.p_distance(findings.statistics.distance)},
      {"largest deviation of a cell", findings.statistics.largest_deviation},
      {"p of largest deviation",
       findings.base_null_distribution.p_largest_deviation(findings.statistics.largest_deviation)},
      {"degrees of freedom of the tail", findings.base_null_distribution.tail.degrees_of_freedom},
      {"inflation of distances", findings.base_null_distribution.tail.inflation}};
  table["cells"] = flag_points(study, findings.base_null_distribution);
  return table;
}

} // namespace eunoe::discovery
