#include <eunoe/simulation/simulation.h>

#include <array>
#include <optional>

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
    if (simulation.step_number() % frequency != 0)
      return;
    const Sums now = look(simulation);
    file->write({simulation.time(), now.particles, now.kinetic, now.rotational, now.potential,
                 now.momentum.x, now.momentum.y, now.momentum.z});
  }

  void finish(Simulation &simulation) override { last = look(simulation); }

  /// Of the end of the run.
  std::vector<Measurement> measurements() const override
  {
    if (!last)
      return {};
    return {{"particles_at_end", 0, last->particles},
            {"kinetic_energy", 0, last->kinetic},
            {"rotational_energy", 0, last->rotational},
            {"potential_energy", 0, last->potential}};
  }

  std::vector<ObservableDescription> descriptions() const override
  {
    return {{"particles_at_end", "1", "", "number of particles"},
            {"kinetic_energy", "J", "", "energy of translation at the end"},
            {"rotational_energy", "J", "", "energy of rotation at the end"},
            {"potential_energy", "J", "", "potential energy at the end, from the origin"}};
  }

private:
  /// Of all particles.
  struct Sums
  {
    double particles, kinetic, rotational, potential; ///< number, then energies (J)
    Vec3 momentum;                                    ///< (kg m/s)
  };

  /// At present; collective.
  static Sums look(Simulation &simulation)
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
    const auto total = [&simulation](ExactSum &sum) {
      sum.reduce(simulation.communicator());
      return sum.value();
    };
    return {static_cast<double>(simulation.get_system().n_global()),
            total(kinetic),
            total(rotational),
            total(potential),
            {total(momentum[0]), total(momentum[1]), total(momentum[2])}};
  }

  const unsigned long long frequency;
  const std::shared_ptr<CsvFile> file;
  std::optional<Sums> last;
};

const ObservableRegistry::Registration registration(observables(), "energies", [] {
  return std::make_unique<SectionOf<Energies>>(
      ParameterCheck::Path{"post-processing", "energies"},
      RecordSection::Texts{"Whether momentum and energies of the particles are recorded."},
      "energies");
});

} // namespace
} // namespace eunoe
