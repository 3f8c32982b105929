#ifndef eunoe_observables_observable_parameters_h
#define eunoe_observables_observable_parameters_h

#include <eunoe/core/parameter_section.h>

namespace eunoe {

/// `subsection post-processing`: what is measured during the run.
struct ObservableParameters : public ParameterSection
{
  bool solid_forces = false;
  std::string solid_forces_file = "solid_forces";
  unsigned long long solid_forces_frequency = 1000;
  bool energies = false;
  std::string energies_file = "energies";
  unsigned long long energies_frequency = 1000;
  bool write_state = false;
  std::string state_file = "particles";

  void declare(dealii::ParameterHandler &prm) override;
  void check(const ParameterCheck &check) const override;
};

} // namespace eunoe

#endif
