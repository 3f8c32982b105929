// A faceted cylinder acts as one curved wall, inside and outside: one contact, with the distance of
// the nearest facet, a normal that is radial to within half the angle of a facet, and a force that
// is continuous over the edges between facets. Reference: geometry of a regular polygon.
// Regression: at the 24 edges of a cylinder of 24 facets round-off decided on the contacts.

#include "surfaces.h"

using namespace test;

namespace {

/// Takes a sphere around the axis of a cylinder; @p side is -1 inside, 1 outside.
void examine(const std::string &where, double cylinder_radius, unsigned int n_facets, double side)
{
  const double R = 1e-4, half = M_PI / n_facets, apothem = cylinder_radius * std::cos(half);
  const Vec3 base = {1e-3, -2e-3, -4e-3}, axis = {0., 0., 8e-3};
  const TriangulatedSurface cylinder(shapes::cylinder_shell(base, axis, cylinder_radius, n_facets));
  const std::string name = where + " " + std::to_string(n_facets) + " facets";

  for (const double overlap : {1e-3, 0.05}) {
    // Inside, the flat part of a facet comes closest to the axis; outside, an edge does.
    const double way =
        side < 0. ? apothem - (1. - overlap) * R : cylinder_radius + (1. - overlap) * R;
    const std::string deep = overlap < 0.01 ? ", shallow" : ", deep";
    const auto force_of = [&](const SurfaceContact &contact) {
      return std::pow(std::max(0., 1. - contact.distance / R) / overlap, 1.5) * contact.normal;
    };
    constexpr int n = 20000;
    const double step = 3. * (2. * half) / n;
    int wrong = 0, n_contacts = 0;
    double worst_distance = 0., worst_tilt = 0., largest_jump = 0.;
    Vec3 last;
    for (int k = 0; k <= n; ++k) {
      const double angle = 0.3 + k * step;
      const Vec3 radial = {std::cos(angle), std::sin(angle), 0.};
      const auto found = contacts(cylinder, base + 0.4 * axis + way * radial, R);
      // The polygon's facet nearest to this direction; the shell's first corner may be anywhere.
      const Vec3 corner = cylinder.triangles()[0] - base;
      const double phase = std::remainder(angle - std::atan2(corner.y, corner.x) - half, 2. * half);
      const double to_plane = side * (way * std::cos(phase) - apothem);
      const double along = way * std::sin(std::abs(phase)) - cylinder_radius * std::sin(half);
      const double distance = along > 0. ? std::hypot(to_plane, along) : to_plane;
      if (found.size() != (distance < R ? 1 : 0)) {
        ++wrong;
        continue;
      }
      Vec3 force;
      if (found.size() == 1) {
        ++n_contacts;
        worst_distance = std::max(worst_distance, std::abs(found[0].distance - distance) / R);
        const double cosine = dot(-side * radial, found[0].normal);
        worst_tilt = std::max(worst_tilt, std::acos(std::min(1., cosine)));
        force = force_of(found[0]);
      }
      if (k > 0)
        largest_jump = std::max(largest_jump, norm(force - last));
      last = force;
    }
    check("one contact " + name + deep, wrong == 0 && n_contacts > n / 20,
          std::to_string(wrong) + " have another number");
    check_close("distance " + name + deep, worst_distance, 0., 1e-12);
    check_close("tilt " + name + deep, worst_tilt, 0., 1.001 * half);
    // While the path crosses a facet, the overlap and the normal change by at most this much.
    const double steady = step * way / R * (1.5 * std::sin(half) / overlap + 1.1);
    // A deep overlap reaches a facet at once when the foot of the perpendicular enters it; the
    // nearer one keeps the larger weight.
    const bool reaches_at_once =
        side < 0. && overlap > 2. * half * half * (cylinder_radius - way) / R;
    check_close("jump " + name + deep, largest_jump, 0., steady + (reaches_at_once ? half : 0.));
  }
}

} // namespace

EUNOE_TEST()
{
  for (const unsigned int n_facets : {24u, 36u, 90u, 360u}) {
    examine("inside", 4e-4, n_facets, -1.);
    examine("inside wide", 2e-3, n_facets, -1.);
    examine("outside", 4e-4, n_facets, 1.);
  }
}
