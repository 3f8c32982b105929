#include <eunoe/solids/solid.h>

#include <algorithm>

namespace eunoe {

double displacement(const Solid &solid, const RigidState &before, const RigidState &after)
{
  if (!solid.motion->rotates())
    return norm(after.centre - before.centre);
  const Box box = solid.shape->bounding_box();
  double largest = 0.;
  for (unsigned int corner = 0; corner < 8; ++corner) {
    const Vec3 x = {corner & 1 ? box.upper.x : box.lower.x, corner & 2 ? box.upper.y : box.lower.y,
                    corner & 4 ? box.upper.z : box.lower.z};
    largest = std::max(largest, norm(after.centre + after.rotation.apply(x) - before.centre -
                                     before.rotation.apply(x)));
  }
  return largest;
}

} // namespace eunoe
