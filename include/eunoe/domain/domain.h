#ifndef eunoe_domain_domain_h
#define eunoe_domain_domain_h

#include <eunoe/core/parameter_section.h>
#include <eunoe/core/periodic_box.h>
#include <eunoe/solids/placement.h>
#include <eunoe/solids/solid.h>

#include <nlohmann/json_fwd.hpp>

#include <map>
#include <memory>
#include <mpi.h>
#include <set>

namespace eunoe {

/// `subsection mesh`: the background mesh that distributes the particles; or the mesh of a box in
/// which that one is refined.
struct MeshParameters : public ParameterSection
{
  ParameterCheck::Path path; ///< of the subsection
  std::string type = "dealii";
  std::string file = "none";
  std::string grid_type = "hyper_cube";
  std::string grid_arguments = "-1 : 1 : false";
  unsigned int refinement = 0;
  bool has_target = false; ///< refined to the target size instead
  double target_size = 1.; ///< of the cells (m)
  Placement placement;

  explicit MeshParameters(const ParameterCheck::Path &path = {"mesh"}) : path(path) {}

  void declare(dealii::ParameterHandler &prm) override;
  void check(const ParameterCheck &check) const override;
};

/// `subsection box refinement`: where the cells of the background mesh are cut further.
struct RefinementParameters : public ParameterSection
{
  struct Region
  {
    MeshParameters mesh;         ///< cells that meet the box around it are refined
    unsigned int additional = 0; ///< times that each is cut into eight
  };
  std::vector<Region> regions;

  explicit RefinementParameters(unsigned int n = 0);

  void declare(dealii::ParameterHandler &prm) override;
  void check(const ParameterCheck &check) const override;
};

/// `subsection grid motion`: the background mesh moves as a rigid body with all its walls.
struct GridMotionParameters : public ParameterSection
{
  std::string type = "none";
  Vec3 velocity;         ///< translational (m/s)
  double speed = 0.;     ///< rotational, about an axis through the origin (rad/s)
  unsigned int axis = 0; ///< rotational: 0, 1 or 2

  void declare(dealii::ParameterHandler &prm) override;
  void check(const ParameterCheck &check) const override;
  /// Null for a mesh that does not move.
  std::shared_ptr<const Motion> make() const;
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

class Enclosure;
class MeshBoundary;
struct Side;

/// A part of the boundary at which particles leave.
struct Outlet
{
  unsigned int boundary_id;
  Vec3 point, inward; ///< of the outlet's plane if the mesh is convex
};

/// What the background mesh is made of.
struct Background
{
  const MeshParameters &mesh;
  const RefinementParameters &refinement;
  std::shared_ptr<const Motion> motion; ///< null: at rest
  /// Whether somebody asks for its cells later. Else the mesh goes when its boundary is known, and
  /// one of equal boxes is not made at all: a single cell has the same walls, periods and outlets.
  bool needs_cells = true;
};

/// Number of cells of a mesh as far as it can be known before it is made; at least 1.
double expected_cells(const MeshParameters &mesh);

/// The space in which particles live: its periods, its walls and outlets, all from the background
/// mesh.
class Domain
{
public:
  /// Throws a UserError that says what is wrong with the mesh or its boundaries.
  Domain(const Background &background, const BoundaryParameters &boundaries, int wall_material,
         MPI_Comm comm);
  ~Domain();

  MPI_Comm communicator() const { return comm; }
  const PeriodicBox &periods() const { return box; }
  /// Corners of the box around the mesh, at the beginning if it moves (m).
  const Vec3 &lower() const { return lower_corner; }
  const Vec3 &upper() const { return upper_corner; }
  /// The box around the mesh however it turns, from its centre (m). It follows from the mesh alone:
  /// results must not depend on the length of the run.
  Box box_from_centre() const;
  /// Where the centre of the motion is (m), at first in the origin.
  const Vec3 &centre() const { return pose.centre; }

  /// Takes the mesh to where it is at a time (s).
  void move_to(double time);
  bool moves() const { return motion != nullptr; }
  /// A place in the frame of the mesh, in which its cells are at rest.
  Vec3 to_own_frame(const Vec3 &x) const { return in_frame(pose, x); }
  /// A place of that frame in space.
  Vec3 to_space(const Vec3 &x) const { return motion ? pose.rotation.apply(x) + pose.centre : x; }
  /// Notes that contacts are searched with the mesh where it is; `passed_outlet` refers to that
  /// place.
  void note_search() { earlier = pose; }
  /// Where it was at the last search; null for a mesh at rest.
  nlohmann::ordered_json save() const;
  /// Takes the mesh back there.
  void load(const nlohmann::ordered_json &saved);

  /// Cells of the background mesh of all ranks, as far as they were made.
  std::uint64_t n_cells() const { return number_of_cells; }

  /// Whether a position lies in the mesh; in periodic directions every one does.
  bool contains(const Vec3 &x) const;
  /// The outlet through which a particle has left on its straight way from one place, at the last
  /// search, to another, -1 if it has left through none.
  int passed_outlet(const Vec3 &from, const Vec3 &x) const;

  /// Walls of the domain, as solids that move only with the mesh.
  const std::vector<Solid> &walls() const { return wall_solids; }
  const std::vector<Outlet> &outlets() const { return outlet_list; }
  /// What the user should know of the conditions on its boundaries.
  const std::vector<Problem> &doubts() const { return list_of_doubts; }

  /// The background mesh, for the parts that speak deal.II (domain/mesh.h); only where its cells
  /// were said to be needed, else throws a std::logic_error.
  struct Mesh;
  const Mesh &mesh() const;

private:
  std::set<unsigned int> join_periodic_ends(const BoundaryParameters &boundaries,
                                            const std::vector<Side> &sides);
  Vec3 in_frame(const RigidState &frame, const Vec3 &x) const
  {
    return motion ? frame.rotation.undo(x - frame.centre) : x;
  }
  /// Finds the corners of the refined mesh and whether its cells are boxes.
  void measure();
  void make_boundaries(const BoundaryParameters &boundaries, int wall_material,
                       const MeshBoundary &boundary, const std::set<unsigned int> &periodic);
  /// Makes the surfaces of a mesh that is not convex.
  /// @param outlets their places in the list, by boundary id
  /// @param walls places in the list of those without a shape yet, by boundary id
  void make_surfaces(const MeshBoundary &boundary, const std::map<unsigned int, int> &outlets,
                     const std::map<unsigned int, int> &walls);

  MPI_Comm comm;
  std::unique_ptr<Mesh> mesh_data;
  PeriodicBox box;
  std::shared_ptr<const Motion> motion;
  RigidState pose, earlier;
  Vec3 lower_corner, upper_corner;
  std::uint64_t number_of_cells = 0;
  /// A point and the inward normal of every side of a convex mesh that is not periodic.
  std::vector<std::pair<Vec3, Vec3>> sides;
  std::unique_ptr<Enclosure> enclosure; ///< of any other mesh
  std::vector<Solid> wall_solids;
  std::vector<Outlet> outlet_list;
  std::vector<Problem> list_of_doubts;
};

} // namespace eunoe

#endif
