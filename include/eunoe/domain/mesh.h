#ifndef eunoe_domain_mesh_h
#define eunoe_domain_mesh_h

// The deal.II side of Domain, for source files only.

#include <eunoe/domain/domain.h>

#include <deal.II/base/point.h>
#include <deal.II/distributed/tria.h>

#include <optional>

namespace eunoe {

struct Domain::Mesh
{
  explicit Mesh(MPI_Comm comm) : triangulation(comm) {}

  dealii::parallel::distributed::Triangulation<3> triangulation;
  /// Whether all cells are boxes along the axes, with their corners in the order of these.
  bool has_boxes = false;
};

/// Most cells of a mesh.
constexpr double most_cells = 1e9;

/// Makes the mesh before its refinement; collective. Throws a UserError on every rank that says why
/// it cannot be made.
void create_mesh(dealii::Triangulation<3> &triangulation, const MeshParameters &mesh,
                 MPI_Comm comm);

/// The text of a file of Gmsh that holds hexahedra; collective. Throws a UserError on every rank
/// for any other.
std::string read_background_mesh(const MeshParameters &mesh, MPI_Comm comm);

/// A mesh of equal boxes as a single cell; empty for meshes that are not surely made of equal boxes
/// along the axes.
std::optional<MeshParameters> sketch_of(const MeshParameters &mesh);

/// Refuses a mesh with too many cells, as far as their number can be known beforehand. Throws a
/// UserError.
void check_mesh_size(const MeshParameters &mesh);

/// Makes one of Lethe's cylinders along x around the origin; the side has the boundary id 0, the
/// ends at the lower and the upper x have 1 and 2.
/// @param kind "cylinder_classic", ...: how a section is cut into cells
void create_cylinder(dealii::Triangulation<3> &triangulation, const std::string &kind,
                     unsigned int n_layers, double radius, double half_length);

/// How often all cells of a mesh are to be cut into eight. Throws a UserError if it gets too large.
unsigned int global_refinement(const dealii::Triangulation<3> &triangulation,
                               const MeshParameters &mesh);

inline dealii::Point<3> to_point(const Vec3 &v)
{
  return {v.x, v.y, v.z};
}
inline Vec3 to_vec3(const dealii::Tensor<1, 3> &p)
{
  return {p[0], p[1], p[2]};
}

} // namespace eunoe

#endif
