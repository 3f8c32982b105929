#include <eunoe/core/first_rank.h>
#include <eunoe/core/rows.h>
#include <eunoe/simulation/simulation.h>

#include <cstdio>
#include <iterator>

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
    Rows mine;
    std::vector<std::uint32_t> ids;
    for (std::size_t k = 0; k < p.n_owned; ++k) {
      const Quad &x = p.position[k], &v = p.velocity[k], &w = p.spin[k];
      // As the file names the columns.
      const double row[] = {x.x, x.y, x.z, v.x, v.y, v.z, w.x, w.y, w.z, 2. * p.radius(k)};
      mine.append(std::begin(row), std::end(row));
      ids.push_back(p.id[k]);
    }
    const RowViews rows = sort_rows(ids, std::move(mine), simulation.communicator()).rows;
    std::string text;
    if (is_first_rank(simulation.communicator()))
      text = "p_x; p_y; p_z; v_x; v_y; v_z; w_x; w_y; w_z; diameters;\n";
    for (std::size_t k = 0; k < rows.size(); ++k)
      for (const double *value = rows[k]; value != rows.end(k); ++value) {
        char cell[32];
        std::snprintf(cell, sizeof cell, "%.17g;%c", *value, value + 1 == rows.end(k) ? '\n' : ' ');
        text += cell;
      }
    simulation.output_folder().write_in_parts(name + ".csv", text);
  }

private:
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
