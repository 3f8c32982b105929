#include <eunoe/core/declare.h>
#include <eunoe/engine/particle_guard.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace eunoe {

namespace {

bool is_finite(const Vec3 &v)
{
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

std::string format(const Vec3 &v)
{
  return "(" + eunoe::format(v.x) + ", " + eunoe::format(v.y) + ", " + eunoe::format(v.z) + ")";
}

} // namespace

void FaultParameters::declare(dealii::ParameterHandler &prm)
{
  declare::enter(prm, "model parameters");
  declare::choice(prm, "lost particles", lost_particles, "stop|remove|ignore",
                  "What happens when a particle has left the mesh other than through an outlet, "
                  "or has a position that is not a number: the run stops, or the particle is "
                  "removed and counted, with or without a warning.");
  declare::not_negative(
      prm, "largest overlap", largest_overlap,
      "Overlap over the radius of the smaller particle above which no contact law holds; 0: "
      "none.");
  declare::choice(prm, "excessive overlap", excessive_overlap, "warn|stop",
                  "What happens beyond the 'largest overlap': the run goes on, with a warning and "
                  "the number of particles in the summary, or it stops.");
  declare::leave(prm);
}

ParticleGuard::ParticleGuard(const FaultParameters &parameters, const Domain &domain,
                             const Materials &materials, const NormalLaws &laws,
                             const double longest_way, const double dt)
    : parameters(parameters), domain(domain), materials(materials),
      young_modulus(materials.table(effective_young_modulus)), laws(laws), longest_way(longest_way),
      dt(dt)
{
}

Faults ParticleGuard::inspect(const ParticleArrays &p, const PairList &pairs,
                              const SolidContacts &solid_contacts,
                              const std::vector<Solid> &solids) const
{
  Faults faults;
  for (std::size_t row = 0; row < p.n_owned; ++row) {
    const Vec3 x = p.position[row].vec();
    if (!is_finite(x) || !is_finite(p.velocity[row].vec()) || !is_finite(p.spin[row].vec())) {
      faults.lost.push_back({row, "is not a number any more."});
      continue;
    }
    const double way = norm(x - p.reference[row]) - dt * norm(p.velocity[row].vec());
    if (!domain.contains(x)) {
      if (domain.passed_outlet(p.reference[row], x) < 0)
        faults.lost.push_back({row, "has left the mesh, though not through an outlet."});
    } else if (way > longest_way)
      faults.fast.push_back({row, "has moved by " + eunoe::format(way) +
                                      " m without a search for contacts, and only " +
                                      eunoe::format(longest_way) + " m is safe."});
  }
  find_overlaps(p, pairs, faults);
  find_overlaps(p, solid_contacts, solids, faults);
  return faults;
}

void ParticleGuard::find_overlaps(const ParticleArrays &p, const PairList &pairs,
                                  Faults &faults) const
{
  const PeriodicBox &box = domain.periods();
  const double largest = parameters.largest_overlap;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const auto i = static_cast<std::size_t>(pairs.i[k]), j = static_cast<std::size_t>(pairs.j[k]);
    // If i is a ghost, its owner checks the pair.
    if (pairs.record[k] == ContactMemory::none || i >= p.n_owned)
      continue;
    const double ri = p.radius(i), rj = p.radius(j);
    const double overlap = ri + rj - norm(box.shortest(p.position[j].vec() - p.position[i].vec()));
    if (overlap <= 0.)
      continue;
    const double mi = p.mass(i), mj = p.mass(j);
    const double mass = mi * mj / (mi + mj);
    const double stiffness =
        normal_stiffness(laws.pairs_are_linear, young_modulus[materials.kind(p.type[i], p.type[j])],
                         ri * rj / (ri + rj), mass, overlap);
    faults.stiffest = std::max(faults.stiffest, stiffness / mass);
    if (largest > 0. && overlap > largest * std::min(ri, rj))
      faults.squeezed.push_back({i, "overlaps particle " + std::to_string(p.id[j]) + " by " +
                                        eunoe::format(overlap) +
                                        " m, more than the 'largest overlap'."});
  }
}

void ParticleGuard::find_overlaps(const ParticleArrays &p, const SolidContacts &solid_contacts,
                                  const std::vector<Solid> &solids, Faults &faults) const
{
  const double largest = parameters.largest_overlap;
  for (const SolidContacts::Candidate &candidate : solid_contacts.get_candidates()) {
    if (candidate.n_living == 0)
      continue;
    const Vec3 x = p.position[candidate.particle].vec();
    const double radius = p.radius(candidate.particle);
    const Solid &solid = solids[candidate.solid];
    const double depth = solid_contacts.deepest_overlap(candidate, solid, x, radius);
    if (depth <= 0.)
      continue;
    const int kind = materials.kind(p.type[candidate.particle], solid.material);
    faults.stiffest =
        std::max(faults.stiffest, normal_stiffness(laws.walls_are_linear, young_modulus[kind],
                                                   radius, p.mass(candidate.particle), depth) /
                                      p.mass(candidate.particle));
    if (largest > 0. && depth > largest * radius)
      faults.squeezed.push_back({static_cast<std::size_t>(candidate.particle),
                                 "overlaps '" + solid.name + "' by " + eunoe::format(depth) +
                                     " m, more than the 'largest overlap'."});
  }
}

InspectionResult ParticleGuard::judge(const Faults &faults, const ParticleArrays &particles,
                                      const std::function<std::string(std::size_t)> &describe)
{
  const bool may_squeeze = parameters.excessive_overlap == "warn";
  std::vector<Fault> grave = faults.fast;
  if (!may_squeeze)
    grave.insert(grave.end(), faults.squeezed.begin(), faults.squeezed.end());
  if (parameters.lost_particles == "stop")
    grave.insert(grave.end(), faults.lost.begin(), faults.lost.end());
  std::uint64_t numbers[3] = {grave.size(), faults.lost.size(), faults.squeezed.size()};
  MPI_Allreduce(MPI_IN_PLACE, numbers, 3, MPI_UINT64_T, MPI_SUM, domain.communicator());
  InspectionResult result;
  if (may_squeeze && numbers[2] > 0) {
    result.squeezed = numbers[2];
    if (most_at_once == 0)
      result.first_squeezed = first_of(faults.squeezed, particles, describe);
    most_at_once = std::max(most_at_once, numbers[2]);
  }
  if (numbers[0] + numbers[1] == 0)
    return result;
  result.stops = numbers[0] > 0;
  result.warns = !result.stops && parameters.lost_particles == "remove";
  result.number = result.stops ? numbers[0] : numbers[1];
  for (const Fault &fault : faults.lost)
    result.lost.push_back(fault.row);
  result.first = first_of(result.stops ? grave : faults.lost, particles, describe);
  return result;
}

std::string ParticleGuard::first_of(const std::vector<Fault> &faults,
                                    const ParticleArrays &particles,
                                    const std::function<std::string(std::size_t)> &describe) const
{
  MPI_Comm comm = domain.communicator();
  std::string first;
  ParticleId mine = std::numeric_limits<ParticleId>::max();
  for (const Fault &fault : faults) {
    const ParticleId id = particles.id[fault.row];
    if (id < mine) {
      mine = id;
      first = describe(fault.row) + " " + fault.what;
    }
  }
  ParticleId smallest = mine;
  MPI_Allreduce(MPI_IN_PLACE, &smallest, 1, MPI_UINT32_T, MPI_MIN, comm);
  int rank = std::numeric_limits<int>::max();
  if (mine == smallest)
    MPI_Comm_rank(comm, &rank);
  MPI_Allreduce(MPI_IN_PLACE, &rank, 1, MPI_INT, MPI_MIN, comm);
  int length = static_cast<int>(first.size());
  MPI_Bcast(&length, 1, MPI_INT, rank, comm);
  first.resize(length);
  MPI_Bcast(first.data(), length, MPI_CHAR, rank, comm);
  return first;
}

std::optional<double> ParticleGuard::newly_too_short(double stiffest)
{
  if (found_too_short)
    return std::nullopt;
  MPI_Allreduce(MPI_IN_PLACE, &stiffest, 1, MPI_DOUBLE, MPI_MAX, domain.communicator());
  const double half_period =
      stiffest > 0. ? M_PI / std::sqrt(stiffest) : std::numeric_limits<double>::infinity();
  if (dt <= half_period / steps_per_contact)
    return std::nullopt;
  found_too_short = true;
  return half_period;
}

std::string describe_particle(const ParticleArrays &p, const std::size_t row, const PairList &pairs,
                              const SolidContacts &solid_contacts, const std::vector<Solid> &solids)
{
  std::vector<std::string> touched;
  for (std::size_t k = 0; k < pairs.size(); ++k)
    if (pairs.record[k] != ContactMemory::none)
      for (const auto &[one, other] :
           {std::pair(pairs.i[k], pairs.j[k]), std::pair(pairs.j[k], pairs.i[k])})
        if (static_cast<std::size_t>(one) == row)
          touched.push_back("particle " + std::to_string(p.id[other]));
  for (const SolidContacts::Candidate &candidate : solid_contacts.get_candidates())
    if (static_cast<std::size_t>(candidate.particle) == row && candidate.n_living > 0)
      touched.push_back("'" + solids[candidate.solid].name + "'");
  std::string text = "particle " + std::to_string(p.id[row]) + " at " +
                     format(p.position[row].vec()) + " m with a velocity of " +
                     format(p.velocity[row].vec()) + " m/s, which touched ";
  if (touched.empty())
    text += "nothing";
  for (std::size_t k = 0; k < touched.size(); ++k)
    text += (k == 0 ? "" : k + 1 == touched.size() ? " and " : ", ") + touched[k];
  return text + ",";
}

} // namespace eunoe
