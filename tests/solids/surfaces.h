#ifndef eunoe_tests_surfaces_h
#define eunoe_tests_surfaces_h

// What the tests of solid surfaces share: surfaces, and parts of input texts.

#include <eunoe/core/files.h>
#include <eunoe/solids/half_space.h>
#include <eunoe/solids/infinite_plane.h>
#include <eunoe/solids/shapes.h>

#include "../tests.h"

#include <algorithm>
#include <map>
#include <random>

namespace test {

/// The contacts of a sphere, with the facets searched anew.
inline std::vector<SurfaceContact> contacts(const Shape &shape, const Vec3 &centre, double radius)
{
  std::vector<std::int32_t> facets;
  shape.find_facets(centre, radius, facets);
  std::vector<SurfaceContact> found(Shape::max_contacts);
  found.resize(shape.find_contacts(centre, radius, radius, facets.data(),
                                   facets.data() + facets.size(), found.data()));
  return found;
}

/// The parallelogram with one corner and two edges as 2 n_u n_v triangles of uneven size, with
/// diagonals in both directions. Half way along v there is a row of edges that is straight and
/// parallel to u, with corners at uneven distances.
inline TriangleMesh uneven_plate(const Vec3 &corner, const Vec3 &u, const Vec3 &v, int n_u, int n_v)
{
  std::mt19937 generator(2);
  std::uniform_real_distribution<double> shift(-0.3, 0.3);
  TriangleMesh mesh;
  for (int j = 0; j <= n_v; ++j)
    for (int i = 0; i <= n_u; ++i) {
      const bool may_shift_u = i > 0 && i<n_u, may_shift_v = j> 0 && j < n_v && 2 * j != n_v;
      const double a = (i + (may_shift_u ? shift(generator) : 0.)) / n_u;
      const double b = (j + (may_shift_v ? shift(generator) : 0.)) / n_v;
      mesh.vertices.push_back(corner + a * u + b * v);
    }
  for (int j = 0; j < n_v; ++j)
    for (int i = 0; i < n_u; ++i) {
      const std::int32_t a = j * (n_u + 1) + i, b = a + 1, c = b + n_u + 1, d = a + n_u + 1;
      if (shift(generator) > 0.) {
        mesh.triangles.push_back({{a, b, c}});
        mesh.triangles.push_back({{d, a, c}});
      } else {
        mesh.triangles.push_back({{b, d, a}});
        mesh.triangles.push_back({{b, c, d}});
      }
    }
  return mesh;
}

/// A groove along z with its lowest line through the origin, its walls inclined by an angle.
inline TriangleMesh groove(double angle, int n_triangles)
{
  const double length = 4e-3;
  const Vec3 along = {0., 0., 2. * length};
  const Vec3 up = {length * std::cos(angle), length * std::sin(angle), 0.};
  const Vec3 start = {0., 0., -length};
  TriangleMesh mesh = uneven_plate(start, up, along, n_triangles, 6);
  TriangleMesh left = mesh;
  for (Vec3 &x : left.vertices)
    x.x *= -1.;
  const auto first = static_cast<std::int32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), left.vertices.begin(), left.vertices.end());
  for (const auto &t : left.triangles)
    mesh.triangles.push_back({{t[0] + first, t[1] + first, t[2] + first}});
  return mesh;
}

/// Writes a surface as a Gmsh file, format 2.2.
inline void write_gmsh(const TriangleMesh &mesh, const std::string &file)
{
  std::string text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" +
                     std::to_string(mesh.vertices.size()) + "\n";
  char line[128];
  for (std::size_t k = 0; k < mesh.vertices.size(); ++k) {
    const Vec3 &x = mesh.vertices[k];
    std::snprintf(line, sizeof line, "%zu %.17g %.17g %.17g\n", k + 1, x.x, x.y, x.z);
    text += line;
  }
  text += "$EndNodes\n$Elements\n" + std::to_string(mesh.triangles.size()) + "\n";
  for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
    const auto &t = mesh.triangles[k];
    std::snprintf(line, sizeof line, "%zu 2 2 0 1 %d %d %d\n", k + 1, t[0] + 1, t[1] + 1, t[2] + 1);
    text += line;
  }
  write_file(file, text + "$EndElements\n");
}

inline std::string text_of(double value)
{
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

inline std::string text_of(const Vec3 &v)
{
  return text_of(v.x) + ", " + text_of(v.y) + ", " + text_of(v.z);
}

/// One material for spheres and walls. Young's modulus is 1 MPa, Poisson's ratio 0.3, the density
/// 1000 kg/m3, so that spheres of 1 mm take steps of 1e-5 s.
struct Powder
{
  Vec3 gravity;
  double diameter = 1e-3, restitution = 0.5, friction = 0.5, rolling_friction = 0.;
  double surface_energy = 0.;

  double radius() const { return 0.5 * diameter; }
  double mass() const { return 1000. * M_PI / 6. * diameter * diameter * diameter; }
  /// Young's modulus of a contact, and the overlap at which Hertz's force is @p force.
  static constexpr double young = 1e6 / (2. * (1. - 0.3 * 0.3));
  double overlap(double force) const
  {
    return std::pow(force / (4. / 3. * young * std::sqrt(radius())), 2. / 3.);
  }

  std::string input() const
  {
    const auto material = [this](const std::string &of) {
      const std::pair<const char *, double> values[] = {{"young modulus ", 1e6},
                                                        {"poisson ratio ", 0.3},
                                                        {"restitution coefficient ", restitution},
                                                        {"friction coefficient ", friction},
                                                        {"rolling friction ", rolling_friction},
                                                        {"rolling viscous damping ", 0.3},
                                                        {"surface energy ", surface_energy},
                                                        {"hamaker constant ", 4e-19}};
      std::string text;
      for (const auto &[name, value] : values)
        text += " set " + (name + of) + " = " + text_of(value) + "\n";
      return text;
    };
    return "subsection lagrangian physical properties\n set g = " + text_of(gravity) +
           "\n subsection particle type 0\n set diameter = " + text_of(diameter) +
           "\n set density particles = 1000\n" + material("particles") + " end\n" +
           material("wall") + "end\nsubsection model parameters\n" +
           " set rolling resistance torque method = " + (rolling_friction > 0. ? "epsd" : "none") +
           "\n" +
           (surface_energy > 0. ? " set particle particle contact force method = DMT\n"
                                  " set particle wall contact force method = DMT\n"
                                : "") +
           "end\n";
  }
};

/// A sphere at the start.
struct Start
{
  Vec3 position, velocity, spin;
};

inline std::string insertion_input(const std::vector<Start> &starts)
{
  std::string text = "subsection insertion info\n set insertion method = list\n";
  const std::pair<const char *, Vec3 Start::*> vectors[] = {
      {"", &Start::position}, {"velocity ", &Start::velocity}, {"omega ", &Start::spin}};
  for (const auto &[name, vector] : vectors)
    for (unsigned int d = 0; d < 3; ++d) {
      text += std::string(" set list ") + name + "xyz"[d] + " =";
      for (std::size_t k = 0; k < starts.size(); ++k)
        text += (k > 0 ? ", " : " ") + text_of((starts[k].*vector)[d]);
      text += "\n";
    }
  return text + "end\n";
}

/// A solid from a Gmsh file, at rest unless told otherwise.
inline std::string gmsh_input(const std::string &file, const std::string &more = "")
{
  return "subsection solid objects\n subsection solid surfaces\n set number of solids = 1\n"
         " subsection solid object 0\n subsection mesh\n set type = gmsh\n set file name = " +
         file + "\n end\n" + more + " end\n end\nend\n";
}

/// Motion of a solid, for the function above and `shape_input`.
inline std::string motion_input(const std::string &velocity, const std::string &angular_velocity,
                                const Vec3 &centre)
{
  return " subsection translational velocity\n set Function expression = " + velocity +
         "\n end\n subsection angular velocity\n set Function expression = " + angular_velocity +
         "\n end\n set center of rotation = " + text_of(centre) + "\n";
}

/// A floating wall.
struct Wall
{
  Vec3 point, normal;
  double start = 0., end = 1.;
};

inline std::string walls_input(const std::vector<Wall> &walls)
{
  std::string text =
      "subsection floating walls\n set number of floating walls = " + std::to_string(walls.size()) +
      "\n";
  for (std::size_t k = 0; k < walls.size(); ++k)
    text += " subsection wall " + std::to_string(k) +
            "\n set point on wall = " + text_of(walls[k].point) +
            "\n set normal vector = " + text_of(walls[k].normal) +
            "\n set start time = " + text_of(walls[k].start) +
            "\n set end time = " + text_of(walls[k].end) + "\n end\n";
  return text + "end\n";
}

/// State of a sphere, with the memory of its contacts with solids.
struct TouchingSphere
{
  Vec3 position, velocity, spin, force, torque;
  std::vector<Vec3> normals;                 ///< one for each contact
  std::vector<std::vector<double>> memories; ///< one for each contact
};

/// The spheres of a run on one rank, by id.
inline std::vector<TouchingSphere> spheres(Simulation &simulation)
{
  const ParticleArrays &p = simulation.complete_step();
  const ContactRows rows = simulation.get_system().contact_rows();
  std::vector<TouchingSphere> all(p.n_owned);
  for (std::size_t k = 0; k < p.n_owned; ++k) {
    TouchingSphere &s = all.at(p.id[k] - 1);
    s.position = p.position[k].vec();
    s.velocity = p.velocity[k].vec();
    s.spin = p.spin[k].vec();
    s.force = p.force[k].vec();
    s.torque = p.torque[k].vec();
    for (const ContactRows::Record &record : rows.records(k))
      if (record.with_solid) {
        s.normals.push_back(record.normal);
        s.memories.emplace_back(record.history,
                                record.history + simulation.contact_model().history_size());
      }
  }
  return all;
}

/// Area of all triangles (m2).
inline double area(const TriangleMesh &mesh)
{
  double sum = 0.;
  for (const auto &t : mesh.triangles)
    sum += 0.5 * norm(cross(mesh.vertices[t[1]] - mesh.vertices[t[0]],
                            mesh.vertices[t[2]] - mesh.vertices[t[0]]));
  return sum;
}

/// Length of the edges that belong to one triangle only; -1 if some belong to more than two.
inline double open_length(TriangleMesh mesh)
{
  mesh.merge_vertices(1e-12);
  std::map<std::pair<int, int>, int> count;
  for (const auto &t : mesh.triangles)
    for (unsigned int e = 0; e < 3; ++e)
      ++count[std::minmax(t[e], t[(e + 1) % 3])];
  double sum = 0.;
  for (const auto &[edge, n] : count) {
    if (n > 2)
      return -1.;
    if (n == 1)
      sum += norm(mesh.vertices[edge.first] - mesh.vertices[edge.second]);
  }
  return sum;
}

} // namespace test

#endif
