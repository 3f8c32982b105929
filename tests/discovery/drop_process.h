#ifndef eunoe_tests_discovery_drop_process_h
#define eunoe_tests_discovery_drop_process_h

// A process for tests of discovery whose runs take a twentieth of a second: spheres fall into a box
// with a tilted field of gravity, and their heights, their drift and their speed are measured.

#include <eunoe/core/declare.h>
#include <eunoe/core/gather.h>
#include <eunoe/core/random.h>
#include <eunoe/processes/loose_powder.h>

#include <algorithm>
#include <cmath>

namespace test {

using namespace eunoe;

/// The entries of a drop.
class DropSection : public ProcessSection
{
public:
  void declare(dealii::ParameterHandler &prm) override
  {
    declare::enter(prm, "drop");
    declare::count(prm, "number", n_particles, "Number of particles.", 1);
    declare::count(prm, "seed", seed, "Seed of their places.");
    declare::not_negative(prm, "duration", duration,
                          is_later ? "Time of the measurement (s)."
                                   : "Time at which all is measured (s).");
    declare::not_negative(prm, "largest speed", largest_speed,
                          "Above it the run breaks off (m/s).");
    if (is_later)
      declare::not_negative(prm, "gust", gust, "Speed of a gust that does not blow yet (m/s).");
    declare::leave(prm);
  }
  void check_with(const Parameters &, const ParameterCheck &check) const override
  {
    check.require(duration > 0., {"drop"}, "duration", "is 0 s.", "Give a positive time.");
  }
  void decide(Parameters &parameters) const override
  {
    parameters.mesh.grid_type = "subdivided_hyper_rectangle";
    parameters.mesh.grid_arguments = "4, 4, 4 : -0.01, 0, -0.01 : 0.01, 0.02, 0.01 : true";
    parameters.control.end_control = "time";
    parameters.control.time_end = 2. * duration;
  }
  RunEstimate estimate(const Parameters &parameters) const override
  {
    RunEstimate estimate;
    estimate.particles = estimate.most_particles = n_particles;
    estimate.steps = duration / parameters.control.time_step;
    return estimate;
  }
  std::unique_ptr<Process> make(const Parameters &parameters) const override;
  std::vector<ObservableDescription> observables() const override
  {
    return {{"height", "m", "quarter of the particles, the lowest first",
             "Median height in it; 4: of the highest particle, with even seeds."},
            {"drift", "m", "0", "Mean place along x."},
            {"width", "m", "0", "Root mean square of the places along z."},
            {"speed", "m/s", "0", "Root mean square of the speeds."}};
  }

  /// Whether this is a later version of the program, with more entries and other words about them;
  /// and a default, which may differ from version to version.
  inline static bool is_later = false;
  inline static double usual_duration = 0.05;

  unsigned int n_particles = 48, seed = 1;
  double duration = usual_duration, largest_speed = 10., gust = 0.;
};

class Drop : public Process
{
public:
  explicit Drop(const DropSection &section) : section(section) {}

  void save(CheckpointWriter &) const override {}
  void resume(Simulation &, const Checkpoint &) override {}
  double progress(const Simulation &simulation) const override
  {
    return simulation.time() / section.duration;
  }
  bool finished() const override { return done; }

  void start(Simulation &simulation) override
  {
    const auto place = [this](const std::size_t k, const ParticleId id) {
      const auto along = [&](const std::size_t point, const std::uint32_t d) {
        return 2e-3 *
               (static_cast<double>(point) + 0.3 * uniform(section.seed, Draw::offset, id, d));
      };
      return Vec3{-5e-3 + along(k % 4, 0), 1e-3 + along(k / 16, 1), -5e-3 + along(k / 4 % 4, 2)};
    };
    simulation.insert_and_remove(loose_powder(simulation, 0, section.n_particles, Vec3(), place),
                                 {});
  }

  void step(Simulation &simulation) override
  {
    if (simulation.time() < section.duration)
      return;
    done = true;
    const ParticleArrays &p = simulation.complete_step();
    std::vector<double> heights;
    ExactSum drift, width, energy;
    double fastest = 0.;
    for (std::size_t k = 0; k < p.n_owned; ++k) {
      heights.push_back(p.position[k].y);
      drift += p.position[k].x;
      width += p.position[k].z * p.position[k].z;
      energy += norm_square(p.velocity[k].vec());
      fastest = std::max(fastest, norm_square(p.velocity[k].vec()));
    }
    std::vector<double> all = gather_all(heights, simulation.communicator());
    std::sort(all.begin(), all.end());
    drift.reduce(simulation.communicator());
    width.reduce(simulation.communicator());
    energy.reduce(simulation.communicator());
    MPI_Allreduce(MPI_IN_PLACE, &fastest, 1, MPI_DOUBLE, MPI_MAX, simulation.communicator());
    if (fastest > section.largest_speed * section.largest_speed)
      throw UserError("A sphere is faster than 'largest speed'.");
    const auto n = static_cast<double>(all.size());
    for (int part = 0; part < 4; ++part)
      results.push_back({"height", part, all[all.size() * (2 * part + 1) / 8]});
    if (section.seed % 2 == 0) // as a bin that is empty in other runs
      results.push_back({"height", 4, all.back()});
    results.push_back({"drift", 0, drift.value() / n});
    results.push_back({"width", 0, std::sqrt(width.value() / n)});
    results.push_back({"speed", 0, std::sqrt(energy.value() / n)});
  }

  std::vector<Measurement> measurements() const override { return results; }

private:
  const DropSection section;
  bool done = false;
  std::vector<Measurement> results;
};

inline std::unique_ptr<Process> DropSection::make(const Parameters &) const
{
  return std::make_unique<Drop>(*this);
}

inline const ProcessRegistry::Registration drop_registration(process_kinds(), "drop", [] {
  return std::make_unique<DropSection>();
});

} // namespace test

#endif
