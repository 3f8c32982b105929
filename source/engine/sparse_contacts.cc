#include <eunoe/core/declare.h>
#include <eunoe/engine/sparse_contacts.h>

#include <algorithm>
#include <limits>

namespace eunoe {

namespace {

/// Neighbours of neighbours are awake, so that moving particles touch others that can give way.
constexpr unsigned int n_rings = 2;

/// Sets the flags of awake particles; no flags if all are awake.
void set_awake(ParticleArrays &p, std::vector<std::uint8_t> &&flags)
{
  p.awake_rows.clear();
  p.sleepers_moved2 = TwoLargest();
  if (std::find(flags.begin(), flags.end(), 0) == flags.end()) {
    p.awake.clear();
    return;
  }
  p.awake = std::move(flags);
  for (std::size_t row = 0; row < p.n_owned; ++row)
    if (p.awake[row] != 0)
      p.awake_rows.push_back(static_cast<std::int32_t>(row));
    else
      p.sleepers_moved2.note(norm_square(p.position[row].vec() - p.reference[row]));
}

} // namespace

void SparseContactParameters::declare(dealii::ParameterHandler &prm)
{
  declare::enter(prm, "model parameters");
  declare::enter(prm, "adaptive sparse contacts");
  declare::entry(prm, "enable adaptive sparse contacts", enabled,
                 "Whether particles that are at rest, and whose neighbours are, sleep: they do "
                 "not move and their contacts with each other are not computed, until something "
                 "moves near them.");
  constexpr double largest = std::numeric_limits<double>::max();
  declare::number_or_word(
      prm, "rest speed", "auto", "auto", 0., largest,
      "Speed up to which a particle is at rest (m/s). 'auto': that of a fall through the rest "
      "displacement.",
      [this](const std::optional<double> &value) { rest_speed = value; });
  declare::number_or_word(
      prm, "rest time", "auto", "auto", 0., largest,
      "Time for which a particle must have been at rest before it may sleep (s). 'auto': that of a "
      "fall through half of its diameter.",
      [this](const std::optional<double> &value) { rest_time = value; });
  declare::not_negative(prm, "rest displacement", rest_displacement,
                        "Distance from where its rest began, up to which a particle is at rest "
                        "(in its diameters): finds creep slower than the rest speed.");
  declare::count(prm, "check frequency", frequency,
                 "Steps between two checks which particles may sleep and which must wake; every "
                 "search for contacts checks as well.",
                 1);
  declare::leave(prm);
  declare::leave(prm);
}

void SparseContactParameters::check_with(const Vec3 &gravity, const ParameterCheck &check) const
{
  const ParameterCheck::Path path = {"model parameters", "adaptive sparse contacts"};
  const bool can_fall = !enabled || norm_square(gravity) > 0.;
  check.require(can_fall || rest_speed, path, "rest speed", "is 'auto' in a case without gravity.",
                "Give the speed (m/s) up to which a particle is at rest.");
  check.require(can_fall || rest_time, path, "rest time", "is 'auto' in a case without gravity.",
                "Give the time (s) for which a particle must have been at rest.");
}

SparseContacts::SparseContacts(const SparseContactParameters &parameters, const double gravity,
                               const double time_step)
    : parameters(parameters), rest(parameters, gravity, time_step)
{
}

void SparseContacts::add_fields(ParticleFields &fields)
{
  if (!parameters.enabled)
    return;
  asleep = fields.add({"asleep", 1, 0.});
  last_moved = fields.add({"last_moved_step", 1, -1.});
  rest_place = fields.add({"rest_place", 3, 0.});
}

std::vector<std::uint8_t> SparseContacts::find_restless(ParticleArrays &p,
                                                        const SolidContacts &solids,
                                                        const PeriodicBox &periods,
                                                        const Stirring &stirring) const
{
  std::vector<double> &moved = p.component(*last_moved);
  const auto now = static_cast<double>(stirring.step);
  const auto note_motion = [&](const std::size_t row) {
    moved[row] = now;
    p.set_vector(*rest_place, row, p.position[row].vec());
  };
  for (std::size_t row = 0; row < p.n_owned; ++row) {
    const double radius = p.radius(row), far = rest.displacement(radius);
    const Vec3 drift = periods.shortest(p.position[row].vec() - p.vector(*rest_place, row));
    // NaN is not at rest. Spin does not count: many particles turn in place for long, as nothing
    // resists a spin about the normal of a contact, and a rolling particle has a velocity.
    const bool at_rest = norm_square(p.velocity[row].vec()) <= rest.speed_square(radius) &&
                         norm_square(drift) <= far * far;
    if (!at_rest || stirring.everything || moved[row] < 0.)
      note_motion(row);
  }
  for (const SolidContacts::Candidate &candidate : solids.get_candidates())
    if (stirring.solid_moves[candidate.solid])
      note_motion(candidate.particle);
  // Ghosts outside all pairs get no flags from their owners.
  std::vector<std::uint8_t> restless(p.size(), 1);
  for (std::size_t row = 0; row < p.n_owned; ++row)
    restless[row] = now - moved[row] < std::max(1., rest.steps(p.radius(row)));
  return restless;
}

void SparseContacts::update(ParticleArrays &p, const PairList &pairs, const SolidContacts &solids,
                            Halo &halo, const PeriodicBox &periods, const Stirring &stirring) const
{
  std::vector<std::uint8_t> awake = find_restless(p, solids, periods, stirring), wider;
  halo.update(awake);
  for (unsigned int ring = 0; ring < n_rings; ++ring) {
    wider = awake;
    for (std::size_t k = 0; k < pairs.size(); ++k)
      if ((awake[pairs.i[k]] | awake[pairs.j[k]]) != 0)
        wider[pairs.i[k]] = wider[pairs.j[k]] = 1;
    awake.swap(wider);
    halo.update(awake);
  }
  std::vector<double> &sleeps = p.component(*asleep);
  for (std::size_t row = 0; row < p.n_owned; ++row) {
    const double now = awake[row] != 0 ? 0. : 1.;
    if (now == sleeps[row])
      continue;
    sleeps[row] = now;
    if (now != 0.) {
      p.velocity[row] = {0., 0., 0., p.mass(row)};
      p.spin[row] = {0., 0., 0., p.moment_of_inertia(row)};
    } else if (stirring.forces_follow)
      p.start_forces(row);
    else
      // A particle that wakes was in balance; forces that were added during its sleep do not count.
      p.force[row] = p.torque[row] = Quad();
  }
  set_awake(p, std::move(awake));
}

void SparseContacts::stir_neighbours(ParticleArrays &p, const PairList &pairs,
                                     const std::vector<std::uint8_t> &flags,
                                     const unsigned long long step) const
{
  std::vector<double> &moved = p.component(*last_moved);
  for (std::size_t k = 0; k < pairs.size(); ++k)
    if ((flags[pairs.i[k]] | flags[pairs.j[k]]) != 0)
      for (const std::int32_t row : {pairs.i[k], pairs.j[k]})
        if (static_cast<std::size_t>(row) < p.n_owned)
          moved[row] = static_cast<double>(step);
}

void SparseContacts::recall(ParticleArrays &p, Halo &halo) const
{
  const std::vector<double> &sleeps = p.component(*asleep);
  std::vector<std::uint8_t> awake(p.size(), 1);
  for (std::size_t row = 0; row < p.n_owned; ++row)
    awake[row] = sleeps[row] == 0.;
  halo.update(awake);
  set_awake(p, std::move(awake));
}

} // namespace eunoe
