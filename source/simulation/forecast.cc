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

/// When particles of each type count as at rest.
void describe_sleep(const Parameters &parameters, const std::vector<DiameterRange> &diameters,
                    Forecast &forecast)
{
  const double gravity = norm(parameters.physics.gravity);
  const RestCriterion rest(parameters.sparse_contacts, gravity, 1.);
  for (const auto &[type, smallest, largest] : diameters) {
    const double radius = 0.5 * smallest, speed = std::sqrt(rest.speed_square(radius));
    // Around the top of a path a particle is slower than that, and stays within a displacement of
    // the top, on the way up and down.
    const double at_top =
        2. * std::min(speed / gravity, std::sqrt(2. * rest.displacement(radius) / gravity));
    if (gravity > 0. && rest.steps(radius) < at_top)
      forecast.problems.warn("subsection 'model parameters' / subsection 'adaptive sparse "
                             "contacts' / 'rest time':",
                             "is so short that a particle falls asleep in the air at the top of "
                             "its path, and stays there.",
                             "Give more than " + format(at_top) + " s, or 'auto'.");
    forecast.facts.push_back("Sleep: a particle of type " + std::to_string(type) + " of " +
                             format(1e6 * smallest) + " um is at rest when it was slower than " +
                             format(speed) + " m/s and has moved by less than " +
                             format(rest.displacement(radius)) + " m for " +
                             format(rest.steps(radius)) + " s");
  }
}

/// Diameters of each type that has particles: those of the particles that are given one by one,
/// else those of the types.
/// @param are_given whether the input gives the particles one by one
std::vector<DiameterRange> find_diameters(const Parameters &parameters, const bool are_given,
                                          const std::vector<std::vector<NewParticle>> &events,
                                          MPI_Comm comm)
{
  std::vector<DiameterRange> diameters;
  if (are_given) {
    // The largest of the negatives, so that one call serves both.
    const std::size_t n_types = parameters.physics.types.size();
    std::vector<double> extremes(2 * n_types, -std::numeric_limits<double>::max());
    for (const std::vector<NewParticle> &event : events)
      for (const NewParticle &particle : event) {
        double *const of_type = &extremes[2 * static_cast<std::size_t>(particle.type)];
        of_type[0] = std::max(of_type[0], -2. * particle.radius);
        of_type[1] = std::max(of_type[1], 2. * particle.radius);
      }
    MPI_Allreduce(MPI_IN_PLACE, extremes.data(), static_cast<int>(extremes.size()), MPI_DOUBLE,
                  MPI_MAX, comm);
    for (std::size_t t = 0; t < n_types; ++t)
      if (extremes[2 * t + 1] > 0.)
        diameters.push_back({t, -extremes[2 * t], extremes[2 * t + 1]});
    if (!diameters.empty())
      return diameters;
  }
  for (const std::size_t t : parameters.physics.types_in_use()) {
    const auto sizes = parameters.physics.types[t].sizes.make();
    diameters.push_back({t, sizes->smallest(), sizes->largest()});
  }
  return diameters;
}

/// Largest speed of a wall or of a solid of the process, as far as it can be known (m/s).
double fastest_wall(const Parameters &parameters, const Domain &domain)
{
  const double dt = parameters.control.time_step;
  double fastest = parameters.process() != nullptr ? parameters.process()->fastest_solid() : 0.;
  for (const Solid &wall : domain.walls())
    fastest = std::max(fastest, displacement(wall, wall.motion->at(0.), wall.motion->at(dt)) / dt);
  return fastest;
}

} // namespace

Forecast Simulation::foresee(const bool writes) const
{
  Forecast forecast;
  std::vector<std::vector<NewParticle>> events;
  const Insertion *const insertion = inserter.get_method();
  const bool are_given = insertion != nullptr && insertion->gives_particles();
  const bool is_continued = checkpoints.opened() != nullptr;
  if (insertion != nullptr && (!is_continued || are_given))
    events = insertion->known_events();
  const std::vector<DiameterRange> diameters =
      find_diameters(parameters, are_given, events, communicator());
  judge_time_step(parameters, diameters, forecast);
  forecast.facts.push_back("Domain: " + describe(Box{domain.lower(), domain.upper()}) + ", " +
                           format_count(solids.list().size(), "solid or wall", "solids and walls") +
                           ", " + format_count(domain.outlets().size(), "outlet", "outlets"));
  const Vec3 &g = parameters.physics.gravity;
  forecast.facts.push_back("Gravity: (" + format(g.x) + ", " + format(g.y) + ", " + format(g.z) +
                           ") m/s2" + (norm_square(g) > 0. ? "" : ", so that nothing falls"));
  if (sleeper.is_enabled())
    describe_sleep(parameters, diameters, forecast);
  DiameterRange of_all = {0, std::numeric_limits<double>::max(), 0.};
  for (const DiameterRange &range : diameters) {
    of_all.smallest = std::min(of_all.smallest, range.smallest);
    of_all.largest = std::max(of_all.largest, range.largest);
  }
  const double of_walls = fastest_wall(parameters, domain);
  const double fastest = judge_solids(parameters, solids.list(), domain, of_all, forecast);
  judge_jump(of_walls, parameters, 0.5 * of_all.smallest, "", "", forecast.problems);
  judge_searches(std::max(fastest, of_walls), criterion.allowed_displacement(), clock.time_step(),
                 forecast);
  if (tuner)
    forecast.facts.push_back("Neighborhood threshold: " + format(system.neighborhood_threshold()) +
                             " at first, then as the flow needs it");
  if (insertion != nullptr && !is_continued)
    judge_insertion(parameters, *insertion, events, solids.list(), domain, forecast);
  forecast.facts.insert(forecast.facts.end(), parameters.lethe_notes.begin(),
                        parameters.lethe_notes.end());
  for (const Problem &doubt : domain.doubts())
    forecast.problems.warn(doubt.where, doubt.what, doubt.mend);
  if (parameters.process_name == "none" && parameters.control.n_steps() == 0)
    forecast.problems.warn("subsection 'simulation control':", "no step is taken.",
                           "Set 'time end' or 'iteration end'.");
  const RunEstimate cost = estimate();
  judge_resources(parameters, cost, communicator(), forecast);
  if (writes)
    judge_output(parameters, cost, system.fields().n_components(), communicator(), forecast);
  return forecast;
}

} // namespace eunoe
