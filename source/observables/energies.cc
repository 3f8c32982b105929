#include <eunoe/simulation/simulation.h>

namespace eunoe {
namespace {

/// Momentum and energies of all particles, exact sums.
class Energies : public Observable
{
public:
  Energies(const RecordSection &section, Simulation &simulation)
      : frequency(section.frequency),
        file(simulation.output_folder().table(
            section.file + ".csv", {"time", "particles", "kinetic", "rotational", "potential",
                                    "momentum_x", "momentum_y", "momentum_z"}))
  {
  }

  void step(Simulation &simulation) override
  {
    if (simulation.step_number() % frequency == 0)
      file->write(look(simulation));
  }

  void finish(Simulation &simulation) override { last = look(simulation); }

  /// Of the end of the run.
  std::vector<Measurement> measurements() const override
  {
    std::vector<Measurement> all;
    const auto names = descriptions();
    for (std::size_t k = 0; k < names.size() && !last.empty(); ++k)
      all.push_back({names[k].name, 0, last[k + 1]});
    return all;
  }

  std::vector<ObservableDescription> descriptions() const override
  {
    return {{"particles", "1", "", "number of particles at the end"},
            {"kinetic_energy", "J", "", "energy of translation at the end"},
            {"rotational_energy", "J", "", "energy of rotation at the end"},
            {"potential_energy", "J", "", "potential energy at the end, from the origin"}};
  }

private:
  /// A row of the table, at present; collective.
  static std::vector<double> look(Simulation &simulation)
  {
    const ParticleArrays &p = simulation.complete_step();
    const Vec3 g = simulation.get_parameters().physics.gravity;
    ExactSum kinetic, rotational, potential;
    std::array<ExactSum, 3> momentum;
    for (std::size_t k = 0; k < p.n_owned; ++k) {
      const double mass = p.mass(k);
      const Vec3 v = p.velocity[k].vec();
      kinetic += 0.5 * mass * norm_square(v);
      rotational += 0.5 * p.moment_of_inertia(k) * norm_square(p.spin[k].vec());
      potential += -mass * dot(g, p.position[k].vec());
      for (unsigned int d = 0; d < 3; ++d)
        momentum[d] += mass * v[d];
    }
    std::vector<double> row = {simulation.time(),
                               static_cast<double>(simulation.get_system().n_global())};
    for (ExactSum *sum :
         {&kinetic, &rotational, &potential, &momentum[0], &momentum[1], &momentum[2]}) {
      sum->reduce(simulation.communicator());
      row.push_back(sum->value());
    }
    return row;
  }

  const unsigned long long frequency;
  const std::shared_ptr<CsvFile> file;
  std::vector<double> last;
};

const ObservableRegistry::Registration registration(observables(), "energies", [] {
  return std::make_unique<SectionOf<Energies>>(
      ParameterCheck::Path{"post-processing", "energies"},
      RecordSection::Texts{"Whether momentum and energies of the particles are recorded."},
      "energies");
});

} // namespace
} // namespace eunoe
