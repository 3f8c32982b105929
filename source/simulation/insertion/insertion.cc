#include <eunoe/core/declare.h>
#include <eunoe/core/expressions.h>
#include <eunoe/domain/domain.h>
#include <eunoe/simulation/insertion.h>

#include <algorithm>

namespace eunoe {

InsertionRegistry &insertion_methods()
{
  static InsertionRegistry registry("insertion method");
  return registry;
}

std::size_t leave_out_what_is_outside(std::vector<NewParticle> &particles, const Domain &domain)
{
  const auto end =
      std::remove_if(particles.begin(), particles.end(), [&](const NewParticle &particle) {
        return !domain.contains(particle.position);
      });
  const auto number = static_cast<std::size_t>(particles.end() - end);
  particles.erase(end, particles.end());
  return number;
}

std::pair<std::size_t, std::size_t> share_of(const std::size_t n, MPI_Comm comm)
{
  int rank, size;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &size);
  return {n * rank / size, n * (rank + 1) / size};
}

void InsertionParameters::declare(dealii::ParameterHandler &prm)
{
  declare::enter(prm, section);
  declare::choice(
      prm, "insertion method", method, insertion_methods().names(),
      "Where the particles come from: a random grid in a box (volume), the lists of "
      "this section (list), files (file), the empty cells of the mesh that a plane cuts, "
      "one particle each (plane), or a dense random packing in a box (packed).");
  declare::count(prm, "insertion frequency", frequency,
                 "Steps between events, the first of which is at the start; 0: a single event.");
  declare::corners(prm, "insertion box points coordinates", box_lower, box_upper,
                   "volume, packed: two opposite corners of the box (m).");
  declare::not_negative(
      prm, "insertion maximum offset", maximum_offset,
      "volume: largest random shift of a particle over the largest diameter; plane: "
      "likewise, as far as the particle stays in its cell.");
  declare::count(prm, "insertion prn seed", seed,
                 "Seed of the random shifts (volume, plane) or places (packed).");
  declare::enter(prm, "insertion acceptance function");
  declare::entry(prm, "Function expression", acceptance,
                 "Expression in x, y, z: volume uses points of the grid, and packed places, "
                 "where it is positive.");
  declare::entry(prm, "Function constants", acceptance_constants,
                 "Constants of the expression, 'a=1, b=2'.");
  declare::leave(prm);
  declare::entry(prm, "remove particles", removes,
                 "Whether the removal box is emptied before every event.");
  declare::corners(prm, "removal box points coordinates", removal_lower, removal_upper,
                   "Two opposite corners of the removal box (m).");
  declare::vector(prm, "initial velocity", velocity,
                  "volume, plane, packed: velocity of the particles (m/s).");
  declare::vector(prm, "initial angular velocity", spin,
                  "volume, plane, packed: angular velocity of the particles (rad/s).");
  for (auto &[name, entries] : methods)
    entries->declare(prm);
  declare::leave(prm);
}

void InsertionParameters::check(const ParameterCheck &check) const
{
  if (removes)
    check.require(removal_lower.x < removal_upper.x && removal_lower.y < removal_upper.y &&
                      removal_lower.z < removal_upper.z,
                  {section}, "removal box points coordinates",
                  "has a first corner that is not below the second in every direction.",
                  "Give the lower corner first.");
  chosen().check(*this, check);
}

void InsertionSettings::check_box(const ParameterCheck &check) const
{
  const std::string section = InsertionParameters::section;
  try {
    Expressions(acceptance, acceptance_constants, 1);
  } catch (const std::invalid_argument &error) {
    check.require(false, {section, "insertion acceptance function"}, "Function expression",
                  "is not understood: " + std::string(error.what()) + ".",
                  "Write one expression in x, y and z.");
  }
  check.require(box_lower.x < box_upper.x && box_lower.y < box_upper.y && box_lower.z < box_upper.z,
                {section}, "insertion box points coordinates",
                "has a first corner that is not below the second in every direction.",
                "Give the lower corner first.");
}

} // namespace eunoe
