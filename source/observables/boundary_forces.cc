#include <eunoe/core/declare.h>
#include <eunoe/simulation/simulation.h>

#include <map>

namespace eunoe {
namespace {

class BoundaryForcesSection : public RecordSection
{
public:
  BoundaryForcesSection()
      : RecordSection({"boundary forces"},
                      {"Whether force and torque of the particles on every wall of the mesh are "
                       "recorded.",
                       "Beginning of the names of the files, one a boundary, with the columns "
                       "time, f_x, f_y, f_z, T_x, T_y, T_z (N, N m).",
                       "_#.csv"},
                      "force", 1)
  {
  }

  void declare(dealii::ParameterHandler &prm) override
  {
    RecordSection::declare(prm);
    declare::enter(prm, "boundary forces");
    declare::enter(prm, "center of mass coordinate");
    for (unsigned int d = 0; d < 3; ++d)
      declare::entry(prm, std::string(1, "xyz"[d]), centre[d],
                     "Point about which the torques are (m).");
    declare::leave(prm);
    declare::leave(prm);
  }

  Vec3 centre;
};

/// Force and torque of the particles on every wall of the mesh, row by row.
class BoundaryForces : public Observable
{
public:
  BoundaryForces(const BoundaryForcesSection &section, Simulation &simulation)
      : frequency(section.frequency), centre(section.centre)
  {
    // One boundary may have several sides.
    const std::vector<Solid> &solids = simulation.get_solids();
    for (std::size_t s = 0; s < solids.size(); ++s) {
      if (!solids[s].boundary)
        continue;
      const unsigned int id = *solids[s].boundary;
      Boundary &boundary = boundaries[id];
      boundary.walls.push_back(s);
      if (boundary.file == nullptr)
        boundary.file =
            simulation.output_folder().table(section.file + "_" + std::to_string(id) + ".csv",
                                             {"time", "f_x", "f_y", "f_z", "T_x", "T_y", "T_z"});
    }
  }

  bool wants_solid_loads(unsigned long long step) const override { return step % frequency == 0; }

  void step(Simulation &simulation) override
  {
    if (!wants_solid_loads(simulation.step_number()))
      return;
    const std::vector<SolidLoad> loads = simulation.global_solid_loads();
    for (const auto &[id, boundary] : boundaries) {
      Vec3 force, torque;
      for (const std::size_t w : boundary.walls) {
        const auto value = [](const std::array<ExactSum, 3> &sum) {
          return Vec3{sum[0].value(), sum[1].value(), sum[2].value()};
        };
        const Vec3 f = value(loads[w].force);
        force += f;
        torque +=
            value(loads[w].torque) + cross(simulation.get_solids()[w].state.centre - centre, f);
      }
      boundary.file->write(
          {simulation.time(), force.x, force.y, force.z, torque.x, torque.y, torque.z});
    }
  }

private:
  struct Boundary
  {
    std::vector<std::size_t> walls; ///< among the solids
    std::shared_ptr<CsvFile> file;
  };

  const unsigned long long frequency;
  const Vec3 centre;
  std::map<unsigned int, Boundary> boundaries; ///< by id
};

const ObservableRegistry::Registration registration(observables(), "boundary forces", [] {
  return std::make_unique<SectionOf<BoundaryForces, BoundaryForcesSection>>();
});

} // namespace
} // namespace eunoe
