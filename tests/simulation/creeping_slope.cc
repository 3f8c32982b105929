// A slope that creeps is not at rest. Some 200 grains fall on an incline. Under 23 degrees or so
// and with the rolling resistance `constant`, which cannot hold a grain at rest (Ai et al. 2011),
// the bed stops to flow and creeps on, by some hundredths of a diameter a second: it must creep
// with sleep as without. So small beds are chaotic: one creeps, and the next by less than a tenth
// of that, which is rest, so that the first angle is taken under which the bed creeps without
// sleep. Under 17 degrees and with `epsd` it stands: it must sleep, and may not go anywhere else
// than without sleep.

#include "../tests.h"

using namespace test;

namespace {

constexpr double diameter = 1e-3, time_step = 8e-6;

std::string plane_with_ribs()
{
  std::string text =
      "subsection solid objects\n subsection solid surfaces\n  set number of solids = 2\n";
  for (const int k : {0, 1}) {
    const std::string x = k == 0 ? "1e-3" : "4e-3", x_end = k == 0 ? "1.5e-3" : "4.5e-3";
    text += "  subsection solid object " + std::to_string(k) +
            "\n   subsection mesh\n    set type = shape\n    set grid type = box\n"
            "    set grid arguments = " +
            x + ", -1e-3, -0.2e-3 : " + x_end + ", 5e-3, 0.7e-3\n   end\n  end\n";
  }
  return text + " end\nend\n";
}

struct Story
{
  double angle, settled, end; ///< of the incline (degrees); when it is looked at (s)
  std::string rolling;
};

std::string gravity(double angle)
{
  const double radians = angle * M_PI / 180.;
  return format(9.81 * std::sin(radians)) + ", 0, " + format(-9.81 * std::cos(radians));
}

std::string input(const Story &story, const std::string &sleep)
{
  const auto periodic = [](const std::string &number, const std::string &ids,
                           const std::string &d) {
    return " subsection boundary condition " + number + "\n  set type = periodic\n" + ids +
           "  set periodic direction = " + d + "\n end\n";
  };
  std::string materials;
  for (const std::string of : {"particles", "wall"}) {
    const std::string text = "  set young modulus " + of + " = 5e6\n  set poisson ratio " + of +
                             " = 0.3\n  set restitution coefficient " + of +
                             " = 0.5\n  set friction coefficient " + of +
                             " = 0.5\n  set rolling friction " + of +
                             " = 0.05\n  set rolling viscous damping " + of + " = 0.3\n";
    materials += of == "wall"
                     ? text
                     : " subsection particle type 0\n  set number of particles = 200\n"
                       "  set size distribution type = custom\n"
                       "  set custom distribution diameters values = 0.8e-3, 1e-3, 1.2e-3\n"
                       "  set custom distribution diameters probabilities = 0.3, 0.4, 0.3\n"
                       "  set density particles = 2500\n" +
                           text + " end\n";
  }
  return "subsection simulation control\n set time step = 8e-6\n set time end = " +
         format(story.end) +
         "\n set log frequency = 0\n set output path = results\nend\n"
         "subsection mesh\n set grid type = subdivided_hyper_rectangle\n"
         " set grid arguments = 2, 1, 8 : 0, 0, 0 : 6e-3, 4e-3, 24e-3 : true\nend\n"
         "subsection DEM boundary conditions\n set number of boundary conditions = 2\n" +
         periodic("0", "  set periodic id 0 = 0\n  set periodic id 1 = 1\n", "0") +
         periodic("1", "  set periodic id 0 = 2\n  set periodic id 1 = 3\n", "1") +
         "end\nsubsection lagrangian physical properties\n set g = " + gravity(story.angle) + "\n" +
         materials +
         "end\nsubsection insertion info\n"
         " set insertion box points coordinates = 0, 0, 0.9e-3 : 6e-3, 4e-3, 23e-3\n"
         " set insertion distance threshold = 1.05\n set insertion maximum offset = 0.05\nend\n"
         "subsection model parameters\n set rolling resistance torque method = " +
         story.rolling + "\n subsection adaptive sparse contacts\n" + sleep + " end\nend\n" +
         plane_with_ribs();
}

struct Course
{
  double way = 0.; ///< of all grains along the slope, from the settled bed to the end (diameters)
  double asleep = 0.; ///< mean share of sleepers meanwhile
};

Course run(const Story &story, const std::string &sleep)
{
  Case test_case(input(story, sleep));
  Course course;
  std::size_t n_steps = 0;
  test_case.run([&](Simulation &simulation) {
    if (simulation.time() < story.settled)
      return;
    ++n_steps;
    const ParticleArrays &p = simulation.get_system().particles;
    const auto n = static_cast<double>(p.n_owned);
    for (std::size_t row = 0; row < p.n_owned; ++row)
      course.way += p.velocity[row].x / n * time_step / diameter;
    course.asleep += 1. - static_cast<double>(p.n_awake()) / n;
  });
  course.asleep /= static_cast<double>(n_steps);
  return course;
}

const std::string awake, enabled = "  set enable adaptive sparse contacts = true\n";
/// Rest that is judged by the speed alone.
const std::string by_speed = enabled + "  set rest speed = 3e-4\n  set rest time = 2e-3\n"
                                       "  set rest displacement = 1e3\n";

} // namespace

EUNOE_MPI_TEST()
{
  Story creeping = {22.6, 0.4, 0.6, "constant"};
  const Story standing = {17., 0.3, 0.4, "epsd"};
  const auto creeps = [](const Course &course) { return course.way > 4e-3 && course.way < 0.05; };
  Course creep = run(creeping, awake);
  for (; !creeps(creep) && creeping.angle < 23.4; creep = run(creeping, awake))
    creeping.angle += 0.1;
  const Course creep_asleep = run(creeping, enabled), frozen = run(creeping, by_speed);
  check("it creeps", creeps(creep), format(creep.way) + " diameters");
  check_relative("it creeps as without sleep", creep_asleep.way, creep.way, 0.4);
  check("judged by its speed alone it would freeze", frozen.way < 0.3 * creep.way,
        format(frozen.way) + " diameters");

  const Course rest = run(standing, awake), rest_asleep = run(standing, enabled);
  check("it stands", std::abs(rest.way) < 1e-3, format(rest.way) + " diameters");
  check("it sleeps", rest_asleep.asleep > 0.5, format(rest_asleep.asleep));
  check_close("it stands as without sleep", rest_asleep.way, rest.way, 1e-3);
}
