#ifndef eunoe_simulation_domain_h
#define eunoe_simulation_domain_h

#include <eunoe/core/parameter_section.h>
#include <eunoe/core/periodic_box.h>
#include <eunoe/solids/placement.h>
#include <eunoe/solids/solid.h>

#include <mpi.h>

namespace eunoe {

/// `subsection mesh`: the background mesh that distributes the particles.
struct MeshParameters : public ParameterSection
{
  std::string type = "dealii";
  std::string file = "none";
  std::string grid_type = "hyper_cube";
  std::string grid_arguments = "-1 : 1 : false";
  unsigned int refinement = 0;
  Placement placement;

  void declare(dealii::ParameterHandler &prm) override;
  void check(const ParameterCheck &check) const override;
};

/// `boundary condition i` of the input.
struct BoundaryCondition
{
  unsigned int id = 0;
  std::string type = "fixed_wall";
  Vec3 speed; ///< translational
  double rotational_speed = 0.;
  Vec3 rotation_axis = {1., 0., 0.}, rotation_point;
  unsigned int periodic_ids[2] = {0, 0};
  unsigned int periodic_direction = 0;
  int material = -1; ///< row among the Materials; -1: the common one of walls
};

/// `subsection DEM boundary conditions`. A boundary without a condition is a fixed wall.
struct BoundaryParameters : public ParameterSection
{
  std::vector<BoundaryCondition> conditions;

  explicit BoundaryParameters(unsigned int n = 0) : conditions(n) {}

  void declare(dealii::ParameterHandler &prm) override;
  void check(const ParameterCheck &check) const override;
};

/// A flat part of the boundary at which particles leave.
struct Outlet
{
  unsigned int boundary_id;
  Vec3 point, inward;

  bool has_passed(const Vec3 &x) const { return dot(x - point, inward) < 0.; }
};

/// The space in which particles live: the distributed background mesh, its periods, its walls and
/// outlets.
class Domain
{
public:
  /// Throws a UserError that says what is wrong with the mesh or its boundaries.
  Domain(const MeshParameters &mesh, const BoundaryParameters &boundaries, int wall_material,
         MPI_Comm comm);
  ~Domain();

  MPI_Comm communicator() const { return comm; }
  const PeriodicBox &periods() const { return box; }
  /// Corners of the box around the mesh (m).
  const Vec3 &lower() const { return lower_corner; }
  const Vec3 &upper() const { return upper_corner; }
  /// Whether a position lies in the mesh; in periodic directions every one does.
  bool contains(const Vec3 &x) const;
  /// Smallest distance of two opposite faces of a cell (m).
  double smallest_cell_width() const { return cell_width; }
  std::uint64_t n_cells() const;

  /// Walls of the domain, as solids that never move.
  const std::vector<Solid> &walls() const { return wall_solids; }
  const std::vector<Outlet> &outlets() const { return outlet_list; }

  /// The mesh itself, for the parts that speak deal.II (source/simulation/mesh.h).
  struct Mesh;
  Mesh &mesh() { return *mesh_data; }
  const Mesh &mesh() const { return *mesh_data; }

private:
  void find_boundaries(const BoundaryParameters &boundaries, int wall_material);

  MPI_Comm comm;
  std::unique_ptr<Mesh> mesh_data;
  PeriodicBox box;
  Vec3 lower_corner, upper_corner;
  double cell_width = 0.;
  /// A point and the inward normal of every flat part of the boundary that is not periodic.
  std::vector<std::pair<Vec3, Vec3>> sides;
  std::vector<Solid> wall_solids;
  std::vector<Outlet> outlet_list;
};

} // namespace eunoe

#endif
