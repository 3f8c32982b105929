// Sleeping particles (adaptive sparse contacts) wake in time: whatever stirs a bed at rest, it
// answers as if nobody had slept. Reference: the same case without sleep. Beds are chaotic, so
// centres of mass are compared, against how far they went.

#include "../tests.h"

#include <array>

using namespace test;

namespace {

constexpr double event = 0.2, diameter = 0.9e-3;

/// A horizontal pull that begins at the event, as if gravity tilted.
class Tilt : public Load
{
public:
  void add(ParticleArrays &p, double time) const override
  {
    if (time > event)
      p.for_each_awake([&](std::size_t k) { p.force[k].x += 8. * p.velocity[k].w; });
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

/// About 130 particles rain on a plate in a trough that is periodic in z.
/// @param stone velocity upwards of a large particle that starts over the bed; 0: none
std::string bed(bool sleep, const std::string &plate_velocity, const std::string &more,
                double width, double stone)
{
  std::array<std::string, 4> list; // x, y, z, vy
  std::string diameters;
  const auto add = [&](double x, double y, double z, double v, double d) {
    const double values[4] = {x, y, z, v};
    for (unsigned int c = 0; c < 4; ++c)
      list[c] += (list[c].empty() ? "" : ", ") + format(values[c]);
    diameters += (diameters.empty() ? "" : ", ") + format(d);
  };
  int n = 0;
  for (double y = 1.6e-3; y < 8e-3; y += 1.05e-3)
    for (double x = 0.6e-3; x < width - 0.5e-3; x += 1.05e-3)
      for (double z = 0.6e-3; z < 3e-3; z += 1.05e-3, ++n)
        add(x + 0.02e-3 * std::sin(7. * n), y, z + 0.02e-3 * std::cos(5. * n), 0.,
            diameter * (1. + 0.1 * std::sin(3. * n)));
  if (stone > 0.)
    add(3e-3, 12e-3, 1.5e-3, stone, 1.3e-3);
  return "subsection simulation control\n set time step = 1e-5\n set time end = 0.3\n"
         " set log frequency = 0\n set output path = results\nend\n"
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
         "subsection model parameters\n set rolling resistance torque method = epsd\n"
         " subsection contact detection\n  set neighborhood threshold = 1.1\n end\n"
         " subsection adaptive sparse contacts\n  set enable adaptive sparse contacts = " +
         std::string(sleep ? "true" : "false") +
         "\n  set rest time = 5e-3\n end\nend\n"
         "subsection insertion info\n set insertion method = list\n set list x = " +
         list[0] + "\n set list y = " + list[1] + "\n set list z = " + list[2] +
         "\n set list velocity y = " + list[3] + "\n set list diameters = " + diameters +
         "\nend\n"
         "subsection solid objects\n subsection solid surfaces\n  set number of solids = 2\n"
         "  subsection solid object 0\n   subsection mesh\n    set type = shape\n"
         "    set grid type = plane\n"
         "    set grid arguments = -1e-3, 1e-3, -1e-3 : 0, 0, 5e-3 : 8e-3, 0, 0\n   end\n"
         "   subsection translational velocity\n    set Function expression = " +
         plate_velocity + "\n   end\n  end\n" + more + " end\nend\n";
}

/// A blade beside the trough, which may move.
std::string blade(const std::string &velocity)
{
  return "  subsection solid object 1\n   subsection mesh\n    set type = shape\n"
         "    set grid type = box\n"
         "    set grid arguments = -3e-3, 3e-3, -1e-3 : -1e-3, 9e-3, 4e-3\n   end\n"
         "   subsection translational velocity\n    set Function expression = " +
         velocity + "\n   end\n  end\n";
}

struct Course
{
  Vec3 before, soon, end; ///< centre of mass at the event, 10 ms later, and at the end (m)
  double asleep = 0.;     ///< share just before the event
};

Course run(const std::string &input)
{
  Case test_case(input);
  Course course;
  test_case.run([&](Simulation &simulation) {
    const auto is_at = [&](double t) { return std::abs(simulation.time() - t) < 0.5e-5; };
    if (!is_at(event - 1e-4) && !is_at(event + 1e-2) && !is_at(0.3))
      return;
    const ParticleArrays &p = simulation.complete_step();
    Vec3 centre;
    double mass = 0.;
    for (std::size_t k = 0; k < p.n_owned; ++k)
      if (p.position[k].w < 0.6e-3) { // not the stone
        centre += p.velocity[k].w * p.position[k].vec();
        mass += p.velocity[k].w;
      }
    centre = centre / mass;
    (is_at(0.3) ? course.end : is_at(event + 1e-2) ? course.soon : course.before) = centre;
    if (simulation.time() < event)
      course.asleep = 1. - static_cast<double>(p.n_awake()) / static_cast<double>(p.n_owned);
  });
  return course;
}

struct Story
{
  std::string name, plate = "0; 0; 0", blade_velocity = "0; 0; 0", more;
  double width = 6e-3, stone = 0.;
};

void compare(const Story &story)
{
  const auto input = [&](bool sleep) {
    return bed(sleep, story.plate, blade(story.blade_velocity), story.width, story.stone) +
           story.more;
  };
  const Course awake = run(input(false)), asleep = run(input(true));
  check(story.name + ": nearly all sleep before", asleep.asleep > 0.9,
        format(100. * asleep.asleep) + " %");
  const auto moved = [](const Vec3 &from, const Vec3 &to) { return to - from; };
  const double far = norm(moved(awake.before, awake.end));
  check(story.name + ": the bed moves", far > 0.02 * diameter, format(far) + " m");
  check_close(story.name + ": soon after",
              norm(moved(asleep.before, asleep.soon) - moved(awake.before, awake.soon)) / far, 0.,
              0.02);
  check_close(story.name + ": in the end",
              norm(moved(asleep.before, asleep.end) - moved(awake.before, awake.end)) / far, 0.,
              0.4);
}

} // namespace

int main(int argc, char **argv)
{
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);

  // At rest: the bed stays where it is.
  const Course awake = run(bed(false, "0; 0; 0", blade("0; 0; 0"), 6e-3, 0.)),
               asleep = run(bed(true, "0; 0; 0", blade("0; 0; 0"), 6e-3, 0.));
  check("all sleep at rest", asleep.asleep == 1., format(asleep.asleep));
  check("none sleeps unless asked to", awake.asleep == 0.);
  check_close("a sleeping bed stays in place", norm(asleep.end - asleep.before), 0., 0.);
  check_close("as it does awake", norm(awake.end - awake.before) / diameter, 0., 1e-3);
  check_close("where it came to rest", norm(awake.before - asleep.before) / diameter, 0., 0.02);

  Story stone;
  stone.name = "a stone falls";
  stone.stone = 0.981; // comes back at the event
  compare(stone);
  Story plate;
  plate.name = "the plate starts to move";
  plate.plate = "0; if(t>0.2, -0.02, 0); 0";
  compare(plate);
  Story spreader;
  spreader.name = "a blade arrives";
  spreader.blade_velocity = "if(t>0.2, 0.05, 0); 0; 0";
  compare(spreader);
  Story wall;
  wall.name = "a wall vanishes";
  wall.width = 4e-3;
  wall.more = "subsection floating walls\n set number of floating walls = 1\n subsection wall 0\n"
              "  set point on wall = 4e-3, 0, 0\n  set normal vector = -1, 0, 0\n"
              "  set start time = 0\n  set end time = 0.2\n end\nend\n";
  compare(wall);
  Tilt::acts = true;
  Story tilt;
  tilt.name = "gravity tilts";
  compare(tilt);
}
