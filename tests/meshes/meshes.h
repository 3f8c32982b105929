#ifndef eunoe_tests_meshes_h
#define eunoe_tests_meshes_h

// Background meshes for the tests: Gmsh files of extruded sections, and the parts of input texts.

#include "../tests.h"

#include <fstream>
#include <map>
#include <sstream>

namespace test {

/// A section in the plane x, y of quadrilaterals, extruded along z.
struct Profile
{
  std::vector<std::array<double, 2>> points;      ///< (m)
  std::vector<std::array<unsigned int, 4>> quads; ///< corners in order around
  /// Boundary ids of edges by their points, the smaller first; other edges have the id 0.
  std::map<std::array<unsigned int, 2>, unsigned int> ids;
  double depth; ///< along z, from 0 (m); the ends have the ids 8 and 9
};

/// Writes the section as one layer of hexahedra, in Gmsh's format 2.2.
inline void write_mesh(const Profile &section, const std::string &file)
{
  std::vector<std::string> elements;
  const auto n = static_cast<unsigned int>(section.points.size());
  const auto add = [&](unsigned int type, unsigned int id, const std::vector<unsigned int> &nodes) {
    std::ostringstream line;
    line << elements.size() + 1 << " " << type << " 2 " << id << " " << id;
    for (const unsigned int node : nodes)
      line << " " << node + 1;
    elements.push_back(line.str());
  };
  std::map<std::array<unsigned int, 2>, unsigned int> uses;
  for (const auto &q : section.quads) {
    add(5, 0, {q[0], q[1], q[2], q[3], q[0] + n, q[1] + n, q[2] + n, q[3] + n});
    add(3, 8, {q[0], q[1], q[2], q[3]});
    add(3, 9, {q[0] + n, q[1] + n, q[2] + n, q[3] + n});
    for (unsigned int e = 0; e < 4; ++e) {
      const auto [a, b] = std::minmax(q[e], q[(e + 1) % 4]);
      ++uses[{{a, b}}];
    }
  }
  for (const auto &[edge, number] : uses) {
    const auto id = section.ids.find(edge);
    if (number == 1)
      add(3, id == section.ids.end() ? 0 : id->second,
          {edge[0], edge[1], edge[1] + n, edge[0] + n});
  }
  if (is_first_rank()) {
    std::ofstream stream(file);
    stream.precision(17);
    stream << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" << 2 * n << "\n";
    for (unsigned int layer = 0; layer < 2; ++layer)
      for (unsigned int k = 0; k < n; ++k)
        stream << layer * n + k + 1 << " " << section.points[k][0] << " " << section.points[k][1]
               << " " << layer * section.depth << "\n";
    stream << "$EndNodes\n$Elements\n" << elements.size() << "\n";
    for (const std::string &element : elements)
      stream << element << "\n";
    stream << "$EndElements\n";
  }
  MPI_Barrier(MPI_COMM_WORLD);
}

inline std::string control(double time_step, double time_end)
{
  std::ostringstream text;
  text.precision(17);
  text << "subsection simulation control\n set time step = " << time_step
       << "\n set time end = " << time_end
       << "\n set log frequency = 0\n set output path = results\nend\n";
  return text.str();
}

inline std::string generated_mesh(const std::string &type, const std::string &arguments,
                                  unsigned int refinement, const std::string &more = "")
{
  return "subsection mesh\n set grid type = " + type + "\n set grid arguments = " + arguments +
         "\n set initial refinement = " + std::to_string(refinement) + "\n" + more + "end\n";
}

inline std::string gmsh_mesh(const std::string &file, unsigned int refinement)
{
  return "subsection mesh\n set type = gmsh\n set file name = " + file +
         "\n set initial refinement = " + std::to_string(refinement) + "\nend\n";
}

/// Periodic directions (0, 1, 2) of a box whose boundaries have ids of their own.
inline std::string periodic_in(const std::vector<unsigned int> &directions)
{
  std::ostringstream text;
  text << "subsection DEM boundary conditions\n set number of boundary conditions = "
       << directions.size() << "\n";
  for (std::size_t k = 0; k < directions.size(); ++k)
    text << " subsection boundary condition " << k << "\n  set type = periodic\n"
         << "  set periodic id 0 = " << 2 * directions[k]
         << "\n  set periodic id 1 = " << 2 * directions[k] + 1
         << "\n  set periodic direction = " << directions[k] << "\n end\n";
  return text.str() + "end\n";
}

/// Boxes in which the mesh cells are refined further.
/// @param boxes two corners each
inline std::string refinement(const std::vector<std::string> &boxes, unsigned int times = 1)
{
  std::string text = "subsection box refinement\n set number of refinement boxes = " +
                     std::to_string(boxes.size()) + "\n";
  for (std::size_t k = 0; k < boxes.size(); ++k)
    text += " subsection box " + std::to_string(k) +
            "\n  set additional refinement = " + std::to_string(times) +
            "\n  subsection mesh\n"
            "   set grid type = hyper_rectangle\n   set grid arguments = " +
            boxes[k] + " : false\n  end\n end\n";
  return text + "end\n";
}

/// Young's modulus 1 MPa, Poisson's ratio 0.3, 1000 kg/m3: spheres of 1 mm take steps of 1e-5 s.
inline std::string powder(double diameter, double restitution, double friction,
                          const std::string &gravity, const std::string &more = "")
{
  std::ostringstream text;
  text << "subsection lagrangian physical properties\n set g = " << gravity
       << "\n subsection particle type 0\n  set diameter = " << diameter
       << "\n  set density particles = 1000\n  set restitution coefficient particles = "
       << restitution << "\n  set friction coefficient particles = " << friction << "\n"
       << more << " end\n set restitution coefficient wall = " << restitution
       << "\n set friction coefficient wall = " << friction
       << "\nend\nsubsection model parameters\n set rolling resistance torque method = none\nend\n";
  return text.str();
}

/// Inserts spheres at these positions.
inline std::string places(const std::vector<Vec3> &positions, const std::vector<Vec3> &velocities)
{
  std::ostringstream text;
  text.precision(17);
  text << "subsection insertion info\n set insertion method = list\n";
  for (const bool of_velocity : {false, true})
    for (unsigned int d = 0; d < 3; ++d) {
      text << " set list " << (of_velocity ? "velocity " : "") << "xyz"[d] << " = ";
      for (std::size_t k = 0; k < positions.size(); ++k)
        text << (k > 0 ? ", " : "") << (of_velocity ? velocities[k] : positions[k])[d];
      text << "\n";
    }
  text << "end\n";
  return text.str();
}

/// Runs a case alone on the first rank and on all together; both must end with the same bits.
/// @return the result on all ranks together
template <typename Result>
Result run_alone_and_together(const std::string &name,
                              const std::function<Result(MPI_Comm)> &result_of)
{
  Result alone;
  if (is_first_rank())
    alone = result_of(MPI_COMM_SELF);
  const Result together = result_of(MPI_COMM_WORLD);
  check(name + ": the same bits on any number of ranks", together == alone);
  return together;
}

} // namespace test

#endif
