#ifndef eunoe_processes_powder_spreading_parameters_h
#define eunoe_processes_powder_spreading_parameters_h

#include <eunoe/simulation/process.h>

#include <cmath>

namespace eunoe::spreading {

/// The subsection of the process.
inline const std::string section = "powder spreading";

/// `subsection powder spreading`: the apparatus and the procedure of Gaboriault et al. (2025), in
/// the symbols of that paper. SI units.
struct SpreadingParameters : public ProcessSection
{
  double w1 = 0.069, w2 = 0.056, w3 = 0.073, w4 = 0.0465; ///< lengths of the parts in x
  double length_factor = 1.;                              ///< on w1 ... w4
  double depth = 0.002;
  double gap = 0.0005;
  double lip = 0.0001;
  double rim = 0.;

  std::string spreader = "half round";
  double spreader_radius = 0.005;
  double spreader_thickness = 0.002;
  double spreader_height = 0.;
  unsigned int spreader_facets = 50;
  double clearance = 100e-6;

  unsigned int n_layers = 21;
  double layer_thickness = 100e-6;
  double first_thickness = 0.; ///< of layer 0, below the transfer plate
  double velocity = 0.1;
  double stroke = 0.6e-3, first_stroke = 2.2e-3;
  double plate_velocity = 2e-3, platform_velocity = 2e-3;
  double overlap = 1.;
  double rest_before_weighing = 0.;

  std::string feedstock = "replenished";
  unsigned int particle_type = 0; ///< of the feedstock
  double bed_depth = 0.;
  double bed_margin = 0.4e-3;
  double bed_level = 0.;
  double insertion_speed = 0.1;
  double settled_speed = 2e-3;
  static constexpr double settling_wait = 1e-3; ///< before a bed may count as settled (s)
  double settling_time = 0.2;
  unsigned int seed = 1;

  /// @name How the real apparatus departs from the one that was meant
  ///@{
  double clearance_offset = 0.;                              ///< (m)
  double spreader_tilt = 0.;                                 ///< (m)
  double vibration_amplitude = 0., vibration_frequency = 0.; ///< (m), (Hz)
  double plate_stroke_error = 0., stroke_error = 0.;         ///< relative
  double plate_recoil = 0.;                                  ///< (m)
  bool side_walls = false;
  double side_wall_friction = -1.; ///< -1: that of all walls
  ///@}

  bool layer_pictures = true;
  unsigned int profile_bins = 8;
  unsigned int force_sampling = 50;

  void declare(dealii::ParameterHandler &prm) override;
  void check(const ParameterCheck &check) const override;
  void check_with(const Parameters &parameters, const ParameterCheck &check) const override;
  void check_phase(const std::vector<Problem> &differences, const nlohmann::ordered_json &head,
                   Problems &problems) const override;
  bool is_done(const nlohmann::ordered_json &head) const override;
  void decide(Parameters &parameters) const override;
  RunEstimate estimate(const Parameters &parameters) const override;
  double fastest_solid() const override;
  std::unique_ptr<Process> make(const Parameters &parameters) const override;
  std::size_t powder() const override { return particle_type; }
  std::vector<ObservableDescription> observables() const override;
  std::vector<std::string> results() const override;
  std::vector<Measurement> measure(
      const Parameters &parameters,
      const std::vector<std::vector<GivenParticle>> &moments) const override;

  double mean_clearance() const { return clearance + clearance_offset; }
  /// Stroke of the measuring plate.
  double plate_stroke() const { return layer_thickness * (1. + plate_stroke_error); }
  /// Height of the measuring plate in the pass of a layer (m).
  double plate_level(double layer) const
  {
    const double fallen = first_thickness * (1. + plate_stroke_error) + layer * plate_stroke();
    return 0. - fallen; // and not -0
  }
  /// Stroke of the feedstock platform before a layer.
  double actual_stroke(unsigned int layer) const
  {
    return (layer == 0 ? first_stroke : stroke) * (1. + stroke_error);
  }
  /// Largest speed of the vibration (m/s).
  double vibration_speed() const { return 2. * M_PI * vibration_frequency * vibration_amplitude; }

private:
  /// Whether the powder and the lengths of the apparatus go together.
  void check_lengths(const Parameters &parameters, const ParameterCheck &check) const;
  void check_dosing(const ParameterCheck &check) const;
  void check_imperfections(const ParameterCheck &check) const;
  /// What happens at the sides of the domain.
  void decide_boundaries(Parameters &parameters) const;
};

} // namespace eunoe::spreading

#endif
