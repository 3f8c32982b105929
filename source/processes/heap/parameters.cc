#include <eunoe/core/declare.h>
#include <eunoe/processes/heap/parameters.h>

namespace eunoe::heap {

namespace {

void declare_powder(dealii::ParameterHandler &prm, HeapParameters &p)
{
  using declare::not_negative;
  declare::count(prm, "number of particles", p.n_particles,
                 "Number of particles that are filled in; 0: 'mass' or 'fill ratio' rules.");
  not_negative(
      prm, "mass", p.mass,
      "Mass of powder that is filled in, to within the scatter of the sizes (kg); 0: 'number "
      "of particles' or 'fill ratio' rules.");
  not_negative(prm, "fill ratio", p.fill_ratio,
               "If number and mass are 0: mass of powder over that of a heap with a base angle "
               "of 37.5 degrees, so that discs of any size are filled alike.");
  not_negative(prm, "insertion speed", p.insertion_speed,
               "Speed at which the loose particles start to fall into the tube (m/s).");
  declare::count(prm, "seed", p.seed, "Seed of the random places of the loose particles.");
}

void declare_rest(dealii::ParameterHandler &prm, HeapParameters &p)
{
  using declare::not_negative;
  not_negative(
      prm, "rest energy share", p.rest_energy_share,
      "A particle is calm when its kinetic energy of translation is below this share of m g d, "
      "the energy that lifts it by its diameter.");
  declare::between(prm, "moving share", p.moving_share, 0., 1.,
                   "Share of the particles that may still move in powder at rest.");
  declare::count(prm, "rest check frequency", p.rest_check_frequency,
                 "Steps between two checks of the energies.", 1);
  not_negative(
      prm, "rest duration", p.rest_duration,
      "Time for which all other particles must stay calm until the powder counts as at rest (s).");
  not_negative(
      prm, "longest wait", p.longest_wait,
      "Longest wait for rest, after the filling and after the lifting (s); the run then goes "
      "on with a warning.");
  not_negative(
      prm, "measurement delay", p.measurement_delay,
      "Time from the end of the lifting to the measurement (s), whatever still moves then, to "
      "compare with heaps that were measured by the clock; 0: the heap is measured at rest.");
}

} // namespace

void HeapParameters::declare(dealii::ParameterHandler &prm)
{
  using declare::not_negative;
  declare::enter(prm, section);
  not_negative(prm, "tube inner diameter", tube_diameter, "Inner diameter of the tube (m).");
  not_negative(prm, "disc diameter", disc_diameter,
               "Diameter of the disc on which the heap stands (m), at least that of the tube.");
  not_negative(
      prm, "gap below the tube", gap,
      "Height of the tube's lower end over the disc before it is lifted (m); 0: it stands on "
      "the disc.");
  not_negative(
      prm, "disc rim height", rim_height,
      "Height of the disc's vertical rim, below which powder falls freely (m); 0: five of the "
      "largest diameters.");
  declare::between(prm, "facets", n_facets, 25, 1000,
                   "Number of flat facets around the tube and the disc.");
  not_negative(prm, "lifting velocity", lifting_velocity,
               "Velocity at which the tube rises (m/s).");
  declare_powder(prm, *this);
  declare_rest(prm, *this);
  declare::between(prm, "number of views", n_views, 1, 1000,
                   "Number of directions, evenly spread over 180 degrees, in which the heap is "
                   "seen.");
  declare::between(prm, "profile bins", n_bins, 10, 10000,
                   "Number of bins of the mean profile across the disc's diameter.");
  declare::between(prm, "profile rings", n_rings, 1, 1000,
                   "Number of rings of equal width between the axis and the disc's edge in which "
                   "the profile is a measurement for comparisons with data.");
  declare::between(prm, "density layers", n_density_layers, 1, 1000,
                   "Number of layers between the disc and the top of a heap with a base angle of "
                   "37.5 degrees in which the solid fraction around the axis is measured.");
  declare::file(prm, "measured profile", measured_profile,
                "File with a measured profile to compare with: a table with the columns 'x' and "
                "'height' (m), x from the centre of the disc; empty: none.");
  declare::entry(prm, "heap picture", picture,
                 "Whether the particles are written when the heap is measured (<name>_heap.pvd).");
  declare::leave(prm);
}

void HeapParameters::check(const ParameterCheck &check) const
{
  const auto positive = [&](double value, const std::string &entry) {
    check.require(value > 0., {section}, entry, "is " + format(value) + ".",
                  "Give a positive value.");
  };
  positive(tube_diameter, "tube inner diameter");
  positive(disc_diameter, "disc diameter");
  positive(lifting_velocity, "lifting velocity");
  positive(rest_energy_share, "rest energy share");
  positive(rest_duration, "rest duration");
  check.require(tube_diameter <= disc_diameter, {section}, "tube inner diameter",
                "is " + format(tube_diameter) + " m, more than the disc's " +
                    format(disc_diameter) + " m: the powder would fall past the disc.",
                "Give a tube that is at most as wide as the disc.");
  check.require(n_particles == 0 || mass == 0., {section}, "mass",
                "is " + format(mass) + " kg, and 'number of particles' is set, too.",
                "Give one of the two.");
  check.require(n_particles > 0 || mass > 0. || fill_ratio > 0., {section}, "fill ratio",
                "is 0, and neither is a number of particles or a mass given.",
                "Give one of the three.");
  check.require(longest_wait > rest_duration, {section}, "longest wait",
                "is " + format(longest_wait) + " s, not more than the rest duration of " +
                    format(rest_duration) + " s, so that the powder could never be found at rest.",
                "Give a longer wait, 0.5 for example.");
}

} // namespace eunoe::heap
