// The insertion before the run: whether particles come, whether they have room, whether they move.

#include <eunoe/contact/contact_grid.h>
#include <eunoe/core/box_parts.h>
#include <eunoe/core/exact_sum.h>
#include <eunoe/core/gather.h>
#include <eunoe/core/sparse_exchange.h>

#include "insertion/obstacles.h"
#include "judgements.h"

#include <algorithm>
#include <array>
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
/// Most particles of an event and a rank whose pairs are looked at.
constexpr double most_looked_at = 2e6;
/// Most ids of a run.
constexpr double most_particles = 4294967294.;

struct Sphere
{
  Vec3 centre;
  double radius;
  std::uint64_t number; ///< in the event
};

/// The spheres of an event in a rank's part of the domain, and behind them those around that may
/// touch one of them.
struct Spheres
{
  std::vector<Sphere> all;
  std::size_t n_own = 0;
  double largest = 0.; ///< radius of those of all ranks (m)
};

/// Where about the particles of all ranks are, the same on every rank.
std::vector<Vec3> sample_of(const std::vector<NewParticle> &share, MPI_Comm comm)
{
  const std::size_t n = std::min(share.size(), BoxParts::sample_size(1));
  std::vector<Vec3> mine;
  for (std::size_t k = 0; k < n; ++k)
    mine.push_back(share[k * share.size() / n].position);
  return gather_all(mine, comm);
}

Spheres spheres_near(const std::vector<NewParticle> &share, const Domain &domain)
{
  MPI_Comm comm = domain.communicator();
  int rank, n_ranks;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &n_ranks);
  const BoxParts parts(domain.lower(), domain.upper(), domain.periods(), sample_of(share, comm),
                       n_ranks);
  Spheres found;
  std::uint64_t n = share.size(), end = 0;
  MPI_Scan(&n, &end, 1, MPI_UINT64_T, MPI_SUM, comm);
  std::map<int, std::vector<Sphere>> out;
  for (std::size_t k = 0; k < share.size(); ++k) {
    const NewParticle &p = share[k];
    out[parts.at(p.position)].push_back({p.position, p.radius, end - n + k});
    found.largest = std::max(found.largest, p.radius);
  }
  MPI_Allreduce(MPI_IN_PLACE, &found.largest, 1, MPI_DOUBLE, MPI_MAX, comm);
  const auto take = [&] {
    for (const auto &[from, list] : exchange_lists(std::move(out), comm))
      found.all.insert(found.all.end(), list.begin(), list.end());
    out.clear();
  };
  take();
  found.n_own = found.all.size();
  std::vector<int> near;
  for (const Sphere &sphere : found.all) {
    parts.near(sphere.centre, sphere.radius + found.largest, near);
    for (const int part : near)
      if (part != rank)
        out[part].push_back(sphere);
  }
  take();
  return found;
}

/// The deepest overlap that was found; of several the one of the first particle.
struct Overlap
{
  double share = 0.; ///< over the smaller radius
  std::uint64_t number = std::numeric_limits<std::uint64_t>::max();
  Vec3 where;

  void take(const double overlap, const double radius, const Sphere &sphere)
  {
    const double found = overlap / radius;
    if (found > share || (found == share && sphere.number < number)) {
      share = found;
      number = sphere.number;
      where = sphere.centre;
    }
  }

  /// Takes the deepest one of all ranks; collective.
  void reduce(MPI_Comm comm)
  {
    double deepest = share;
    MPI_Allreduce(MPI_IN_PLACE, &deepest, 1, MPI_DOUBLE, MPI_MAX, comm);
    std::uint64_t first = share == deepest ? number : std::numeric_limits<std::uint64_t>::max();
    MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPI_UINT64_T, MPI_MIN, comm);
    const double nowhere = -std::numeric_limits<double>::infinity();
    Vec3 place = share == deepest && number == first ? where : Vec3{nowhere, nowhere, nowhere};
    for (unsigned int d = 0; d < 3; ++d)
      MPI_Allreduce(MPI_IN_PLACE, &place[d], 1, MPI_DOUBLE, MPI_MAX, comm);
    share = deepest;
    number = first;
    where = place;
  }
};

/// Of pairs of particles.
Overlap overlap_of_pairs(const Spheres &spheres, const Domain &domain)
{
  Overlap deepest;
  if (spheres.all.empty())
    return deepest;
  const ContactGrid grid(domain.box_from_centre().lower, domain.box_from_centre().upper,
                         domain.periods(), 2. * spheres.largest);
  std::vector<std::uint64_t> keys;
  for (const Sphere &sphere : spheres.all)
    keys.push_back(grid.key(sphere.centre));
  std::vector<std::size_t> order(spheres.all.size());
  std::iota(order.begin(), order.end(), 0);
  const auto comes_first = [&](const std::size_t a, const std::size_t b) {
    return keys[a] != keys[b] ? keys[a] < keys[b] : spheres.all[a].number < spheres.all[b].number;
  };
  const auto first_ghost = order.begin() + static_cast<std::ptrdiff_t>(spheres.n_own);
  std::sort(order.begin(), first_ghost, comes_first);
  std::sort(first_ghost, order.end(), comes_first);
  // Only what the grid looks at.
  ParticleArrays rows;
  rows.n_owned = spheres.n_own;
  rows.n_ghosts = order.size() - spheres.n_own;
  for (const std::size_t k : order) {
    const Vec3 &x = spheres.all[k].centre;
    rows.position.push_back({x.x, x.y, x.z, spheres.all[k].radius});
    rows.reference.push_back(x);
    rows.id.push_back(static_cast<ParticleId>(spheres.all[k].number));
  }
  PairList pairs;
  pairs.clear(0);
  grid.find_pairs(rows, 0., pairs);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const Sphere &a = spheres.all[order[pairs.i[k]]], &b = spheres.all[order[pairs.j[k]]];
    const double distance = norm(domain.periods().shortest(a.centre - b.centre));
    deepest.take(a.radius + b.radius - distance, std::min(a.radius, b.radius),
                 a.number < b.number ? a : b);
  }
  return deepest;
}

/// Of particles with the walls and solids that act at the beginning.
Overlap overlap_with_solids(const Spheres &spheres, std::vector<Solid> solids)
{
  solids.erase(std::remove_if(solids.begin(), solids.end(),
                              [](const Solid &solid) { return !solid.is_active(0.); }),
               solids.end());
  for (Solid &solid : solids)
    solid.state = solid.motion->at(0.);
  std::vector<Vec3> centres;
  std::vector<double> radii;
  for (std::size_t k = 0; k < spheres.n_own; ++k) {
    centres.push_back(spheres.all[k].centre);
    radii.push_back(spheres.all[k].radius);
  }
  Obstacles obstacles(std::move(solids));
  obstacles.search(centres, radii, 0, centres.size(), 0.);
  Overlap deepest;
  for (std::size_t k = 0; k < centres.size(); ++k) {
    double overlap = 0.;
    obstacles.push(k, centres[k], radii[k], overlap);
    deepest.take(overlap, radii[k], spheres.all[k]);
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

/// How far the particles of an event move in a time, by the speed of the slowest and by gravity.
/// @param event this rank's share
Vec3 way_of(const std::vector<NewParticle> &event, const Vec3 &gravity, const double time,
            MPI_Comm comm)
{
  double slowest = std::numeric_limits<double>::infinity();
  std::array<ExactSum, 3> sums;
  for (const NewParticle &particle : event) {
    slowest = std::min(slowest, norm(particle.velocity));
    for (unsigned int d = 0; d < 3; ++d)
      sums[d] += particle.velocity[d];
  }
  MPI_Allreduce(MPI_IN_PLACE, &slowest, 1, MPI_DOUBLE, MPI_MIN, comm);
  Vec3 sum;
  for (unsigned int d = 0; d < 3; ++d) {
    sums[d].reduce(comm);
    sum[d] = sums[d].value();
  }
  const Vec3 by_gravity = 0.5 * time * time * gravity;
  return slowest > 0. && norm(sum) > 0. ? slowest * time / norm(sum) * sum + by_gravity
                                        : by_gravity;
}

/// Distance from the first to the last centre of an event in a direction (m).
/// @param event this rank's share
double extent_along(const Vec3 &direction, const std::vector<NewParticle> &event, MPI_Comm comm)
{
  // The lowest as the largest of the negatives, so that one call serves both.
  const double none = -std::numeric_limits<double>::infinity();
  double ends[2] = {none, none};
  for (const NewParticle &particle : event) {
    const double at = dot(direction, particle.position);
    ends[0] = std::max(ends[0], -at);
    ends[1] = std::max(ends[1], at);
  }
  MPI_Allreduce(MPI_IN_PLACE, ends, 2, MPI_DOUBLE, MPI_MAX, comm);
  return ends[0] + ends[1];
}

/// Whether the particles of one event are out of the way before the next comes into the same box.
/// All of an event move alike, so that its last particle is out of the way when they have moved by
/// its length.
/// @param event this rank's share of one event
void judge_interval(const Parameters &parameters, std::vector<NewParticle> event,
                    const double largest_diameter, const Domain &domain, Problems &problems)
{
  MPI_Comm comm = domain.communicator();
  leave_out_what_is_outside(event, domain);
  const double time = parameters.insertion.frequency * parameters.control.time_step;
  const Vec3 path = way_of(event, parameters.physics.gravity, time, comm);
  const double way = norm(path);
  const double length = largest_diameter + (way > 0. ? extent_along(path / way, event, comm) : 0.);
  if (way < length)
    problems.warn(insertion_info + " / entry 'insertion frequency':",
                  "between two events, the particles move by no more than " + format(way) +
                      " m, while an event is " + format(length) +
                      " m long in that direction, so that those of the next come to lie in them.",
                  "Raise the frequency, which is a number of steps, or the initial velocity, or "
                  "insert fewer at a time.");
}

/// Whether particles come, and as many as the types have.
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
  if (const double most = parameters.physics.types[0].number; insertion.is_cut_short())
    problems.warn(number,
                  "is " + format_whole(most) + ", so that only the first " +
                      format_count(most, "particle", "particles") + " of the files come.",
                  parameters.insertion.frequency > 0 ? "Give the number of all of them."
                                                     : "Give 0 for all of them.");
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
  else if (coming < wanted && parameters.insertion.frequency == 0)
    problems.warn(insertion_info + " / entry 'insertion frequency':",
                  "is 0, so that the particles come once: " + format_whole(coming) + " of " +
                      format_whole(wanted) + ".",
                  "Give the number of steps after which they come again, or correct 'number of "
                  "particles'.");
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
    judge_interval(parameters, events[0], insertion.largest_diameter(), domain, problems);
  Overlap of_pairs, with_solids;
  for (std::size_t e = 0; e < events.size(); ++e) {
    std::vector<NewParticle> inside;
    if (!insertion.gives_particles()) {
      inside = events[e];
      const std::size_t n_outside = leave_out_what_is_outside(inside, domain);
      judge_outside(n_outside, inside.size(), domain, problems);
    }
    const std::vector<NewParticle> &event = insertion.gives_particles() ? events[e] : inside;
    judge_speed(event, parameters.control.time_step, domain.communicator(), problems);
    std::uint64_t n = event.size();
    MPI_Allreduce(MPI_IN_PLACE, &n, 1, MPI_UINT64_T, MPI_MAX, domain.communicator());
    if (static_cast<double>(n) > most_looked_at)
      continue;
    const Spheres spheres = spheres_near(event, domain);
    Overlap pairs = overlap_of_pairs(spheres, domain);
    pairs.reduce(domain.communicator());
    of_pairs = pairs.share > of_pairs.share ? pairs : of_pairs;
    // Solids may have moved until the events that follow.
    if (e == 0) {
      with_solids = overlap_with_solids(spheres, solids);
      with_solids.reduce(domain.communicator());
    }
  }
  judge_overlap(of_pairs, "a particle overlaps another", parameters.faults, problems);
  judge_overlap(with_solids, "a particle overlaps a wall or solid", parameters.faults, problems);
}

} // namespace eunoe
