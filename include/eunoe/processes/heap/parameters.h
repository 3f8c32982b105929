#ifndef eunoe_processes_heap_parameters_h
#define eunoe_processes_heap_parameters_h

#include <eunoe/simulation/process.h>

namespace eunoe::heap {

/// The subsection of the process.
inline const std::string section = "heap";

/// `subsection heap`: the heap instrument and what it does. SI units.
struct HeapParameters : public ProcessSection
{
  double tube_diameter = 10e-3, disc_diameter = 10e-3;
  double gap = 0., rim_height = 0.;
  unsigned int n_facets = 72;
  double lifting_velocity = 0.05;

  unsigned int n_particles = 0;
  double mass = 0.;
  double fill_ratio = 4.;
  double insertion_speed = 0.2;
  unsigned int seed = 1;

  double rest_energy_share = 0.01, moving_share = 0.005;
  unsigned long long rest_check_frequency = 200;
  double rest_duration = 5e-3;
  double longest_wait = 0.5;
  double measurement_delay = 0.;

  unsigned int n_views = 16, n_bins = 100, n_rings = 5, n_density_layers = 2;
  std::string measured_profile;
  bool picture = true;

  void declare(dealii::ParameterHandler &prm) override;
  void check(const ParameterCheck &check) const override;
  void check_with(const Parameters &parameters, const ParameterCheck &check) const override;
  bool is_done(const nlohmann::ordered_json &head) const override;
  void decide(Parameters &parameters) const override;
  RunEstimate estimate(const Parameters &parameters) const override;
  double fastest_solid() const override;
  std::unique_ptr<Process> make(const Parameters &parameters) const override;
  std::vector<ObservableDescription> observables() const override;
  std::vector<std::string> results() const override;
  std::vector<Measurement> measure(
      const Parameters &parameters,
      const std::vector<std::vector<GivenParticle>> &moments) const override;
};

} // namespace eunoe::heap

#endif
