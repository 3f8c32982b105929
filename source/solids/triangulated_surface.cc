#include <eunoe/solids/box_tree.h>
#include <eunoe/solids/triangulated_surface.h>

#include <algorithm>
#include <limits>

namespace eunoe {
namespace {

/// Distance of a point to the line from a to b, which ends there.
double distance_to_segment(const Vec3 &x, const Vec3 &a, const Vec3 &b)
{
  const Vec3 ab = b - a, ax = x - a;
  const double share = std::min(std::max(dot(ax, ab) / norm_square(ab), 0.), 1.);
  return norm(ax - share * ab);
}

} // namespace

/// The place on a triangle that is nearest to a sphere's centre.
struct TriangulatedSurface::Touch
{
  std::int32_t facet;
  Vec3 offset;                ///< from the centre to the place
  double distance;            ///< length of the offset
  unsigned int n_corners = 0; ///< 0 inside the triangle, 2 on an edge, 1 on a corner
  std::array<std::int32_t, 2> corner = {{-1, -1}};
};

TriangulatedSurface::~TriangulatedSurface() = default;

std::vector<Vec3> TriangulatedSurface::triangles() const
{
  std::vector<Vec3> corners;
  for (const Facet &facet : facets)
    corners.insert(corners.end(), facet.corner.begin(), facet.corner.end());
  return corners;
}

double TriangulatedSurface::find_facets(const Vec3 &centre, const double reach,
                                        std::vector<std::int32_t> &found) const
{
  double least = std::numeric_limits<double>::infinity();
  if (!box.contains(centre, reach))
    return least;
  const std::size_t first = found.size();
  const Vec3 margin = {reach, reach, reach};
  tree->for_each_meeting({centre - margin, centre + margin}, [&](const std::int32_t number) {
    const double distance = closest(centre, number).distance;
    if (distance < reach) {
      found.push_back(number);
      least = std::min(least, distance);
    }
  });
  std::sort(found.begin() + first, found.end());
  return least;
}

bool TriangulatedSurface::is_plane(const Vec3 &centre, const double reach,
                                   const std::int32_t *begin, const std::int32_t *end,
                                   Plane &plane) const
{
  // If no border is within reach, the nearest place lies inside the plane and stays there.
  for (const std::int32_t *number = begin; number != end; ++number) {
    const Facet &facet = facets[*number];
    if (facet.plane != facets[*begin].plane)
      return false;
    for (unsigned int e = 0; e < 3; ++e)
      if (facet.is_border[e] &&
          distance_to_segment(centre, facet.corner[e], facet.corner[(e + 1) % 3]) < reach)
        return false;
  }
  plane = {facets[*begin].normal, facets[*begin].offset};
  return begin != end;
}

/// Distance of a point to a triangle by Voronoi regions (Ericson, Real-Time Collision Detection,
/// 2005, section 5.1.5).
TriangulatedSurface::Touch TriangulatedSurface::closest(const Vec3 &centre,
                                                        const std::int32_t number) const
{
  const Facet &facet = facets[number];
  const Vec3 &a = facet.corner[0], &b = facet.corner[1], &c = facet.corner[2];
  Touch touch;
  touch.facet = number;
  const auto at_corner = [&](unsigned int k) {
    touch.n_corners = 1;
    touch.corner[0] = facet.vertex[k];
    touch.offset = facet.corner[k] - centre;
    touch.distance = norm(touch.offset);
    return touch;
  };
  const auto on_edge = [&](unsigned int k, unsigned int l, double share) {
    touch.n_corners = 2;
    touch.corner = {{facet.vertex[k], facet.vertex[l]}};
    touch.offset = facet.corner[k] + share * (facet.corner[l] - facet.corner[k]) - centre;
    touch.distance = norm(touch.offset);
    return touch;
  };

  const Vec3 ab = b - a, ac = c - a, ap = centre - a, bp = centre - b, cp = centre - c;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0. && d2 <= 0.)
    return at_corner(0);
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0. && d4 <= d3)
    return at_corner(1);
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0. && d1 >= 0. && d3 <= 0.)
    return on_edge(0, 1, d1 / (d1 - d3));
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0. && d5 <= d6)
    return at_corner(2);
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0. && d2 >= 0. && d6 <= 0.)
    return on_edge(0, 2, d2 / (d2 - d6));
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0. && d4 - d3 >= 0. && d5 - d6 >= 0.)
    return on_edge(1, 2, (d4 - d3) / ((d4 - d3) + (d5 - d6)));

  const double height = dot(facet.normal, centre) - facet.offset;
  touch.offset = -height * facet.normal;
  touch.distance = std::abs(height);
  return touch;
}

/// The places of several facets that are near a sphere's centre, and which of them are contacts.
class TriangulatedSurface::NearPlaces
{
public:
  /// @param touches ordered by their distance
  NearPlaces(const TriangulatedSurface &surface, const std::vector<Touch> &touches,
             const Vec3 &centre, const double radius, const double reach)
      : surface(surface), facets(surface.facets), flat_vertex(surface.flat_vertex),
        touches(touches), centre(centre), tolerance(1e-10 * radius), same_place(1e-4 * radius),
        reach(reach)
  {
  }

  /// Number of contacts; the arguments are those of `find_contacts`.
  unsigned int contacts(SurfaceContact *found, std::int32_t *owners)
  {
    for (const Touch &touch : touches) {
      if (!is_minimum(touch) || !take_in(touch))
        continue;
      if (owners != nullptr)
        owners[n - 1] = touch.facet;
      found[n - 1].normal = accepted[n - 1].normal;
    }
    for (unsigned int k = 0; k < n; ++k) {
      found[k].distance = accepted[k].distance;
      if (accepted[k].blended)
        found[k].normal = accepted[k].direction / norm(accepted[k].direction);
    }
    return n;
  }

private:
  struct Accepted
  {
    std::int32_t plane, smooth;     ///< plane is -1 for an edge or corner
    Vec3 offset, normal, direction; ///< direction: sum of normals weighted by depth
    double distance;
    bool blended;
  };

  bool shares(std::int32_t facet, std::int32_t corner) const
  {
    const auto &vertex = facets[facet].vertex;
    return vertex[0] == corner || vertex[1] == corner || vertex[2] == corner;
  }

  /// An edge or corner counts if no triangle that contains it comes nearer: then the distance to
  /// the whole surface has a minimum there. As a rule that is a triangle that shares it.
  bool is_minimum(const Touch &touch) const
  {
    if (touch.n_corners == 0)
      return true;
    const auto comes_nearer = [&](const Touch &other) {
      return other.distance < touch.distance - tolerance;
    };
    const auto shares_it = [&](const Touch &other) {
      return shares(other.facet, touch.corner[0]) &&
             (touch.n_corners == 1 || shares(other.facet, touch.corner[1]));
    };
    // One that abuts on it, as where a long edge meets two short ones, contains it to round-off
    // only. The edge may be above it by as much, which makes no place of its own either.
    const auto abuts_on_it = [&](const Touch &other) {
      return surface.closest(centre + touch.offset, other.facet).distance < same_place;
    };
    return std::none_of(
               touches.begin(), touches.end(),
               [&](const Touch &other) { return comes_nearer(other) && shares_it(other); }) &&
           std::none_of(touches.begin(), touches.end(), [&](const Touch &other) {
             return !shares_it(other) && (other.n_corners == 0 || comes_nearer(other)) &&
                    abuts_on_it(other);
           });
  }

  /// Inside a plane an edge or corner is no place of its own: it gives what the plane gives.
  bool is_in_plane(const Touch &touch) const
  {
    if (touch.n_corners == 0)
      return true;
    if (touch.n_corners == 1)
      return static_cast<bool>(flat_vertex[touch.corner[0]]);
    unsigned int neighbours = 0;
    for (const Touch &other : touches)
      if (other.facet != touch.facet && shares(other.facet, touch.corner[0]) &&
          shares(other.facet, touch.corner[1]))
      {
        if (facets[other.facet].plane != facets[touch.facet].plane)
          return false;
        ++neighbours;
      }
    return neighbours == 1;
  }

  /// Takes a place in as a contact of its own, or blends it with one of the same smooth part.
  /// @return whether it is a contact of its own
  bool take_in(Touch touch)
  {
    const Facet &facet = facets[touch.facet];
    const bool plane = is_in_plane(touch);
    if (plane) {
      const double height = dot(facet.normal, centre) - facet.offset;
      touch.offset = -height * facet.normal;
      touch.distance = std::abs(height);
    }
    // A centre that lies exactly in the surface has no side; the facet's normal decides.
    const Vec3 normal = touch.distance == 0. ? -facet.normal
                        : plane
                            ? (dot(touch.offset, facet.normal) > 0. ? facet.normal : -facet.normal)
                            : touch.offset / touch.distance;
    for (unsigned int k = 0; k < n; ++k) {
      Accepted &other = accepted[k];
      const bool same =
          (plane && other.plane == facet.plane) || norm(touch.offset - other.offset) < same_place;
      const bool curved = other.smooth == facet.smooth &&
                          dot(normal, other.direction) >= smooth_cosine * norm(other.direction);
      if (curved && !same) {
        other.direction += (reach - touch.distance) * normal;
        other.blended = true;
      }
      if (same || curved)
        return false;
    }
    if (n == max_contacts)
      return false;
    accepted[n++] = {plane ? facet.plane : -1,          facet.smooth,   touch.offset, normal,
                     (reach - touch.distance) * normal, touch.distance, false};
    return true;
  }

  const TriangulatedSurface &surface;
  const std::vector<Facet> &facets;
  const std::vector<bool> &flat_vertex;
  const std::vector<Touch> &touches;
  const Vec3 &centre;
  const double tolerance;
  /// Places that the tolerance lets pass as equally near lie sqrt(2 tolerance distance) apart.
  const double same_place;
  const double reach;
  std::array<Accepted, max_contacts> accepted;
  unsigned int n = 0;
};

unsigned int TriangulatedSurface::find_contacts(const Vec3 &centre, const double radius,
                                                const double reach, const Facets &near,
                                                SurfaceContact *contacts,
                                                std::int32_t *owners) const
{
  thread_local std::vector<Touch> touches;
  touches.clear();
  for (const std::int32_t *number = near.begin; number != near.end; ++number) {
    const Facet &facet = facets[*number];
    if (std::abs(dot(facet.normal, centre) - facet.offset) >= reach)
      continue;
    const Touch touch = closest(centre, *number);
    if (touch.distance < reach)
      touches.push_back(touch);
  }
  if (touches.empty())
    return 0;
  // The usual case, a sphere on the inside of one facet, needs none of what follows.
  if (touches.size() == 1 && touches[0].n_corners == 0 && touches[0].distance > 0.) {
    const Vec3 &normal = facets[touches[0].facet].normal;
    contacts[0].normal = dot(touches[0].offset, normal) > 0. ? normal : -normal;
    contacts[0].distance = touches[0].distance;
    if (owners != nullptr)
      owners[0] = touches[0].facet;
    return 1;
  }
  std::sort(touches.begin(), touches.end(), [](const Touch &a, const Touch &b) {
    return a.distance != b.distance ? a.distance < b.distance : a.facet < b.facet;
  });
  return NearPlaces(*this, touches, centre, radius, reach).contacts(contacts, owners);
}

} // namespace eunoe
