#ifndef eunoe_simulation_control_parameters_h
#define eunoe_simulation_control_parameters_h

#include <eunoe/core/parameter_section.h>

#include <optional>

namespace eunoe {

/// `subsection simulation control`.
struct ControlParameters : public ParameterSection
{
  std::optional<double> given_time_step = 1e-6; ///< none: `auto`
  double rayleigh_share = 0.2;                  ///< "time step share", of an automatic one
  double time_step = 1e-6;                      ///< that of the run (s)
  std::string end_control = "time";
  double time_end = 1.;
  unsigned long long iteration_end = 0;
  std::string output_path = "./output";
  std::string output_name = "out";
  std::string output_control = "iteration";
  unsigned long long output_frequency = 0;
  double output_time = 1.;
  std::vector<double> output_window = {0., 1e308}; ///< first and last moment of pictures (s)
  unsigned long long log_frequency = 1000;
  int seed = -1; ///< of all random numbers; -1: each entry's own

  void declare(dealii::ParameterHandler &prm) override;
  void check(const ParameterCheck &check) const override;

  /// Number of steps of the run, as far as it is known beforehand.
  unsigned long long n_steps() const;
  /// Likewise of one that goes on at a step and a time (s) of an earlier one.
  unsigned long long last_step(unsigned long long step, double time) const;
};

} // namespace eunoe

#endif
