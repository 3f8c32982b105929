// A process is made anew for every simulation, from a section that stays as it was read: what the
// process decides is in the simulation's own parameters, and two simulations of one case do not
// influence each other. Each field and each solid is found by its handle.

#include <eunoe/processes/powder_spreading/layer_log.h>

#include "small_case.h"
#include "tests.h"

using namespace test;

namespace {

/// The particles after some steps.
std::vector<std::vector<double>> first_particles(const Parameters &parameters)
{
  Log log(MPI_COMM_WORLD, true);
  Simulation simulation(parameters, MPI_COMM_WORLD, log);
  return particles_when(simulation, [](const Simulation &s) { return s.step_number() >= 20; });
}

void examine_parameters()
{
  Problems problems;
  const Parameters parameters =
      Parameters::read(small_spreading("results", ""), "test.prm", {}, problems);
  check("the case is in order", problems.empty());
  const Parameters of_run = parameters.of_run();
  check("the process decides the mesh",
        of_run.mesh.grid_arguments != parameters.mesh.grid_arguments);
  check("and the boundaries",
        of_run.boundaries.conditions.size() == 3 && parameters.boundaries.conditions.empty());
  Problems of_level;
  Parameters::read(small_spreading("results", "  set feedstock level = 120e-6"), "test.prm", {},
                   of_level);
  check("a bed above the spreader's clearance is refused", !of_level.empty());
  Problems of_number;
  const Parameters counted = Parameters::read(
      small_spreading("results", ""), "test.prm",
      {"lagrangian physical properties/particle type 0/number of particles = 7"}, of_number);
  check("a number of particles is said to have no effect",
        of_number.empty() && of_number.warnings().size() == 1 &&
            of_number.warnings()[0].where.find("number of particles") != std::string::npos);
  check("and has none", counted.physics.types[0].number == 0);
  const auto first = first_particles(parameters), second = first_particles(parameters);
  check("a simulation leaves its input as it was",
        parameters.mesh.grid_arguments == Parameters().mesh.grid_arguments &&
            parameters.boundaries.conditions.empty());
  check("particles are inserted", !first.empty());
  check("two simulations of one input are alike", first == second);
}

void examine_handles()
{
  ParticleFields fields;
  const FieldHandle before = fields.add({"before", 2, 7.});
  const auto layers = spreading::LayerLog::add_fields(fields);
  ParticleArrays particles;
  particles.resize(3, 0, fields.n_components());
  check("a new particle has the first values of all fields",
        fields.initial_values() ==
            std::vector<double>({7., 7., -1., 0., 0., 0., 0., 0., 0., 0., 0.}));
  particles.component(before, 1)[2] = 5.;
  particles.component(layers.layer)[2] = 1.;
  particles.set_vector(layers.displacement, 2, {2., 3., 4.});
  particles.component(layers.on_plate)[2] = 6.;
  check("a vector is read as it was written",
        particles.vector(layers.displacement, 2) == Vec3{2., 3., 4.});
  std::vector<double> values;
  for (const std::vector<double> &component : particles.extra)
    values.push_back(component[2]);
  check("no field lies on another",
        values == std::vector<double>({0., 5., 1., 0., 2., 3., 4., 6., 0., 0., 0.}));

  std::vector<Solid> solids(4);
  Solid solid;
  solid.name = "fifth";
  const SolidHandle handle = add_solid(solids, solid);
  check("a solid is found by its handle", solids[handle.number].name == "fifth");
}

} // namespace

EUNOE_MPI_TEST()
{
  examine_parameters();
  examine_handles();
}
