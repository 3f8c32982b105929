#ifndef eunoe_solids_crossings_h
#define eunoe_solids_crossings_h

#include <eunoe/core/vec3.h>

#include <vector>

namespace eunoe {

/// Whether two surfaces pass through each other. Surfaces that only touch, along an edge or in a
/// common plane, do not.
/// @param a three corners per triangle, as from Shape::triangles; likewise @p b
/// @param tolerance up to which surfaces count as touching (m)
/// @param where if they do: a point of both (m)
bool surfaces_cross(const std::vector<Vec3> &a, const std::vector<Vec3> &b, double tolerance,
                    Vec3 &where);

} // namespace eunoe

#endif
