#include <eunoe/solids/motion.h>

namespace eunoe {

Rotation Rotation::by(const Vec3 &angle)
{
  const double a = norm(angle);
  if (a == 0.)
    return {};
  const Vec3 k = angle / a;
  const double c = std::cos(a), s = std::sin(a);
  const auto turn = [&](const Vec3 &v) {
    return c * v + s * cross(k, v) + (1. - c) * dot(k, v) * k;
  };
  return {turn({1., 0., 0.}), turn({0., 1., 0.}), turn({0., 0., 1.})};
}

} // namespace eunoe
