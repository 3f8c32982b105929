// Surfaces of deal.II's generators: quadrilaterals in space, cut into triangles.

#include <eunoe/core/deal_ii_message.h>
#include <eunoe/solids/solid_parameters.h>

#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/tria.h>

#include <stdexcept>

namespace eunoe {

TriangleMesh generate_surface(const std::string &type, const std::string &arguments,
                              const unsigned int refinement)
{
  dealii::Triangulation<2, 3> surface;
  try {
    dealii::GridGenerator::generate_from_name_and_arguments(surface, type, arguments);
    surface.refine_global(refinement);
  } catch (const std::exception &error) {
    throw std::invalid_argument("the surface cannot be made (" + deal_ii_message(error) + ")");
  }
  TriangleMesh mesh;
  for (const auto &cell : surface.active_cell_iterators()) {
    const auto corner = [&](const unsigned int v) -> Vec3 {
      return {cell->vertex(v)[0], cell->vertex(v)[1], cell->vertex(v)[2]};
    };
    mesh.add_quad(corner(0), corner(1), corner(3), corner(2));
  }
  return mesh;
}

} // namespace eunoe
