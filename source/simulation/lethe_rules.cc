#include <eunoe/simulation/lethe_rules.h>

namespace eunoe::lethe_rules {

namespace {

const EntryPath properties = {"lagrangian physical properties"},
                type = {"lagrangian physical properties", "particle type *"},
                insertion = {"insertion info"}, model = {"model parameters"},
                control = {"simulation control"}, box = {"box refinement", "box *"},
                balancing = {"model parameters", "load balancing"},
                boundary = {"DEM boundary conditions", "boundary condition *"}, mesh = {"mesh"},
                no_section = {};

} // namespace

const std::vector<Renamed> &renamed()
{
  static const std::vector<Renamed> list = {
      {type, "random seed distribution", "distribution prn seed"},
      {type, "custom volume fractions", "custom distribution diameters probabilities"},
      {insertion, "insertion file name", "list of input files"},
      {insertion, "clearing particles", "remove particles"},
      {insertion, "clearing box points coordinates", "removal box points coordinates"},
      {insertion, "insertion order of direction", "insertion direction sequence"},
      {insertion, "insertion random number range", "insertion maximum offset"},
      {insertion, "insertion random number seed", "insertion prn seed"},
      {control, "output time frequency", "output time"},
      {box, "initial refinement", "additional refinement"},
      {{"post-processing"}, "Lagrangian post-processing", "lagrangian post-processing"},
      {{"model parameters", "adaptive sparse contacts"},
       "enable dynamic disabling contacts",
       "enable adaptive sparse contacts"}};
  return list;
}

const std::vector<Word> &words()
{
  static const std::vector<Word> list = {
      {model, "rolling resistance torque method", "no_resistance", "none"},
      {model, "rolling resistance torque method", "constant_resistance", "constant"},
      {model, "rolling resistance torque method", "viscous_resistance", "viscous"},
      {model, "rolling resistance torque method", "epsd_resistance", "epsd"},
      {control, "output frequency", "-1", "0"},
      {control, "output time", "-1", "0"},
      {control, "log frequency", "-1", "0"},
      {insertion, "insertion method", "uniform", "volume"},
      {insertion, "insertion method", "non_uniform", "volume"},
      {mesh, "type", "cylinder", "lethe"},
      {mesh, "grid type", "classic", "cylinder_classic"},
      {mesh, "grid type", "balanced", "cylinder_balanced"},
      {mesh, "grid type", "squared", "cylinder_squared"},
      {mesh, "grid type", "regularized", "cylinder_regularized"},
      {balancing, "load balance method", "dynamic_with_sparse_contacts", "dynamic"},
      {balancing, "load balance method", "dynamic_with_disabling_contacts", "dynamic"}};
  return list;
}

const std::vector<Components> &components()
{
  static const std::vector<Components> list = {
      {properties, {"gx", "gy", "gz"}, properties, "g"},
      {insertion, {"velocity x", "velocity y", "velocity z"}, insertion, "initial velocity"},
      {insertion, {"omega x", "omega y", "omega z"}, insertion, "initial angular velocity"},
      {insertion,
       {"insertion box minimum x", "insertion box minimum y", "insertion box minimum z",
        "insertion box maximum x", "insertion box maximum y", "insertion box maximum z"},
       insertion,
       "insertion box points coordinates"},
      {insertion,
       {"insertion first direction", "insertion second direction", "insertion third direction"},
       insertion,
       "insertion direction sequence"},
      {boundary,
       {"rotational vector x", "rotational vector y", "rotational vector z"},
       boundary,
       "rotational vector"},
      {{"floating walls", "wall *", "point on wall"},
       {"x", "y", "z"},
       {"floating walls", "wall *"},
       "point on wall"},
      {{"floating walls", "wall *", "normal vector"},
       {"nx", "ny", "nz"},
       {"floating walls", "wall *"},
       "normal vector"}};
  return list;
}

const std::vector<Ignored> &ignored_for_heat()
{
  static const std::string why = "is for heat between particles.";
  static const std::vector<Ignored> list = {
      {insertion, {"list temperatures"}, why},
      {{"insertion info", "initial temperature function"}, {}, why},
      {type,
       {"thermal conductivity particles", "specific heat particles", "microhardness particles",
        "surface slope particles", "surface roughness particles", "thermal accommodation particles",
        "real young modulus particles"},
       why},
      {properties,
       {"thermal conductivity wall", "microhardness wall", "surface slope wall",
        "surface roughness wall", "thermal accommodation wall", "real young modulus wall",
        "thermal conductivity gas", "specific heat gas", "specific heats ratio gas",
        "molecular mean free path gas"},
       why},
      {{"solid objects", "solid surfaces", "solid object *"}, {"thermal boundary type"}, why},
      {{"solid objects", "solid surfaces", "solid object *", "temperature"}, {}, why}};
  return list;
}

const std::vector<Ignored> &ignored()
{
  static const std::string of_fluids = "is for flows of fluids.";
  static const std::string of_tables = "is not needed: what is recorded is in tables.";
  static const std::vector<Ignored> list = {
      {no_section, {"print parameters"}, "is not needed: used.prm holds all parameters."},
      {no_section, {"comment message"}, "is a remark."},
      {control,
       {"method", "bdf startup method", "startup time scaling", "adapt", "number mesh adapt",
        "max cfl", "max time step", "stop tolerance", "adaptative time step scaling",
        "respect capillary time-step constraint", "capillary time-step ratio", "subdivision",
        "adapt time step to respect CFL", "adapt time step to respect CTR",
        "max capillary time-step ratio", "time step independent of end time", "output qcriterion",
        "output vorticity", "output velocity gradient"},
       of_fluids},
      {control,
       {"override time step on restart"},
       "is not needed: the time step is always that of the input."},
      {control, {"output boundaries"}, "is not needed: cell averages draw the mesh."},
      {control, {"log precision"}, "is not needed."},
      {control, {"group files"}, "is not needed: every picture is one file of all ranks."},
      {{"timer"}, {}, "is not needed: summary.json has the times of all parts of the program."},
      {{"boundary forces"}, {"verbosity"}, of_tables},
      {{"post-processing", "solid forces"}, {"verbosity"}, of_tables},
      {{"post-processing", "particle wall collision statistics"}, {"verbosity"}, of_tables},
      {{"test"}, {}, "is not needed: --dump writes the complete state at the end."},
      {{"box refinement", "box *", "mesh"},
       {"simplex", "check diamond cells", "expand particle-wall contact search"},
       "is not needed."},
      {{"floating grid"},
       {},
       "has no effect, in Lethe either: a grid that moves is a solid, in 'solid objects'."},
      {{"floating grid", "*"}, {}, "has no effect."},
      {mesh,
       {"check diamond cells", "expand particle-wall contact search"},
       "is not needed: walls are found from every cell."},
      {mesh,
       {"initial boundary refinement", "boundaries refined"},
       "has no effect on particles, in Lethe either: see 'box refinement'."},
      {{"model parameters", "adaptive sparse contacts"}, {"enable particle advection"}, of_fluids},
      {{"model parameters", "adaptive sparse contacts"},
       {"granular temperature threshold", "solid fraction threshold"},
       "is for cells, whose mean motion hides that of a grain: here each particle has its 'rest "
       "speed'."},
      {insertion,
       {"insertion plane threshold distance"},
       "is not needed: a cell takes a particle if it is empty."},
      {properties,
       {"dynamic viscosity gas"},
       "is for heat between particles, not for drag, which has its own in 'model parameters / "
       "drag'."},
      {{"solid objects", "solid volumes"}, {}, "has no effect, as in Lethe."},
      {{"solid objects", "solid volumes", "*"}, {}, "has no effect."},
      {{"solid objects", "solid volumes", "*", "*"}, {}, "has no effect."}};
  return list;
}

const std::vector<Refused> &refused()
{
  static const std::string heat = "Heat between particles is out of scope.";
  static const std::vector<Refused> list = {
      {no_section, "dimension", "3", "Simulations are in three dimensions: give 3."},
      {control, "output times", "-1",
       "Single moments cannot be chosen: give 'output time', or an 'output time interval' around "
       "them."},
      {properties, "density gas", "0", "It is 'density' in 'model parameters / drag' now."},
      {model, "solver type", "dem", heat + " Give dem."},
      {model, "disable position integration", "false", heat + " Give false."},
      {mesh, "simplex", "false", "Background meshes are made of hexahedra: give false."}};
  return list;
}

} // namespace eunoe::lethe_rules
