// Insertion on a plane: every event inserts one particle at the middle of each empty mesh cell that
// the plane cuts, until all are inserted; the same on any number of ranks. Reference: counting by
// hand. The mesh has 4 x 4 x 4 cells of 5 mm.

#include "../on_one_rank.h"

using namespace test;

namespace {

std::string case_on_plane(unsigned int steps, unsigned int number, const std::string &insertion)
{
  return box_input(1e-5, 1e-5 * steps,
                   "subsection lagrangian physical properties\n subsection particle type 0\n"
                   "  set size distribution type = normal\n  set average diameter = 1e-3\n"
                   "  set standard deviation = 1e-4\n  set number of particles = " +
                       std::to_string(number) +
                       "\n end\nend\nsubsection insertion info\n set insertion method = plane\n"
                       " set insertion frequency = 20\n" +
                       insertion + "end\n");
}

/// Number of particles after each event, which come every 20 steps.
std::vector<std::size_t> numbers_after_events(Case &run)
{
  std::vector<std::size_t> numbers;
  run.run([&numbers](Simulation &simulation) {
    const std::size_t n = particle_table(simulation).size();
    if (simulation.step_number() % 20 == 0)
      numbers.push_back(n);
  });
  return numbers;
}

void test_places()
{
  // If the plane lies on faces of cells, it takes the cells on the side opposite to its normal.
  Case one(case_on_plane(1, 16,
                         " set insertion plane point = 0, 0, 5e-3\n"
                         " set insertion plane normal vector = 0, 0, -3\n"));
  bool all_centres = true;
  one.run([&](Simulation &simulation) {
    const auto all = particle_table(simulation);
    all_centres = all.size() == 16;
    for (const auto &p : all)
      for (const Column c : {c_x, c_y})
        all_centres = all_centres && std::abs(std::fmod(p[c] + 0.01, 5e-3) - 2.5e-3) < 1e-12 &&
                      std::abs(p[c_z] - 7.5e-3) < 1e-12;
  });
  check("one in the middle of each cell", all_centres);

  const Numbers shifted = same_on_one_rank("shifted", [](MPI_Comm comm) {
    Case one_event(case_on_plane(1, 16,
                                 " set insertion plane point = 0, 0, 7e-3\n"
                                 " set insertion plane normal vector = 0, 0, 1\n"
                                 " set insertion maximum offset = 100\n"),
                   comm);
    one_event.run();
    return particle_table(*one_event);
  });
  bool inside = shifted.size() == 16;
  double sum = 0., furthest = 0.;
  for (const auto &p : shifted)
    for (const Column c : {c_x, c_y, c_z}) {
      const double from_centre = std::fmod(p[c] + 0.01, 5e-3) - 2.5e-3;
      inside = inside && std::abs(from_centre) <= 2.5e-3 - p[c_radius];
      furthest = std::max(furthest, std::abs(from_centre));
      sum += p[c_id] * from_centre + p[c_radius];
    }
  check("shifted, and all inside their cells", inside && furthest > 1.5e-3);
  // Recorded, so that a change of the random numbers is noticed.
  char text[64];
  std::snprintf(text, sizeof text, "fingerprint %.8g", sum);
  print(text);

  Case oblique(case_on_plane(1, 1000,
                             " set insertion plane point = 0, 0, 1e-4\n"
                             " set insertion plane normal vector = 1, 1, 1\n"));
  // The corners of cell (i, j, k) have sums of coordinates from 5 n - 30 to 5 n - 15 mm, where
  // n = i + j + k; so the plane at 0.1 mm cuts those with n = 4, 5, 6: 12, 12, 10 cells.
  check("an oblique plane", numbers_after_events(oblique).front() == 12 + 12 + 10);
}

void test_events()
{
  // After 60 steps, or 3 mm, the first particles have left their cells.
  Case falling(case_on_plane(140, 40,
                             " set insertion plane point = 0, 0, 7e-3\n"
                             " set insertion plane normal vector = 0, 0, 1\n"
                             " set initial velocity = 0, 0, -5\n"));
  check("again when the cells are empty",
        numbers_after_events(falling) ==
            std::vector<std::size_t>({16, 16, 16, 32, 32, 32, 40, 40}));

  // The particles move sideways into the next cells, so that only the first row of four is emptied.
  Case sideways(case_on_plane(60, 100,
                              " set insertion plane point = 0, 0, 7e-3\n"
                              " set insertion plane normal vector = 0, 0, 1\n"
                              " set initial velocity = 5, 0, 0\n"));
  check("not where others have come", numbers_after_events(sideways).back() == 20);

  // Removed particles make room in the same event.
  Case emptied(case_on_plane(20, 100,
                             " set insertion plane point = 0, 0, 7e-3\n"
                             " set insertion plane normal vector = 0, 0, 1\n"
                             " set remove particles = true\n"
                             " set removal box points coordinates = -1,-1,-1 : 0,1,1\n"));
  bool renewed = true;
  emptied.run([&](Simulation &simulation) {
    if (simulation.step_number() == 20)
      renewed = particle_table(simulation).size() == 16 && simulation.particle_ids().next() == 25;
  });
  check("room that was made", renewed);
}

/// A large sphere is not inserted while one that has left the cell still reaches into its place.
void test_touching()
{
  Case large(box_input(1e-5, 1e-3,
                       "subsection lagrangian physical properties\n subsection particle type 0\n"
                       "  set diameter = 3.6e-3\n  set number of particles = 32\n end\nend\n"
                       "subsection insertion info\n set insertion method = plane\n"
                       " set insertion frequency = 20\n set insertion plane point = 0, 0, 7e-3\n"
                       " set insertion plane normal vector = 0, 0, 1\n"
                       " set initial velocity = 0, 0, -5\nend\n"));
  // After 3 mm they are out of the cells, but the next ones need a distance of 3.6 mm, which is
  // reached at the event after 4 mm.
  const auto numbers = numbers_after_events(large);
  check("not where they would touch", numbers[3] == 16 && numbers[4] == 32);
}

/// A plate of 1 mm in one of the cells, in which a particle would lie.
void test_solids()
{
  Case with_plate(case_on_plane(1, 16,
                                " set insertion plane point = 0, 0, 7e-3\n"
                                " set insertion plane normal vector = 0, 0, 1\n") +
                  shape_input("box", "1e-3, 1e-3, 7e-3 : 4e-3, 4e-3, 8e-3"));
  with_plate.run();
  const auto all = particle_table(*with_plate);
  const bool has_one = std::any_of(all.begin(), all.end(), [](const std::vector<double> &p) {
    return p[c_x] > 0. && p[c_x] < 5e-3 && p[c_y] > 0. && p[c_y] < 5e-3;
  });
  check("not in a solid", all.size() == 15 && !has_one);
}

} // namespace

EUNOE_MPI_TEST()
{
  test_places();
  test_events();
  test_touching();
  test_solids();
}
