#include <eunoe/discovery/stages/stages.h>

#include <algorithm>

namespace eunoe::discovery {

namespace {

Table flag_cells(const Workbench &bench, const Reference &reference)
{
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(bench.value.size());
  for (const RunSet &run : bench.base())
    mean += bench.measured(run.values) / static_cast<double>(bench.base().size());
  const Eigen::VectorXd deviation = (bench.value - mean).cwiseQuotient(bench.modes.deviations());
  const Eigen::VectorXd errors = cell_errors(bench);
  Table rows = Table::array();
  for (std::size_t c = 0; c < bench.cells.size(); ++c) {
    const auto k = static_cast<Eigen::Index>(c);
    const double z = deviation(k) / errors(k), p = reference.p_cell(z);
    rows.push_back({{"experiment", bench.cells[c].experiment},
                    {"observable", bench.cells[c].observable},
                    {"index", bench.cells[c].index},
                    {"deviation", z},
                    {"p", p},
                    {"flagged", p <= bench.options.level}});
  }
  return rows;
}

} // namespace

void settle_base_reference(Workbench &bench, Findings &findings)
{
  findings.base_reference = make_reference(bench, {});
  bench.misfit.tail = findings.base_reference.tail;
}

Table stage_detect(Workbench &bench, Findings &findings)
{
  settle_base_reference(bench, findings);
  findings.evidence = evidence_against_base(bench, {});
  findings.p_global = findings.base_reference.p_joint(findings.evidence, false);

  Table table = {
      {"p", findings.p_global},
      {"distance", findings.evidence.distance},
      {"p of distance", findings.base_reference.p_distance(findings.evidence.distance)},
      {"largest deviation of a cell", findings.evidence.cell},
      {"p of largest deviation", findings.base_reference.p_cell(findings.evidence.cell)},
      {"degrees of freedom of the tail", findings.base_reference.tail.degrees_of_freedom},
      {"inflation of distances", findings.base_reference.tail.inflation}};
  table["cells"] = flag_cells(bench, findings.base_reference);
  return table;
}

} // namespace eunoe::discovery
