#include <eunoe/core/gather.h>
#include <eunoe/simulation/simulation.h>

#include <algorithm>
#include <array>

namespace eunoe {
namespace {

/// The particles at the end of the run, ordered by id, in the format of the 'file' insertion.
class FinalState : public Observable
{
public:
  FinalState(const RecordSection &section, Simulation &) : name(section.file) {}

  void finish(Simulation &simulation) override
  {
    const ParticleArrays &p = simulation.complete_step();
    std::vector<Row> mine;
    mine.reserve(p.n_owned);
    for (std::size_t k = 0; k < p.n_owned; ++k) {
      const Quad &x = p.position[k], &v = p.velocity[k], &w = p.spin[k];
      mine.push_back({p.id[k], {x.x, x.y, x.z, v.x, v.y, v.z, w.x, w.y, w.z, 2. * p.radius(k)}});
    }
    std::vector<Row> all = gather_on_first(mine, simulation.communicator());
    std::sort(all.begin(), all.end(), [](const Row &a, const Row &b) { return a.id < b.id; });
    std::string text = "p_x; p_y; p_z; v_x; v_y; v_z; w_x; w_y; w_z; diameters;\n";
    for (const Row &row : all)
      for (const double &value : row.columns) {
        char cell[32];
        std::snprintf(cell, sizeof cell, "%.17g;%c", value,
                      &value == &row.columns.back() ? '\n' : ' ');
        text += cell;
      }
    simulation.output_folder().write(name + ".csv", text);
  }

private:
  struct Row
  {
    ParticleId id;
    std::array<double, 10> columns; ///< as the file names them
  };

  const std::string name;
};

const ObservableRegistry::Registration registration(observables(), "final state", [] {
  return std::make_unique<SectionOf<FinalState>>(
      ParameterCheck::Path{"post-processing", "final state"},
      RecordSection::Texts{
          "Whether the particles are written at the end, in the format that the 'file' "
          "insertion reads."},
      "particles", 0);
});

} // namespace
} // namespace eunoe
