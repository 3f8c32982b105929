// The table of collisions with walls: for a sphere that bounces between two walls, every line gives
// the coefficient of restitution; an elastic sphere touches for Hertz's duration; only the chosen
// walls have lines. Reference: the prescribed coefficient; Hertz's duration of contact.

#include <eunoe/core/files.h>
#include <eunoe/core/table.h>

#include "../spheres.h"

using namespace test;

namespace {

/// Indices of the columns.
enum
{
  collision,
  particle,
  wall,
  start_time,
  start_v,
  start_w = start_v + 3,
  end_time = start_w + 3,
  end_v,
  end_w = end_v + 3
};

Scene bouncing(double restitution, const std::string &entries)
{
  Scene s;
  s.half_width = 5e-3;
  s.particle.restitution = s.wall.restitution = restitution;
  s.time_step = 1e-7;
  s.spheres.resize(1);
  s.spheres[0].v = {0., 0., -2.};
  s.more = "subsection post-processing\nsubsection particle wall collision statistics\n"
           " set enable particle wall collision statistics = true\n" +
           entries + "end\nend\n";
  return s;
}

Table table_of(const Scene &scene, const std::string &name)
{
  run(scene);
  return parse_table(read_file("results/" + name, MPI_COMM_WORLD), name);
}

void test_restitution()
{
  Scene s = bouncing(0.8, "");
  s.spheres[0].v.x = 0.1;
  s.spheres[0].w = {0., 0., 7.};
  s.time_end = 2e-2;
  const Table table = table_of(s, "collision_statistics.csv");
  check("several collisions", table.rows.size() >= 3);
  check("columns", table.columns.size() == 17 && table.columns[end_v] == "end_v_x");
  bool in_turn = true, untouched = true, before_touch = true;
  double worst = 0., last_end = 0., last_v = -2.;
  for (std::size_t k = 0; k < table.rows.size(); ++k) {
    const auto &row = table.rows[k];
    in_turn = in_turn && row[collision] == double(k) && row[particle] == 1. &&
              row[wall] == (k % 2 == 0 ? 4. : 5.) && row[start_time] > last_end &&
              row[end_time] > row[start_time];
    worst = std::max(worst, std::abs(-row[end_v + 2] / row[start_v + 2] - 0.8));
    before_touch = before_touch && row[start_v + 2] == last_v;
    untouched = untouched && row[start_v] == 0.1 && row[end_v] == 0.1 && row[start_w + 2] == 7. &&
                row[end_w + 2] == 7.;
    last_end = row[end_time];
    last_v = row[end_v + 2];
  }
  check("walls in turn, one line each", in_turn);
  check_close("restitution on every line", worst, 0., 2e-4);
  // No force acts on the sphere between two walls.
  check("a collision begins with the velocity that the last one left", before_touch);
  check("without friction nothing else changes", untouched);
}

void test_duration()
{
  Scene s =
      bouncing(1., " set log collisions with all walls = false\n set wall boundary ids = 3, 5\n"
                   " set collision statistics file = upper.dat\n");
  s.time_end = 1.7e-2;
  const Table table = table_of(s, "upper.dat");
  check("those of one wall only", table.rows.size() == 2 && table.rows[0][wall] == 5.);
  // Hertz: t = 2.9432 h / v with the largest overlap h = (15 m v^2 / (16 E* sqrt(R)))^(2/5).
  const double v = 2., radius = 0.5e-3, young = 1e7 / (2. * (1. - 0.3 * 0.3));
  const double overlap =
      std::pow(15. * s.mass(s.spheres[0]) * v * v / (16. * young * std::sqrt(radius)), 0.4);
  const double duration = 2.9432 * overlap / v;
  // The times in the table are whole steps.
  check_close("duration", table.rows[0][end_time] - table.rows[0][start_time], duration, 1.1e-7);
  check_close("nothing is lost", table.rows[0][end_v + 2], -2., 1e-4);
}

} // namespace

EUNOE_MPI_TEST()
{
  test_restitution();
  test_duration();
}
