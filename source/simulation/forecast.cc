// What can be said of a run before its first step.

#include "judgements.h"

#include <algorithm>
#include <limits>

namespace eunoe {

void Forecast::print(Log &log) const
{
  for (const std::string &fact : facts)
    log.line(fact);
  for (const Problem &doubt : problems.warnings())
    log.warning(doubt.text());
}

std::string count_of_warnings(const std::size_t n)
{
  return n == 1 ? "There is 1 warning" : "There are " + std::to_string(n) + " warnings";
}

std::string describe(const Box &box)
{
  const auto text = [](const Vec3 &x) {
    return "(" + format(x.x) + ", " + format(x.y) + ", " + format(x.z) + ")";
  };
  return text(box.lower) + " to " + text(box.upper) + " m";
}

std::size_t number_of_events(const Parameters &parameters)
{
  const unsigned int frequency = parameters.insertion.frequency;
  return frequency == 0 ? 1 : 1 + parameters.control.n_steps() / frequency;
}

namespace {

/// Diameters of each type: those of the particles that are given one by one, else those of the
/// types.
std::vector<DiameterRange> find_diameters(const Parameters &parameters,
                                          const std::vector<std::vector<NewParticle>> &events,
                                          MPI_Comm comm)
{
  const InsertionParameters &insertion = parameters.insertion;
  const bool are_given = parameters.process_name == "none" &&
                         (insertion.method == "list" || insertion.method == "file");
  if (are_given) {
    // The largest of the negatives, so that one call serves both.
    double extremes[2] = {-std::numeric_limits<double>::max(), 0.};
    for (const std::vector<NewParticle> &event : events)
      for (const NewParticle &particle : event) {
        extremes[0] = std::max(extremes[0], -2. * particle.radius);
        extremes[1] = std::max(extremes[1], 2. * particle.radius);
      }
    MPI_Allreduce(MPI_IN_PLACE, extremes, 2, MPI_DOUBLE, MPI_MAX, comm);
    if (extremes[1] > 0.)
      return {{-extremes[0], extremes[1]}};
  }
  std::vector<DiameterRange> diameters;
  for (const ParticleType &type : parameters.physics.types) {
    const auto sizes = type.sizes.make();
    diameters.emplace_back(sizes->smallest(), sizes->largest());
  }
  return diameters;
}

} // namespace

Forecast Simulation::foresee(const bool writes) const
{
  Forecast forecast;
  std::vector<std::vector<NewParticle>> events;
  if (insertion && !checkpoint)
    events = insertion->known_events();
  judge_time_step(parameters, find_diameters(parameters, events, comm), forecast);
  forecast.facts.push_back("Domain: " + describe(Box{domain.lower(), domain.upper()}) + ", " +
                           std::to_string(domain.n_cells()) + " cells of at least " +
                           format(1e6 * domain.smallest_cell_width()) + " um, " +
                           std::to_string(solids.size()) + " solids and walls, " +
                           std::to_string(domain.outlets().size()) + " outlets");
  const double fastest = judge_solids(parameters, solids, domain, forecast);
  judge_searches(std::max(fastest, fastest_solid()), allowed_displacement,
                 parameters.control.time_step, forecast);
  if (insertion && !checkpoint)
    judge_insertion(parameters, *insertion, events, solids, domain, forecast);
  const RunEstimate cost = estimate();
  judge_resources(parameters, cost, domain.n_cells(), comm, forecast);
  if (writes)
    judge_output(parameters, cost, Process::n_components(fields), comm, forecast);
  return forecast;
}

} // namespace eunoe
