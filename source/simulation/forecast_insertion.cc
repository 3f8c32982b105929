// The insertion before the run: whether particles come, whether they have room, whether they move.

#include <eunoe/contact/contact_grid.h>
#include <eunoe/core/gather.h>

#include "insertion/obstacles.h"
#include "judgements.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace eunoe {

namespace {

const std::string insertion_info = "subsection 'insertion info'";

/// Overlap over the radius from which particles are shot off.
constexpr double doubtful_overlap = 0.1;
/// Share of its radius that a particle may go in a time step.
constexpr double largest_way = 0.1;
/// Most particles of an event whose pairs are looked at.
constexpr double most_looked_at = 2e6;
/// Most ids of a run.
constexpr double most_particles = 4294967294.;

struct Sphere
{
  Vec3 centre;
  double radius;
};

/// All particles of an event, the same on every rank.
std::vector<Sphere> spheres_of_all(const std::vector<NewParticle> &share, MPI_Comm comm)
{
  std::vector<Sphere> mine;
  for (const NewParticle &p : share)
    mine.push_back({p.position, p.radius});
  return gather_all(mine, comm);
}

/// The deepest overlap that was found.
struct Overlap
{
  double share = 0.; ///< over the smaller radius
  Vec3 where;

  void take(const double overlap, const double radius, const Vec3 &x)
  {
    if (overlap > share * radius) {
      share = overlap / radius;
      where = x;
    }
  }
};

/// Of pairs of particles.
Overlap overlap_of_pairs(const std::vector<Sphere> &spheres, const Domain &domain)
{
  Overlap deepest;
  if (spheres.empty())
    return deepest;
  double largest = 0.;
  for (const Sphere &sphere : spheres)
    largest = std::max(largest, sphere.radius);
  const ContactGrid grid(domain.box_from_centre().lower, domain.box_from_centre().upper,
                         domain.periods(), 2. * largest);
  std::vector<std::uint64_t> keys;
  for (const Sphere &sphere : spheres)
    keys.push_back(grid.key(sphere.centre));
  std::vector<std::size_t> order(spheres.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return keys[a] != keys[b] ? keys[a] < keys[b] : a < b;
  });
  ParticleArrays rows;
  rows.resize(spheres.size(), 0, 0);
  for (std::size_t row = 0; row < order.size(); ++row) {
    const auto &[centre, radius] = spheres[order[row]];
    rows.position[row] = {centre.x, centre.y, centre.z, radius};
    rows.id[row] = static_cast<ParticleId>(order[row]);
  }
  PairList pairs;
  pairs.clear(0);
  grid.find_pairs(rows, 0., pairs);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const std::int32_t i = pairs.i[k], j = pairs.j[k];
    const Vec3 a = rows.position[i].vec(), b = rows.position[j].vec();
    const double distance = norm(domain.periods().shortest(a - b));
    const double radius_a = rows.radius(i), radius_b = rows.radius(j);
    deepest.take(radius_a + radius_b - distance, std::min(radius_a, radius_b), a);
  }
  return deepest;
}

/// Of particles with the walls and solids that act at the beginning.
Overlap overlap_with_solids(const std::vector<Sphere> &spheres, std::vector<Solid> solids)
{
  solids.erase(std::remove_if(solids.begin(), solids.end(),
                              [](const Solid &solid) { return !solid.is_active(0.); }),
               solids.end());
  for (Solid &solid : solids)
    solid.state = solid.motion->at(0.);
  std::vector<Vec3> centres;
  std::vector<double> radii;
  for (const Sphere &sphere : spheres) {
    centres.push_back(sphere.centre);
    radii.push_back(sphere.radius);
  }
  Obstacles obstacles(std::move(solids));
  obstacles.search(centres, radii, 0, centres.size(), 0.);
  Overlap deepest;
  for (std::size_t k = 0; k < centres.size(); ++k) {
    double overlap = 0.;
    obstacles.push(k, centres[k], radii[k], overlap);
    deepest.take(overlap, radii[k], centres[k]);
  }
  return deepest;
}

void judge_overlap(const Overlap &overlap, const std::string &what, const FaultParameters &faults,
                   Problems &problems)
{
  if (overlap.share <= doubtful_overlap)
    return;
  const Vec3 &x = overlap.where;
  const std::string text = what + " by " + format(overlap.share) +
                           " of its radius where it is inserted, at (" + format(x.x) + ", " +
                           format(x.y) + ", " + format(x.z) + ") m, and would be shot off.";
  const std::string mend = "Correct its place or its diameter.";
  const double largest_allowed = faults.excessive_overlap == "stop" ? faults.largest_overlap : 1.;
  if (faults.largest_overlap > 0. && overlap.share > largest_allowed)
    problems.add(insertion_info + ":", text, mend);
  else
    problems.warn(insertion_info + ":", text, mend);
}

/// Whether the particles of one event are out of the way before the next comes into the same box.
/// @param event this rank's share of one event
void judge_interval(const Parameters &parameters, const std::vector<NewParticle> &event,
                    const double largest_diameter, MPI_Comm comm, Problems &problems)
{
  double slowest = std::numeric_limits<double>::infinity();
  for (const NewParticle &particle : event)
    slowest = std::min(slowest, norm(particle.velocity));
  MPI_Allreduce(MPI_IN_PLACE, &slowest, 1, MPI_DOUBLE, MPI_MIN, comm);
  const double time = parameters.insertion.frequency * parameters.control.time_step;
  const double way = slowest * time + 0.5 * norm(parameters.physics.gravity) * time * time;
  if (way < largest_diameter)
    problems.warn(insertion_info + " / entry 'insertion frequency':",
                  "between two events, the particles move by no more than " + format(way) +
                      " m, less than their diameter, so that those of the next come to lie in "
                      "them.",
                  "Raise the frequency, which is a number of steps, or the initial velocity.");
}

void judge_number(const Parameters &parameters, const Insertion &insertion, Problems &problems)
{
  double wanted = 0.;
  for (const ParticleType &type : parameters.physics.types)
    wanted += type.number;
  const std::size_t n_events = number_of_events(parameters);
  const auto coming = static_cast<double>(insertion.supply(n_events));
  const bool counts = !insertion.gives_particles();
  const std::string number = "subsection 'lagrangian physical properties' / subsection 'particle "
                             "type 0' / entry 'number of particles':";
  if (coming > most_particles)
    problems.add(insertion_info + ":", format(coming) + " particles would come into the run.",
                 "At most " + format(most_particles) + " are possible.");
  else if (coming == 0. && parameters.solids.objects.empty())
    problems.add(counts ? number : insertion_info + ":",
                 "no particles come into the run, and there are no solids to be seen.",
                 "Give a number of particles and an 'insertion info', or name a process.");
  else if (coming == 0.)
    problems.warn(counts ? number : insertion_info + ":", "no particles come into the run.",
                  "Give a number of particles and an 'insertion info'.");
  else if (counts && coming < wanted)
    problems.warn(insertion_info + ":",
                  "only " + format_whole(coming) + " of " + format_whole(wanted) +
                      " particles come until the run ends, in " +
                      format_count(static_cast<double>(n_events), "event", "events") + ".",
                  "Let the run last longer, lower 'insertion frequency', or raise 'inserted number "
                  "of particles at each time step'.");
}

/// @param n_outside of this rank's share of an event, likewise @p n_inside
void judge_outside(const std::uint64_t n_outside, const std::uint64_t n_inside,
                   const Domain &domain, Problems &problems)
{
  std::uint64_t n[2] = {n_outside, n_inside};
  MPI_Allreduce(MPI_IN_PLACE, n, 2, MPI_UINT64_T, MPI_SUM, domain.communicator());
  const std::string mend = "Enlarge the mesh, or correct the places.";
  const auto of_all = static_cast<double>(n[0]) / static_cast<double>(n[0] + n[1]);
  if (n[0] > 0 && n[1] == 0)
    problems.add(insertion_info + ":", "all particles are to be inserted outside the mesh.", mend);
  else if (n[0] > 0)
    problems.warn(insertion_info + ":",
                  format_roughly(100. * of_all) +
                      " % of the particles are to be inserted outside the mesh and will be left "
                      "out.",
                  mend);
}

void judge_speed(const std::vector<NewParticle> &event, const double time_step, MPI_Comm comm,
                 Problems &problems)
{
  double share = 0.;
  for (const NewParticle &particle : event)
    share = std::max(share, norm(particle.velocity) * time_step / particle.radius);
  MPI_Allreduce(MPI_IN_PLACE, &share, 1, MPI_DOUBLE, MPI_MAX, comm);
  if (share > largest_way)
    problems.warn(insertion_info + ":",
                  "a particle is inserted so fast that it moves by " + format(share) +
                      " of its radius in a time step and would jump into others.",
                  "Lower its velocity or the time step.");
}

} // namespace

void judge_insertion(const Parameters &parameters, const Insertion &insertion,
                     const std::vector<std::vector<NewParticle>> &events,
                     const std::vector<Solid> &solids, const Domain &domain, Forecast &forecast)
{
  Problems &problems = forecast.problems;
  judge_number(parameters, insertion, problems);
  if (insertion.repeats_places() && !events.empty() && !parameters.insertion.removes &&
      number_of_events(parameters) > 1 && insertion.supply(2) > insertion.supply(1))
    judge_interval(parameters, events[0], insertion.largest_diameter(), domain.communicator(),
                   problems);
  Overlap of_pairs, with_solids;
  for (std::size_t e = 0; e < events.size(); ++e) {
    std::vector<NewParticle> event = events[e];
    if (!insertion.gives_particles())
      judge_outside(leave_out_what_is_outside(event, domain), event.size(), domain, problems);
    judge_speed(event, parameters.control.time_step, domain.communicator(), problems);
    std::uint64_t n = event.size();
    MPI_Allreduce(MPI_IN_PLACE, &n, 1, MPI_UINT64_T, MPI_SUM, domain.communicator());
    if (static_cast<double>(n) > most_looked_at)
      continue;
    const std::vector<Sphere> spheres = spheres_of_all(event, domain.communicator());
    const Overlap pairs = overlap_of_pairs(spheres, domain);
    of_pairs = pairs.share > of_pairs.share ? pairs : of_pairs;
    // Solids may have moved until the events that follow.
    if (e == 0)
      with_solids = overlap_with_solids(spheres, solids);
  }
  judge_overlap(of_pairs, "a particle overlaps another", parameters.faults, problems);
  judge_overlap(with_solids, "a particle overlaps a wall or solid", parameters.faults, problems);
}

} // namespace eunoe
