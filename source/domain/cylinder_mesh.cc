// Lethe's own cylinders, which differ in how a section is cut into cells.

#include <eunoe/domain/mesh.h>

#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/manifold_lib.h>

#include <cmath>

namespace eunoe {

namespace {

constexpr dealii::types::manifold_id round = 0;

/// A section of the cylinder, round at its boundary, which has the id 0.
void create_section(dealii::Triangulation<2> &section, const std::string &kind, const double radius)
{
  const dealii::SphericalManifold<2> circle;
  if (kind == "cylinder_balanced")
    dealii::GridGenerator::hyper_ball_balanced(section, {}, radius);
  else {
    const double half_side = radius * std::sqrt(0.5);
    dealii::GridGenerator::hyper_cube(section, -half_side, half_side);
  }
  section.reset_all_manifolds();
  section.set_all_manifold_ids_on_boundary(round);
  section.set_manifold(round, circle);
  if (kind != "cylinder_regularized")
    return;
  // The corners of the square would be flat angles.
  dealii::Triangulation<2> fine;
  fine.copy_triangulation(section);
  fine.refine_global(2);
  dealii::GridTools::regularize_corner_cells(fine);
  section.clear();
  dealii::GridGenerator::flatten_triangulation(fine, section);
}

} // namespace

void create_cylinder(dealii::Triangulation<3> &triangulation, const std::string &kind,
                     const unsigned int n_layers, const double radius, const double half_length)
{
  if (kind == "cylinder_classic") {
    dealii::GridGenerator::subdivided_cylinder(triangulation, n_layers, radius, half_length);
    return;
  }
  dealii::Triangulation<2> section;
  create_section(section, kind, radius);
  dealii::GridGenerator::extrude_triangulation(section, n_layers + 1, 2. * half_length,
                                               triangulation, true);
  // The axis z becomes x, as of deal.II's cylinders.
  dealii::GridTools::transform(
      [half_length](const dealii::Point<3> &x) {
        return dealii::Point<3>(x[2] - half_length, x[1], -x[0]);
      },
      triangulation);
  triangulation.set_manifold(round, dealii::CylindricalManifold<3>(0));
}

} // namespace eunoe
