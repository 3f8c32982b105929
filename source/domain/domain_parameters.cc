#include <eunoe/core/declare.h>
#include <eunoe/domain/domain.h>

#include <cmath>
#include <set>

namespace eunoe {

namespace {

const std::string refinement_section = "box refinement";
const std::string motion_section = "grid motion";
const std::string boundary_section = "DEM boundary conditions";

std::string condition_section(std::size_t k)
{
  return "boundary condition " + std::to_string(k);
}

} // namespace

void MeshParameters::declare(dealii::ParameterHandler &prm)
{
  for (const std::string &name : path)
    declare::enter(prm, name);
  declare::choice(prm, "type", type, "dealii|gmsh|lethe",
                  "Origin of the background mesh: a generator of deal.II, a Gmsh file of "
                  "hexahedra, or one of Lethe's own cylinders.");
  declare::file(prm, "file name", file, "gmsh: the file.");
  declare::entry(prm, "grid type", grid_type,
                 "dealii: name of the generator, for example subdivided_hyper_rectangle; lethe: "
                 "cylinder_classic, cylinder_balanced, cylinder_squared or "
                 "cylinder_regularized.");
  declare::entry(prm, "grid arguments", grid_arguments,
                 "dealii: arguments of the generator, separated by ':'; lethe: layers of cells "
                 "along x : radius : half the length (m).");
  declare::between(prm, "initial refinement", refinement, 0, 12,
                   "Number of times that every cell is cut into eight.");
  declare::entry(prm, "enable target size", has_target,
                 "Whether the mesh is refined by 'target size' instead.");
  declare::entry(prm, "target size", target_size,
                 "Cells are cut until one more cut would make the diagonal of the smallest less "
                 "than this (m).");
  placement.declare(prm);
  for (std::size_t k = 0; k < path.size(); ++k)
    declare::leave(prm);
}

void MeshParameters::check(const ParameterCheck &check) const
{
  check.require(type != "gmsh" || file != "none", path, "file name",
                "is missing while the type is 'gmsh'.", "Name the mesh file.");
  check.require(!has_target || (target_size > 0. && std::isfinite(target_size)), path,
                "target size", "is " + format(target_size) + ".", "Give a positive length.");
  placement.check(check, path);
}

RefinementParameters::RefinementParameters(const unsigned int n)
{
  for (unsigned int k = 0; k < n; ++k)
    regions.push_back(
        {MeshParameters({refinement_section, "box " + std::to_string(k), "mesh"}), 0});
}

void RefinementParameters::declare(dealii::ParameterHandler &prm)
{
  declare::enter(prm, refinement_section);
  declare::number_of(prm, "number of refinement boxes", regions.size(), 0, 20,
                     "Number of the subsections 'box 0', ..., in which the mesh is finer.");
  declare::leave(prm);
  for (Region &region : regions) {
    region.mesh.declare(prm);
    declare::enter(prm, refinement_section);
    declare::enter(prm, region.mesh.path[1]);
    declare::between(prm, "additional refinement", region.additional, 0, 12,
                     "Number of times that every cell of the background mesh that meets the box "
                     "around this mesh is cut into eight.");
    declare::leave(prm);
    declare::leave(prm);
  }
}

void RefinementParameters::check(const ParameterCheck &check) const
{
  for (const Region &region : regions)
    region.mesh.check(check);
}

void GridMotionParameters::declare(dealii::ParameterHandler &prm)
{
  declare::enter(prm, motion_section);
  declare::choice(prm, "motion type", type, "none|translational|rotational",
                  "How the background mesh moves, with all its walls and outlets.");
  for (unsigned int d = 0; d < 3; ++d)
    declare::entry(prm, std::string("grid translational velocity ") + "xyz"[d], velocity[d],
                   "translational: velocity (m/s).");
  declare::entry(prm, "grid rotational speed", speed, "rotational: angular velocity (rad/s).");
  declare::between(prm, "grid rotational axis", axis, 0, 2,
                   "rotational: the coordinate axis about which it turns, 0, 1 or 2.");
  declare::leave(prm);
}

void GridMotionParameters::check(const ParameterCheck &check) const
{
  check.require(std::isfinite(speed) && std::isfinite(norm(velocity)), {motion_section},
                type == "rotational" ? "grid rotational speed" : "grid translational velocity x",
                "is no finite number.", "Give one.");
}

std::shared_ptr<const Motion> GridMotionParameters::make() const
{
  if (type == "none")
    return nullptr;
  Vec3 turning;
  turning[axis] = speed;
  const bool turns = type == "rotational";
  return std::make_shared<SteadyMotion>(turns ? Vec3() : velocity, turns ? turning : Vec3());
}

void BoundaryParameters::declare(dealii::ParameterHandler &prm)
{
  declare::enter(prm, boundary_section);
  declare::number_of(prm, "number of boundary conditions", conditions.size(), 0, 10,
                     "Number of the subsections 'boundary condition 0', ... Boundaries without one "
                     "are fixed walls.");
  for (std::size_t k = 0; k < conditions.size(); ++k) {
    BoundaryCondition &c = conditions[k];
    declare::enter(prm, condition_section(k));
    declare::count(prm, "boundary id", c.id, "The boundary (not for periodic ones).");
    declare::choice(prm, "type", c.type, "fixed_wall|outlet|translational|rotational|periodic",
                    "outlet: particles leave and are counted; translational and rotational: a wall "
                    "whose surface moves in place.");
    declare::entry(prm, "speed x", c.speed.x, "translational: velocity of the surface (m/s).");
    declare::entry(prm, "speed y", c.speed.y, "translational: velocity of the surface (m/s).");
    declare::entry(prm, "speed z", c.speed.z, "translational: velocity of the surface (m/s).");
    declare::entry(prm, "rotational speed", c.rotational_speed, "rotational: speed (rad/s).");
    declare::vector(prm, "rotational vector", c.rotation_axis,
                    "rotational: direction of the axis.");
    declare::vector(prm, "point on rotational vector", c.rotation_point,
                    "rotational: a point of the axis (m).");
    declare::count(prm, "periodic id 0", c.periodic_ids[0], "periodic: one boundary ...");
    declare::count(prm, "periodic id 1", c.periodic_ids[1], "periodic: ... and its partner.");
    declare::between(prm, "periodic direction", c.periodic_direction, 0, 2,
                     "periodic: axis from one to the other, 0, 1 or 2.");
    declare::leave(prm);
  }
  declare::leave(prm);
}

void BoundaryParameters::check(const ParameterCheck &check) const
{
  std::set<unsigned int> used;
  for (std::size_t k = 0; k < conditions.size(); ++k) {
    const BoundaryCondition &c = conditions[k];
    const ParameterCheck::Path path = {boundary_section, condition_section(k)};
    const auto use = [&](unsigned int id, const char *entry) {
      check.require(used.insert(id).second, path, entry,
                    "names boundary " + std::to_string(id) + ", which has a condition already.",
                    "Give each boundary one condition.");
    };
    if (c.type == "periodic") {
      use(c.periodic_ids[0], "periodic id 0");
      use(c.periodic_ids[1], "periodic id 1");
    } else
      use(c.id, "boundary id");
    check.require(c.type != "rotational" || norm(c.rotation_axis) > 0., path, "rotational vector",
                  "is zero.", "Give the direction of the axis.");
  }
}

} // namespace eunoe
