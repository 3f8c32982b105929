#include <eunoe/core/declare.h>
#include <eunoe/core/expressions.h>
#include <eunoe/simulation/insertion.h>

#include <algorithm>

namespace eunoe {

namespace {
const std::string section = "insertion info";
} // namespace

InsertionRegistry &insertion_methods()
{
  static InsertionRegistry registry("insertion method");
  return registry;
}

std::pair<std::size_t, std::size_t> share_of(const std::size_t n, MPI_Comm comm)
{
  int rank, size;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &size);
  return {n * rank / size, n * (rank + 1) / size};
}

void InsertionParameters::declare(dealii::ParameterHandler &prm)
{
  using declare::Patterns::Double;
  using declare::Patterns::Integer;
  using declare::Patterns::List;
  prm.enter_subsection(section);
  declare::choice(
      prm, "insertion method", method, insertion_methods().names(),
      "Where the particles come from: a random grid in a box (volume), the lists of "
      "this section (list), files (file), the empty cells of the mesh that a plane cuts, "
      "one particle each (plane), or a dense random packing in a box (packed).");
  declare::count(prm, "inserted number of particles at each time step", per_event,
                 "volume: number of particles of an event.");
  declare::count(prm, "insertion frequency", frequency,
                 "Steps between events, the first of which is at the start; 0: a single event.");
  prm.add_parameter("list of input files", files,
                    "file: the files, one an event, with the header 'p_x; p_y; p_z; v_x; v_y; v_z; "
                    "w_x; w_y; w_z; diameters'; after the last the first is used again.");
  const std::pair<std::string, std::vector<double> *> lists[] = {
      {"list x", &list_x},           {"list y", &list_y},
      {"list z", &list_z},           {"list velocity x", &list_vx},
      {"list velocity y", &list_vy}, {"list velocity z", &list_vz},
      {"list omega x", &list_wx},    {"list omega y", &list_wy},
      {"list omega z", &list_wz},    {"list diameters", &list_diameters}};
  for (const auto &[name, values] : lists)
    prm.add_parameter(name, *values,
                      "list: one value a particle (SI units)" +
                          std::string(name.size() > 6 ? "; empty: 0, or the type's sizes." : "."),
                      List(Double()));
  prm.add_parameter("insertion direction sequence", directions,
                    "volume: axes in the order in which the box is filled.",
                    List(Integer(0, 2), 3, 3));
  declare::corners(prm, "insertion box points coordinates", box_lower, box_upper,
                   "volume, packed: two opposite corners of the box (m).");
  declare::vector(prm, "insertion plane point", plane_point, "plane: a point of the plane (m).");
  declare::vector(prm, "insertion plane normal vector", plane_normal,
                  "plane: direction normal to the plane.");
  prm.add_parameter("insertion distance threshold", distance_threshold,
                    "volume: distance of the grid points over the largest diameter.", Double(0.5));
  prm.add_parameter("insertion maximum offset", maximum_offset,
                    "volume: largest random shift of a particle over the largest diameter; plane: "
                    "likewise, as far as the particle stays in its cell.",
                    Double(0.));
  declare::count(prm, "insertion prn seed", seed,
                 "Seed of the random shifts (volume, plane) or places (packed).");
  prm.enter_subsection("insertion acceptance function");
  prm.add_parameter("Function expression", acceptance,
                    "Expression in x, y, z: volume uses points of the grid, and packed places, "
                    "where it is positive.");
  prm.add_parameter("Function constants", acceptance_constants,
                    "Constants of the expression, 'a=1, b=2'.");
  prm.leave_subsection();
  prm.add_parameter("remove particles", removes,
                    "Whether the removal box is emptied before every event.");
  declare::corners(prm, "removal box points coordinates", removal_lower, removal_upper,
                   "Two opposite corners of the removal box (m).");
  declare::vector(prm, "initial velocity", velocity,
                  "volume, plane, packed: velocity of the particles (m/s).");
  declare::vector(prm, "initial angular velocity", spin,
                  "volume, plane, packed: angular velocity of the particles (rad/s).");
  prm.leave_subsection();
}

void InsertionParameters::check(const ParameterCheck &check) const
{
  if (removes)
    check.require(removal_lower.x < removal_upper.x && removal_lower.y < removal_upper.y &&
                      removal_lower.z < removal_upper.z,
                  {section}, "removal box points coordinates",
                  "has a first corner that is not below the second in every direction.",
                  "Give the lower corner first.");
  if (method == "volume" || method == "packed") {
    try {
      Expressions(acceptance, acceptance_constants, 1);
    } catch (const std::invalid_argument &error) {
      check.require(false, {section, "insertion acceptance function"}, "Function expression",
                    "is not understood: " + std::string(error.what()) + ".",
                    "Write one expression in x, y and z.");
    }
    check.require(box_lower.x < box_upper.x && box_lower.y < box_upper.y &&
                      box_lower.z < box_upper.z,
                  {section}, "insertion box points coordinates",
                  "has a first corner that is not below the second in every direction.",
                  "Give the lower corner first.");
  }
  if (method == "volume") {
    std::vector<int> sorted = directions;
    std::sort(sorted.begin(), sorted.end());
    check.require(sorted == std::vector<int>({0, 1, 2}), {section}, "insertion direction sequence",
                  "does not name each axis once.", "Give a permutation of 0, 1, 2.");
    check.advise(maximum_offset <= distance_threshold - 1. + 1e-12, {section},
                 "insertion maximum offset",
                 "of " + format(maximum_offset) + " lets neighbours overlap at a threshold of " +
                     format(distance_threshold) + ".",
                 "Give at most 'insertion distance threshold' - 1, or raise the threshold.");
  }
  if (method == "plane")
    check.require(norm(plane_normal) > 0., {section}, "insertion plane normal vector", "is zero.",
                  "Give the direction normal to the plane.");
  if (method == "list") {
    const std::vector<const std::vector<double> *> others = {&list_y,  &list_z,  &list_vx,
                                                             &list_vy, &list_vz, &list_wx,
                                                             &list_wy, &list_wz, &list_diameters};
    check.require(!list_x.empty(), {section}, "list x", "is empty.",
                  "Give the coordinates of at least one particle.");
    for (std::size_t k = 0; k < others.size(); ++k)
      check.require(others[k]->size() == list_x.size() || (k >= 2 && others[k]->empty()), {section},
                    "list x",
                    "has " + std::to_string(list_x.size()) + " values, another list " +
                        std::to_string(others[k]->size()) + ".",
                    "Give one value a particle in every list.");
  }
  if (method == "file")
    check.require(!files.empty(), {section}, "list of input files", "is empty.",
                  "Name at least one file.");
}

} // namespace eunoe
