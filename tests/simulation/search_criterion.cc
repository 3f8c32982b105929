// When contacts are searched: as soon as two bodies together may have moved by the allowed share of
// the skin, on whatever rank they are. These are the two farthest particles, or the farthest and a
// solid.
// Reference: two numbers of all, sorted; the steps of a flight; all pairs that touch.

#include <eunoe/engine/search_criterion.h>

#include "moving_solids.h"
#include "touching.h"

#include <limits>

using namespace test;

namespace {

constexpr double skin = 1.;

bool is_last_rank()
{
  int n_ranks, rank;
  MPI_Comm_size(MPI_COMM_WORLD, &n_ranks);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank + 1 == n_ranks;
}

/// @param travel on this rank
/// @param solid_moved displacement of a solid
bool is_due(const ContactDetectionParameters &parameters, const Travel &travel, double solid_moved,
            unsigned long long step = 1)
{
  MovingSolids solids;
  solids.take({rising("floor", 1.)});
  solids.note_search();
  solids.move_to(solid_moved);
  SearchCriterion criterion(parameters, skin, MPI_COMM_WORLD);
  criterion.ask(step, travel, 0.);
  return criterion.is_due(solids);
}

/// @param moved largest displacement of a particle on the last rank, where nothing is known of
///              others; none on the other ranks
bool is_due(const ContactDetectionParameters &parameters, double moved, double solid_moved,
            unsigned long long step = 1)
{
  return is_due(parameters, Travel{is_last_rank() ? moved * moved : 0.}, solid_moved, step);
}

/// Of some particles.
Travel travel_of(const std::vector<double> &displacements)
{
  Travel travel{0.};
  travel.second2 = 0.;
  for (const double moved : displacements)
    travel.include({moved * moved, 0.});
  return travel;
}

/// @param on_last displacements of the particles of the last rank
/// @param on_first of those of the first rank, which may be the same
bool is_due_by(const ContactDetectionParameters &parameters, const std::vector<double> &on_last,
               const std::vector<double> &on_first, double solid_moved = 0.)
{
  std::vector<double> mine;
  if (is_last_rank())
    mine = on_last;
  if (is_first_rank())
    mine.insert(mine.end(), on_first.begin(), on_first.end());
  return is_due(parameters, travel_of(mine), solid_moved);
}

void check_two_largest()
{
  std::vector<double> numbers = {0., 1., 2., 2., 3.};
  bool ok = true;
  do {
    // In two parts, as those of two ranks.
    for (std::size_t n = 0; n <= numbers.size(); ++n) {
      TwoLargest one, other;
      for (std::size_t k = 0; k < numbers.size(); ++k)
        (k < n ? one : other).note(numbers[k]);
      one.note(other.first);
      one.note(other.second);
      ok = ok && one.first == 3. && one.second == 2.;
    }
  } while (std::next_permutation(numbers.begin(), numbers.end()));
  check("two largest numbers, in any order", ok);
  TwoLargest same;
  same.note(2.);
  same.note(2.);
  check("which may be equal", same.first == 2. && same.second == 2.);
  same.note(std::numeric_limits<double>::quiet_NaN());
  check("what is no number is passed over", same.first == 2. && same.second == 2.);

  Travel travel = travel_of({3., 1.});
  travel.include({4., 1.});
  check("sleepers are among the farthest", travel.moved2 == 9. && travel.second2 == 4.);
  travel = {std::numeric_limits<double>::quiet_NaN()};
  travel.include({4., 1.});
  check("and do not hide what is no number", std::isnan(travel.moved2));
}

/// Three particles that go by different ways in a step of 1 s.
void check_integrator(const std::string &name)
{
  IntegratorParameters parameters;
  read_entries([&](dealii::ParameterHandler &prm) { parameters.declare(prm); },
               "subsection model parameters\n set integration method = " + name + "\nend\n");
  ParticleArrays particles;
  particles.resize(3, 0, 0);
  for (std::size_t k = 0; k < 3; ++k) {
    particles.velocity[k].w = particles.spin[k].w = 1.;
    particles.velocity[k].x = k == 0 ? 2. : k == 1 ? 3. : 1.;
  }
  const Travel travel = parameters.make()->begin_step(particles, 1.);
  check(name + " tells the two farthest", travel.moved2 == 9. && travel.second2 == 4.);
}

/// Searches for a sphere that flies alone for 400 steps, each of 0.0097 mm, after the first one.
/// The skin is 0.3 mm.
unsigned long long searches_of_flight()
{
  constexpr double dt = 1e-5;
  Case flight(box_input(dt, 400. * dt,
                        "subsection insertion info\n set insertion method = list\n"
                        " set list x = 0\n set list y = 0\n set list z = -2e-3\n"
                        " set list diameters = 1e-3\n set list velocity z = 0.97\nend\n"));
  unsigned long long at_start = 0;
  flight.run([&](Simulation &simulation) {
    if (simulation.step_number() == 0)
      at_start = simulation.get_system().n_searches();
  });
  return flight->get_system().n_searches() - at_start;
}

/// Two spheres meet, which are at first farther apart than the skin of 0.05 mm, while a third one
/// goes by 0.5 mm in every step, so that contacts are searched at each.
Touching meeting_beside_fast_grain()
{
  constexpr double dt = 1e-5;
  Case meeting(box_input(dt, 28. * dt,
                         "subsection insertion info\n set insertion method = list\n"
                         " set list x = -0.53e-3, 0.53e-3, -9e-3\n set list y = 0, 0, 5e-3\n"
                         " set list z = 0, 0, 0\n set list diameters = 1e-3, 1e-3, 1e-3\n"
                         " set list velocity x = 0.167, -0.167, 50\nend\n"
                         "subsection model parameters\n subsection contact detection\n"
                         "  set neighborhood threshold = 1.05\n end\nend\n"));
  Touching touching;
  constexpr double no_period = 1.;
  meeting.run([&](Simulation &simulation) { touching.count(simulation, no_period); });
  MPI_Allreduce(MPI_IN_PLACE, &touching.n_missed, 1, MPI_UNSIGNED_LONG, MPI_SUM, MPI_COMM_WORLD);
  return touching;
}

/// Whether ranks that would list near pairs at different steps are told the same.
bool is_share_common()
{
  int n_ranks, rank;
  MPI_Comm_size(MPI_COMM_WORLD, &n_ranks);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  const ContactDetectionParameters parameters;
  SearchCriterion criterion(parameters, skin, MPI_COMM_WORLD);
  criterion.ask(1, {0.}, 1. / (1. + rank));
  criterion.is_due(MovingSolids());
  const bool first = criterion.largest_near_share() == 1.;
  criterion.ask(2, {0.}, 1. + rank);
  criterion.is_due(MovingSolids());
  return first && criterion.largest_near_share() == n_ranks;
}

} // namespace

EUNOE_MPI_TEST()
{
  ContactDetectionParameters parameters;
  check_close("skin of a threshold of 1.3", parameters.skin(2.), 0.6, 1e-15);
  check_close("allowed share of the skin",
              SearchCriterion(parameters, skin, MPI_COMM_WORLD).allowed_displacement(), 0.8, 1e-15);
  check("two particles towards each other",
        !is_due(parameters, 0.39, 0.) && is_due(parameters, 0.41, 0.));
  check("a particle and a faster solid",
        !is_due(parameters, 0.2, 0.59) && is_due(parameters, 0.2, 0.61));
  check("a solid alone", !is_due(parameters, 0., 0.79) && is_due(parameters, 0., 0.81));
  check("a slower solid is none of the two", !is_due(parameters, 0.39, 0.3));
  check("no number", is_due(parameters, std::numeric_limits<double>::quiet_NaN(), 0.));
  check("near pairs are listed at the same steps on all ranks", is_share_common());
  check_two_largest();
  check("the second farthest counts, on another rank or the same",
        !is_due_by(parameters, {0.6}, {0.19, 0.1}) && is_due_by(parameters, {0.6}, {0.21, 0.1}) &&
            !is_due_by(parameters, {0.6, 0.19}, {0.1, 0.1}) &&
            is_due_by(parameters, {0.6, 0.21}, {0.1, 0.1}));
  // MPI may bring either one's numbers into the other's.
  check("the two farthest on the first rank", !is_due_by(parameters, {0.1, 0.1}, {0.6, 0.19}) &&
                                                  is_due_by(parameters, {0.1, 0.1}, {0.6, 0.21}));
  check("or both are as far",
        !is_due_by(parameters, {0.39}, {0.39}) && is_due_by(parameters, {0.41}, {0.41}));
  check("one alone may use up all",
        !is_due_by(parameters, {0.79}, {}) && is_due_by(parameters, {0.81}, {}));
  check("a solid that has gone farther than the second",
        !is_due_by(parameters, {0.5}, {0.1}, 0.29) && is_due_by(parameters, {0.5}, {0.1}, 0.31));
  for (const std::string integrator : {"velocity_verlet", "explicit_euler", "symplectic_euler"})
    check_integrator(integrator);
  // Every 25 steps of 0.0097 mm are more than 80 % of the skin of 0.3 mm.
  const unsigned long long searches = searches_of_flight();
  check("a flight alone", searches == 16, std::to_string(searches) + " searches");
  const Touching touching = meeting_beside_fast_grain();
  check("a grain that is faster than the skin hides no contact of others",
        touching.n > 0 && touching.n_missed == 0,
        std::to_string(touching.n_missed) + " of " + std::to_string(touching.n) + " missed");
  parameters.frequency = 10;
  check("dynamic looks at every step", is_due(parameters, 1., 1., 9));
  parameters.method = "constant";
  check("constant: then always", !is_due(parameters, 1., 0., 9) && is_due(parameters, 0., 0., 10));
  check("and when a solid has come near", is_due(parameters, 0., 1., 9));
}
