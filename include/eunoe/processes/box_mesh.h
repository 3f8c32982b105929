#ifndef eunoe_processes_box_mesh_h
#define eunoe_processes_box_mesh_h

#include <eunoe/domain/domain.h>

#include <array>

namespace eunoe {

/// Ids of the sides of the mesh that `box_mesh` describes.
namespace box_side {
constexpr unsigned int lower_x = 0, upper_x = 1, lower_y = 2, upper_y = 3, lower_z = 4, upper_z = 5;
constexpr std::array<unsigned int, 6> all = {
    {lower_x, upper_x, lower_y, upper_y, lower_z, upper_z}};
} // namespace box_side

/// The background mesh of a process: a box of cells that hold 8 to 10 particles of a settled bed,
/// in powers of two over a coarse mesh. Only averages over its cells depend on them. SI units.
/// Throws a UserError if there would be too many cells.
/// @param section of the process, for that sentence
/// @param skin of the contact search and range of the contact laws
MeshParameters box_mesh(const std::string &section, const Vec3 &lower, const Vec3 &upper,
                        double largest_diameter, double skin);

} // namespace eunoe

#endif
