#ifndef eunoe_discovery_factor_h
#define eunoe_discovery_factor_h

#include <string>
#include <vector>

namespace eunoe::discovery {

/// A factor of the design: an effect of the catalogue, or a nuisance, that is a parameter of the
/// base model that is known only with an uncertainty.
struct Factor
{
  enum class Kind
  {
    effect,
    nuisance
  };
  /// Which side of the null value physics allows.
  enum class Sign
  {
    above,
    below,
    both
  };

  std::string name; ///< of the file in prm/effects, or of the nuisance in the study
  Kind kind = Kind::effect;
  double null_value = 0.; ///< amplitude at which the effect is not there (the parameter's unit)
  double scale = 1.;      ///< amplitude that changes results clearly; less than half of the range
  double lower = 0., upper = 1.; ///< range of amplitudes that make sense
  Sign sign = Sign::above;
  double prior_deviation = 0.; ///< a nuisance's standard deviation about its null value
  std::string mechanism, unit, source;
  std::string family;                   ///< what it has in common with other effects; may be empty
  std::vector<std::string> confounders; ///< names of effects that are likely to look alike
  std::string parameter;                ///< what the amplitude is
};

} // namespace eunoe::discovery

#endif
