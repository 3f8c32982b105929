// Sleeping particles (adaptive sparse contacts) wake in time: whatever disturbs a bed at rest, it
// responds as if no particle had slept.
//
// First a few grains in order, whose motion is not chaotic: each must come to the same place as
// without sleep, and to the place that a formula or the moving solid determines. Then a bed of some
// 130 grains, whose motion is chaotic: it is compared while the differences are still small.

#include "../tests.h"

#include <array>

using namespace test;

namespace {

/// Time of the event (s), diameter of most grains, and height of the plate over the bottom of the
/// mesh, which is a wall, too (m).
constexpr double event = 0.2, diameter = 0.9e-3, floor_height = 1e-3;

/// A horizontal pull that begins at the event, as if gravity tilted.
class Tilt : public Load
{
public:
  void add(ParticleArrays &p, double time) const override
  {
    if (time > event)
      p.for_each_awake([&](std::size_t k) { p.force[k].x += 8. * p.mass(k); });
  }
  bool changes(double begin, double end) const override { return begin <= event && end > event; }

  static bool acts;
};
bool Tilt::acts = false;

class TiltSection : public LoadSection
{
public:
  std::unique_ptr<Load> make(const PhysicalProperties &) const override
  {
    return Tilt::acts ? std::make_unique<Tilt>() : nullptr;
  }
};

const LoadRegistry::Registration registration(loads(), "tilt",
                                              [] { return std::make_unique<TiltSection>(); });

struct Grain
{
  double x, y, z, vy = 0., d = diameter;
};

/// A plate of 8 mm under a trough 6 mm long that is periodic in z, a blade beside it, and what
/// disturbs the grains.
struct Story
{
  std::string name;
  std::vector<Grain> grains;
  std::string plate = "0; 0; 0", blade = "0; 0; 0"; ///< velocities (m/s)
  std::string blade_bottom = "3e-3", rolling = "epsd", more;
  double soon = event + 1e-2, end = 0.3; ///< when the others are compared
};

/// Grains in rows and layers, slightly out of order, that fall on the plate.
std::vector<Grain> bed(double width = 6e-3)
{
  std::vector<Grain> grains;
  int n = 0;
  for (double y = 1.6e-3; y < 8e-3; y += 1.05e-3)
    for (double x = 0.6e-3; x < width - 0.5e-3; x += 1.05e-3)
      for (double z = 0.6e-3; z < 3e-3; z += 1.05e-3, ++n)
        grains.push_back({x + 0.021e-3 * std::sin(7. * n), y, z + 0.021e-3 * std::cos(5. * n), 0.,
                          diameter * (1. + 0.1 * std::sin(3. * n))});
  return grains;
}

/// Grains on top of each other.
std::vector<Grain> column(unsigned int n)
{
  std::vector<Grain> grains;
  for (unsigned int k = 0; k < n; ++k)
    grains.push_back({2e-3, floor_height + (k + 0.5) * diameter, 1.5e-3});
  return grains;
}

std::string solid(unsigned int number, const std::string &shape, const std::string &velocity)
{
  return "  subsection solid object " + std::to_string(number) +
         "\n   subsection mesh\n    set type = shape\n    set grid type = " + shape +
         "\n   end\n   subsection translational velocity\n    set Function expression = " +
         velocity + "\n   end\n  end\n";
}

std::string input(const Story &story, bool sleep)
{
  std::array<std::string, 5> list; // x, y, z, vy, d
  for (const Grain &grain : story.grains) {
    const double values[5] = {grain.x, grain.y, grain.z, grain.vy, grain.d};
    for (unsigned int c = 0; c < 5; ++c) {
      char text[32];
      std::snprintf(text, sizeof text, "%.17g", values[c]);
      list[c] += (list[c].empty() ? "" : ", ") + std::string(text);
    }
  }
  return "subsection simulation control\n set time step = 1e-5\n set time end = " +
         format(story.end) +
         "\n set log frequency = 0\n set output path = results\nend\n"
         "subsection mesh\n set grid type = subdivided_hyper_rectangle\n"
         " set grid arguments = 2, 20, 1 : 0, 0, 0 : 6e-3, 70e-3, 3e-3 : true\nend\n"
         "subsection DEM boundary conditions\n set number of boundary conditions = 1\n"
         " subsection boundary condition 0\n  set type = periodic\n  set periodic id 0 = 4\n"
         "  set periodic id 1 = 5\n  set periodic direction = 2\n end\nend\n"
         "subsection lagrangian physical properties\n set g = 0, -9.81, 0\n"
         " subsection particle type 0\n  set average diameter = 1.3e-3\n"
         "  set density particles = 2000\n"
         "  set restitution coefficient particles = 0.3\n"
         "  set friction coefficient particles = 0.4\n end\n"
         " set restitution coefficient wall = 0.3\n set friction coefficient wall = 0.4\nend\n"
         "subsection model parameters\n set rolling resistance torque method = " +
         story.rolling +
         "\n subsection contact detection\n  set neighborhood threshold = 1.1\n end\n"
         " subsection adaptive sparse contacts\n  set enable adaptive sparse contacts = " +
         std::string(sleep ? "true" : "false") +
         "\n  set rest time = 5e-3\n end\nend\n"
         "subsection insertion info\n set insertion method = list\n set list x = " +
         list[0] + "\n set list y = " + list[1] + "\n set list z = " + list[2] +
         "\n set list velocity y = " + list[3] + "\n set list diameters = " + list[4] +
         "\nend\n"
         "subsection solid objects\n subsection solid surfaces\n  set number of solids = 2\n" +
         solid(0, "plane\n    set grid arguments = -1e-3, 1e-3, -1e-3 : 0, 0, 5e-3 : 8e-3, 0, 0",
               story.plate) +
         solid(1,
               "box\n    set grid arguments = -3e-3, " + story.blade_bottom +
                   ", -1e-3 : -1e-3, 9e-3, 4e-3",
               story.blade) +
         " end\nend\n" + story.more;
}

using Places = std::vector<Vec3>;

struct Course
{
  Places before, soon, end; ///< of all grains at the event, soon after, and at the end (m)
  double asleep = 0.;       ///< share of sleepers just before the event
};

Course run(const Story &story, bool sleep)
{
  Case test_case(input(story, sleep));
  Course course;
  test_case.run([&](Simulation &simulation) {
    const auto is_at = [&](double t) { return std::abs(simulation.time() - t) < 0.5e-5; };
    const bool is_before = is_at(event - 1e-4), is_soon = is_at(story.soon);
    if (!is_before && !is_soon && !is_at(story.end))
      return;
    Places places;
    for (const std::vector<double> &row : particle_table(simulation))
      places.push_back({row[c_x], row[c_y], row[c_z]});
    (is_before ? course.before : is_soon ? course.soon : course.end) = places;
    const ParticleArrays &p = simulation.get_system().particles;
    if (is_before)
      course.asleep = 1. - static_cast<double>(p.n_awake()) / static_cast<double>(p.n_owned);
  });
  return course;
}

double largest_difference(const Places &a, const Places &b)
{
  double largest = 0.;
  for (std::size_t k = 0; k < a.size(); ++k)
    largest = std::max(largest, norm(a[k] - b[k]));
  return largest;
}

/// Runs a story with sleep and without and compares all grains.
/// @param n_flying number of grains that fly and so cannot sleep
/// @param check_end further checks of a course
void tell(const Story &story, unsigned int n_flying, double tolerance,
          const std::function<void(const Course &, bool)> &check_end = {})
{
  Course course[2];
  const auto n = static_cast<double>(story.grains.size());
  for (const bool sleep : {false, true}) {
    course[sleep] = run(story, sleep);
    check_close(story.name + ": share asleep", course[sleep].asleep,
                sleep ? (n - n_flying) / n : 0., 1e-12);
    if (check_end)
      check_end(course[sleep], sleep);
  }
  check(story.name + ": it moves",
        largest_difference(course[0].before, course[0].end) > 0.5 * diameter);
  if (tolerance > 0.)
    check_close(story.name + ": as without sleep",
                largest_difference(course[0].end, course[1].end) / diameter, 0., tolerance);
}

// A grain that falls asleep loses its last velocity, up to 0.3 mm/s, and stays some 1e-4 diameters
// from where it would have come to rest; nothing in these stories makes that distance grow.
constexpr double regular = 1e-3;

/// Height of the centre of a grain on the plate (m).
const double height = floor_height + 0.5 * diameter;

void test_stone()
{
  Story stone;
  stone.name = "a stone on a column";
  stone.grains = column(4);
  stone.grains.push_back({2e-3, 12e-3, 1.5e-3, 0.981, 1.3e-3}); // falls back at the event
  // In the half millisecond between two checks of who sleeps, the impact travels further down than
  // the two rings of awake grains, and sleepers do not yield; so the stone bounces a little
  // differently.
  tell(stone, 1, 0.05);
}

void test_sinking_plate()
{
  Story plate;
  plate.name = "the plate under a column sinks";
  plate.grains = column(4);
  plate.plate = "0; if(t>0.2, -0.009, 0); 0";
  tell(plate, 0, regular, [&](const Course &c, bool) {
    double worst = 0.;
    for (std::size_t k = 0; k < c.end.size(); ++k)
      worst = std::max(worst, norm(c.end[k] - c.before[k] + Vec3{0., 0.009 * 0.1, 0.}));
    check_close(plate.name + ": all go with it", worst / diameter, 0., regular);
  });
}

void test_blade()
{
  Story spreader;
  spreader.name = "a blade pushes a row";
  for (const double x : {1.5e-3, 2.4e-3, 3.3e-3})
    spreader.grains.push_back({x, height, 1.5e-3});
  spreader.blade = "if(t>0.2, 0.03, 0); 0; 0";
  spreader.blade_bottom = "1.1e-3";
  tell(spreader, 0, 10. * regular, [&](const Course &c, bool) {
    // The blade stands at 2 mm at the end.
    check(spreader.name + ": none is in the blade",
          c.end[0].x > 2e-3 + (0.5 - regular) * diameter && c.end[1].x > c.end[0].x &&
              c.end[2].x > c.end[1].x);
  });
}

void test_vanishing_wall()
{
  Story wall;
  wall.name = "the wall of a pyramid vanishes";
  wall.grains = {{0.45e-3, height, 1.5e-3},
                 {1.35e-3, height, 1.5e-3},
                 {0.9e-3, height + std::sqrt(0.75) * diameter, 1.5e-3}};
  wall.more = "subsection floating walls\n set number of floating walls = 1\n subsection wall 0\n"
              "  set point on wall = 1.8e-3, 0, 0\n  set normal vector = -1, 0, 0\n"
              "  set start time = 0\n  set end time = 0.2\n end\nend\n"
              "subsection lagrangian physical properties\n subsection particle type 0\n"
              "  set friction coefficient particles = 0.1\n end\n"
              " set friction coefficient wall = 0.1\nend\n";
  tell(wall, 0, regular);
}

void test_tilt()
{
  Tilt::acts = true;
  Story tilt;
  tilt.name = "gravity tilts under a grain";
  tilt.grains = {{1e-3, height, 1.5e-3}};
  tilt.rolling = "none";
  tilt.end = event + 2e-2;
  tell(tilt, 0, 0., [&](const Course &c, bool sleep) {
    // A change of a load is noticed at the next check of who sleeps, here 50 steps after the event.
    // The spring of the contact shortens the path by some 1e-3.
    const double time = 2e-2 - (sleep ? 50e-5 : 0.);
    check_relative(tilt.name + ": it rolls", c.end[0].x - c.before[0].x,
                   0.5 * 5. / 7. * 8. * time * time, 5e-3);
  });
  Tilt::acts = false;
}

Vec3 centre(const Story &story, const Places &places)
{
  Vec3 sum;
  double mass = 0.;
  for (std::size_t k = 0; k < places.size(); ++k)
    if (story.grains[k].d < 1.2e-3) { // not the stone
      const double m = sphere_mass(0.5 * story.grains[k].d, 2000.);
      sum += m * places[k];
      mass += m;
    }
  return sum / mass;
}

void test_bed(const Story &story)
{
  const Course awake = run(story, false), asleep = run(story, true);
  check(story.name + ": nearly all sleep before", asleep.asleep > 0.9, format(asleep.asleep));
  const auto moved = [&](const Course &c, const Places Course::*when) {
    return centre(story, c.*when) - centre(story, c.before);
  };
  const double far = norm(moved(awake, &Course::end));
  check(story.name + ": the bed moves", far > 0.02 * diameter, format(far) + " m");
  const double early = norm(moved(awake, &Course::soon));
  check(story.name + ": it has begun to", early > 0.02 * far, format(early / far));
  // If the sleeping bed did not respond, the difference would be all that the other one moves.
  check_close(story.name + ": soon after",
              norm(moved(asleep, &Course::soon) - moved(awake, &Course::soon)) / far, 0., 0.02);
}

} // namespace

EUNOE_MPI_TEST()
{
  test_stone();
  test_sinking_plate();
  test_blade();
  test_vanishing_wall();
  test_tilt();

  Story still;
  still.grains = bed();
  const Course awake = run(still, false), asleep = run(still, true);
  check("all sleep at rest", asleep.asleep == 1., format(asleep.asleep));
  check("none sleeps unless asked to", awake.asleep == 0.);
  check_close("a sleeping bed stays in place", largest_difference(asleep.before, asleep.end), 0.,
              0.);
  check_close("as it does awake",
              norm(centre(still, awake.end) - centre(still, awake.before)) / diameter, 0., regular);
  check_close("where it came to rest",
              norm(centre(still, awake.before) - centre(still, asleep.before)) / diameter, 0.,
              regular);

  Story stone = still;
  stone.name = "a stone falls";
  stone.grains.push_back({3e-3, 12e-3, 1.5e-3, 0.981, 1.3e-3}); // falls back at the event
  test_bed(stone);
  Story plate = still;
  plate.name = "the plate starts to move";
  plate.plate = "0; if(t>0.2, -0.02, 0); 0";
  test_bed(plate);
  Story spreader = still;
  spreader.name = "a blade arrives";
  spreader.soon = event + 3e-2; // on its way for 20 ms
  spreader.blade = "if(t>0.2, 0.05, 0); 0; 0";
  test_bed(spreader);
  Story wall = still;
  wall.name = "a wall vanishes";
  wall.grains = bed(4e-3);
  wall.more = "subsection floating walls\n set number of floating walls = 1\n subsection wall 0\n"
              "  set point on wall = 4e-3, 0, 0\n  set normal vector = -1, 0, 0\n"
              "  set start time = 0\n  set end time = 0.2\n end\nend\n";
  test_bed(wall);
  Tilt::acts = true;
  Story tilt = still;
  tilt.name = "gravity tilts";
  test_bed(tilt);
}
