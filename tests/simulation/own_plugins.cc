// A load, an integrator, an insertion method, a size distribution and a motion of solids, each with
// an entry of its own and each in one piece of code that no other code names: all are in this file.
// A particle that they insert and move is at the expected place.

#include <eunoe/core/declare.h>

#include "../tests.h"

using namespace test;

namespace {

/// The same acceleration of all particles along x.
class Wind : public Load
{
public:
  explicit Wind(double acceleration) : acceleration(acceleration) {}

  void add(ParticleArrays &p, double) const override
  {
    p.for_each_awake([&](const std::size_t k) { p.force[k].x += p.mass(k) * acceleration; });
  }

private:
  const double acceleration;
};

class WindSection : public LoadSection
{
public:
  void declare(dealii::ParameterHandler &prm) override
  {
    declare::enter(prm, "model parameters");
    declare::entry(prm, "wind", acceleration, "Acceleration along x (m/s2).");
    declare::leave(prm);
  }
  std::unique_ptr<Load> make(const PhysicalProperties &) const override
  {
    return acceleration != 0. ? std::make_unique<Wind>(acceleration) : nullptr;
  }

private:
  double acceleration = 0.;
};

const LoadRegistry::Registration wind(loads(), "wind",
                                      [] { return std::make_unique<WindSection>(); });

/// Euler's method, but particles move by only a share of their velocities.
class Syrup : public Integrator
{
public:
  explicit Syrup(double share) : share(share) {}

  Travel begin_step(ParticleArrays &p, double dt) override
  {
    p.for_each_awake([&](const std::size_t k) {
      p.velocity[k].add(dt / p.mass(k) * p.force[k].vec());
      p.position[k].add(share * dt * p.velocity[k].vec());
      if (gives_weight)
        p.start_forces(k);
      else
        p.force[k] = p.torque[k] = Quad();
    });
    return {Travel::unknown}; // so that contacts are searched at every step
  }
  void complete(ParticleArrays &, double) override {}

  static bool gives_weight;

private:
  const double share;
};

bool Syrup::gives_weight = true;

class SyrupSection : public IntegratorSection
{
public:
  void declare(dealii::ParameterHandler &prm) override
  {
    declare::enter(prm, "model parameters");
    declare::entry(prm, "syrup share", share, "Share of the velocity.");
    declare::leave(prm);
  }
  void check(const ParameterCheck &check) const override
  {
    check.require(share <= 1., {"model parameters"}, "syrup share", "is above 1.", "Lower it.");
  }
  std::unique_ptr<Integrator> make() const override { return std::make_unique<Syrup>(share); }

private:
  double share = 1.;
};

const IntegratorRegistry::Registration syrup(integrators(), "syrup",
                                             [] { return std::make_unique<SyrupSection>(); });

/// One particle at a given place.
class Single : public Insertion
{
public:
  Single(const Vec3 &place, const PhysicalProperties &physics)
      : place(place), particles(physics.types)
  {
  }

  double largest_diameter() const override { return particles.largest_diameter(); }
  std::size_t supply(std::size_t) const override { return 1; }
  void skip(std::size_t n, std::size_t) override { done = n > 0; }
  bool finished() const override { return done; }
  std::vector<NewParticle> next(ParticleIds &ids) override
  {
    done = true;
    NewParticle particle = particles.particle(0, ids.take(1));
    particle.position = place;
    return {particle};
  }

private:
  const Vec3 place;
  const ParticleSupply particles;
  bool done = false;
};

class SingleSection : public InsertionSection
{
public:
  void declare(dealii::ParameterHandler &prm) override
  {
    declare::entry(prm, "single height", height, "Place on the z-axis (m).");
  }
  void check(const InsertionSettings &, const ParameterCheck &check) const override
  {
    check.require(height <= 1., {InsertionParameters::section}, "single height", "is above 1 m.",
                  "Lower it.");
  }
  std::unique_ptr<Insertion> make(const InsertionSettings &, const PhysicalProperties &physics,
                                  MPI_Comm) const override
  {
    return std::make_unique<Single>(Vec3{0., 0., height}, physics);
  }

private:
  double height = 0.;
};

const InsertionRegistry::Registration single(insertion_methods(), "single",
                                             [] { return std::make_unique<SingleSection>(); });

/// Half the particles have the average diameter, half another one.
class Pair : public SizeDistribution
{
public:
  Pair(double first, double second) : first(first), second(second) {}

  double diameter(double u) const override { return u < 0.5 ? first : second; }
  double smallest() const override { return std::min(first, second); }
  double largest() const override { return std::max(first, second); }
  double mean_cube() const override
  {
    return 0.5 * (first * first * first + second * second * second);
  }

private:
  const double first, second;
};

class PairSection : public SizeDistributionSection
{
public:
  void declare(dealii::ParameterHandler &prm) override
  {
    declare::entry(prm, "other diameter", other, "Diameter of half the particles (m).");
  }
  void check(const SizeDistributionParameters &, const ParameterCheck &check,
             const ParameterCheck::Path &path) const override
  {
    check.require(other > 0., path, "other diameter", "is not positive.", "Raise it.");
  }
  std::unique_ptr<SizeDistribution> make(const SizeDistributionParameters &shared) const override
  {
    return std::make_unique<Pair>(shared.average_diameter, other);
  }

private:
  double other = 1e-3;
};

const SizeDistributionRegistry::Registration pair(size_distributions(), "pair",
                                                  [] { return std::make_unique<PairSection>(); });

/// Jumps from its centre to the opposite point after 1 s.
class Flicker : public Motion
{
public:
  explicit Flicker(const Vec3 &centre) : centre(centre) {}

  RigidState at(double time) const override
  {
    RigidState state;
    state.centre = time > 1. ? -1. * centre : centre;
    return state;
  }

private:
  const Vec3 centre;
};

class FlickerSection : public MotionSection
{
public:
  void declare(dealii::ParameterHandler &prm) override
  {
    declare::entry(prm, "flickers", flickers, "Whether the solid flickers.");
  }
  std::unique_ptr<Motion> make(const Vec3 &centre, double) const override
  {
    return flickers ? std::make_unique<Flicker>(centre) : nullptr;
  }

private:
  bool flickers = false;
};

const MotionRegistry::Registration flicker(solid_motions(), "flicker",
                                           [] { return std::make_unique<FlickerSection>(); });

/// An input text that uses all of them, with these values of their entries.
std::string input(const std::string &share, const std::string &height, const std::string &other,
                  const std::string &method = "single")
{
  return "subsection model parameters\n set wind = 10\n set integration method = syrup\n"
         " set syrup share = " +
         share + "\nend\nsubsection insertion info\n set insertion method = " + method +
         "\n set single height = " + height +
         "\nend\nsubsection lagrangian physical properties\n subsection particle type 0\n"
         "  set number = 1\n  set diameter = 1e-3\n  set size distribution type = pair\n"
         "  set other diameter = " +
         other + "\n end\nend\n";
}

std::string problems_of(const std::string &text)
{
  Problems problems;
  Parameters::read(text, "test.prm", {}, problems);
  std::string all;
  for (const Problem &problem : problems.all())
    all += problem.what + " ";
  return all;
}

/// Place of the solid at a time, or what is wrong with its entries.
std::string moves(const std::string &entries, double time)
{
  SolidObjectParameters solids(1);
  read_entries([&](dealii::ParameterHandler &prm) { solids.declare(prm); },
               "subsection solid objects\n subsection solid surfaces\n"
               "  subsection solid object 0\n   set center of rotation = 1, 0, 0\n" +
                   entries + "  end\n end\nend\n");
  try {
    return format(solids.objects[0].make_motion(1e-3)->at(time).centre.x);
  } catch (const std::invalid_argument &error) {
    return error.what();
  }
}

} // namespace

EUNOE_MPI_TEST()
{
  const double dt = 1e-5;
  const unsigned int n = 20;
  const std::string gravity =
      "subsection lagrangian physical properties\n set g = 0, 0, -9.81\nend\n";
  Case test_case(box_input(dt, n * dt, input("0.5", "4e-3", "2e-3")));
  test_case.run();
  const std::vector<double> particle = particle_table(*test_case).at(0);
  check_relative("the load gives speed", particle[c_vx], 10. * n * dt, 1e-14);
  check_relative("the integrator halves the way", particle[c_x],
                 0.5 * 10. * dt * dt * n * (n + 1) / 2., 1e-12);
  check("the insertion method has its place", particle[c_z] == 4e-3);
  const double diameter = 2. * particle[c_radius];
  check("the size distribution gives the diameter", diameter == 1e-3 || diameter == 2e-3);
  const auto sizes = test_case->get_parameters().physics.types[0].sizes.make();
  check("its own entry counts", sizes->diameter(0.4) == 1e-3 && sizes->diameter(0.6) == 2e-3);

  Syrup::gives_weight = false;
  std::string refusal;
  try {
    Case(box_input(dt, n * dt, input("0.5", "4e-3", "2e-3") + gravity)).run();
  } catch (const UserError &error) {
    refusal = error.what();
  }
  check("an integrator that forgets the weight is refused",
        refusal == "The integration method 'syrup' leaves particles without their weight. Its "
                   "begin_step must call ParticleArrays::start_forces for each that is awake.",
        refusal);

  const std::string wrong = problems_of(input("2", "3", "-1"));
  check("their values are checked", wrong == "is not positive. is above 1 m. is above 1. ", wrong);
  const std::string unused = problems_of(input("1", "3", "1", "volume"));
  check("those of a method that is not chosen are not", unused.empty(), unused);

  check("a solid rests", moves("", 2.) == "1");
  check("a motion", moves("set flickers = true\n", 2.) == "-1");
  const std::string velocity = "subsection translational velocity\n"
                               " set Function expression = 1; 0; 0\nend\n";
  check("a motion by expressions", moves(velocity, 2.) == "3", moves(velocity, 2.));
  const std::string both = moves("set flickers = true\n" + velocity, 2.);
  check("two motions of one solid",
        both == "has two motions, 'expressions' and 'flicker'. Leave the entries of one at their "
                "defaults.",
        both);
}
