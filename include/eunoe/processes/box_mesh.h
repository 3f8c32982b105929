#ifndef eunoe_processes_box_mesh_h
#define eunoe_processes_box_mesh_h

#include <eunoe/domain/domain.h>

namespace eunoe {

/// The background mesh of a process: a box of cells that hold 8 to 10 particles of a settled bed,
/// in powers of two over a coarse mesh. Its sides have the ids 0 and 1 (x), 2 and 3 (y), 4 and 5
/// (z). SI units.
/// Throws a UserError if there would be too many cells.
/// @param section of the process, for that sentence
/// @param skin of the contact search and range of the contact laws
MeshParameters box_mesh(const std::string &section, const Vec3 &lower, const Vec3 &upper,
                        double largest_diameter, double skin);

} // namespace eunoe

#endif
