#include <eunoe/simulation/simulation.h>

namespace eunoe {
namespace {

/// Force and torque of the particles on every solid that is drawn, row by row.
class SolidForces : public Observable
{
public:
  SolidForces(const RecordSection &section, Simulation &simulation) : frequency(section.frequency)
  {
    const auto &solids = simulation.get_solids();
    // An object keeps its number if others are not drawn: its table may be continued.
    std::size_t next = 0;
    for (std::size_t s = 0; s < solids.size(); ++s) {
      if (solids[s].object || solids[s].output)
        ++next;
      if (!solids[s].output)
        continue;
      char number[8];
      std::snprintf(number, sizeof number, "_%02zu", next - 1);
      numbers.push_back(s);
      files.push_back(simulation.output_folder().table(
          section.file + number + ".csv", {"time", "f_x", "f_y", "f_z", "T_x", "T_y", "T_z"}));
    }
  }

  bool wants_solid_loads(unsigned long long step) const override { return step % frequency == 0; }

  void step(Simulation &simulation) override
  {
    if (!wants_solid_loads(simulation.step_number()))
      return;
    const std::vector<SolidLoad> loads = simulation.global_solid_loads();
    for (std::size_t f = 0; f < files.size(); ++f) {
      std::vector<double> row = {simulation.time()};
      for (const auto *sums : {&loads[numbers[f]].force, &loads[numbers[f]].torque})
        for (const ExactSum &sum : *sums)
          row.push_back(sum.value());
      files[f]->write(row);
    }
  }

private:
  const unsigned long long frequency;
  std::vector<std::size_t> numbers;
  std::vector<std::shared_ptr<CsvFile>> files;
};

const ObservableRegistry::Registration registration(observables(), "solid forces", [] {
  return std::make_unique<SectionOf<SolidForces>>(
      ParameterCheck::Path{"post-processing", "solid forces"},
      RecordSection::Texts{
          "Whether force and torque of the particles on every solid are recorded.",
          "Beginning of the names of the files, one a solid, with the columns time, f_x, f_y, "
          "f_z, T_x, T_y, T_z (N, N m; torque about the centre of rotation).",
          "_#.csv"},
      "solid_forces");
});

} // namespace
} // namespace eunoe
