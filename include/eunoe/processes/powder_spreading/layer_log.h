#ifndef eunoe_processes_powder_spreading_layer_log_h
#define eunoe_processes_powder_spreading_layer_log_h

#include <eunoe/processes/powder_spreading/apparatus.h>
#include <eunoe/simulation/simulation.h>

namespace eunoe::spreading {

/// What is measured after every layer: the row of layers.csv, and for every particle the layer
/// that first brought it onto the plate and how far the pass moved it.
class LayerLog
{
public:
  /// What it keeps of every particle.
  struct Fields
  {
    FieldHandle layer;         ///< that first brought the particle onto the plate, -1 before
    FieldHandle tracked;       ///< 1 if the particle was on the plate at this weighing and the last
    FieldHandle displacement;  ///< between these two, against the plate (m)
    FieldHandle on_plate;      ///< 1 if the particle was on the plate at the last weighing
    FieldHandle last_position; ///< at the last weighing (m)
  };
  static Fields add_fields(ParticleFields &fields);

  LayerLog(Simulation &simulation, const SpreadingParameters &parameters,
           const Apparatus &apparatus, const Fields &fields);

  /// Reads the force on a spreader; only after a step for which solid loads were wanted.
  void sample_force(const Simulation &simulation, SolidHandle spreader);

  /// Weighs a layer, now; collective.
  /// @param plate_height of the measuring plate (m)
  void weigh(Simulation &simulation, unsigned int layer, double plate_height);

  /// Measures the profile of the powder on the plate, now; collective.
  void take_profile(Simulation &simulation, double plate_height);

  const std::vector<Measurement> &measurements() const { return measured; }
  static std::vector<ObservableDescription> observables();

  /// What has been measured so far, and its return.
  nlohmann::ordered_json save() const;
  void load(const nlohmann::ordered_json &saved);

private:
  struct OutletTotals
  {
    ExactSum gap, collector;
  };
  OutletTotals outlet_totals(const Simulation &simulation) const;
  /// The powder on the plate of all ranks.
  struct OnPlate
  {
    Tally present, kept; ///< now; now and at the last weighing
    ExactSum volume;     ///< of the solid material that is present (m3)
  };
  /// Looks which particles are on the plate, and notes it with each of them; collective.
  OnPlate look_at_particles(Simulation &simulation, unsigned int layer, double plate_height) const;
  /// Writes the row of a layer and takes it into the measurements.
  void record(unsigned int layer, double time,
              const std::vector<std::pair<std::string, double>> &row);

  const SpreadingParameters &parameters;
  const Apparatus &apparatus;
  const Fields fields;
  const double full_layer; ///< volume of a layer (m3)
  const std::shared_ptr<CsvFile> file;
  const std::shared_ptr<PictureSeries> pictures, solid_pictures;
  const bool draws;
  std::vector<Measurement> measured;
  ExactSum last_present;                      ///< mass (kg)
  double last_volume = 0., first_volume = 0.; ///< of solid material on the plate (m3)
  double last_plate_height = 0.;
  OutletTotals last_out;
  double force_sum = 0., force_max = 0.;
  unsigned int n_forces = 0;
  double last_wall_time;
};

} // namespace eunoe::spreading

#endif
