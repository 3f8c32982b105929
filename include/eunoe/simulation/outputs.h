#ifndef eunoe_simulation_outputs_h
#define eunoe_simulation_outputs_h

#include <eunoe/core/timers.h>
#include <eunoe/engine/clock.h>
#include <eunoe/simulation/control_parameters.h>
#include <eunoe/simulation/observable.h>
#include <eunoe/simulation/output_folder.h>

#include <map>

namespace eunoe {

/// What comes out of a run: its folder, the regular pictures and the observables.
class Outputs
{
public:
  Outputs(const ControlParameters &control, Timers &timers, MPI_Comm comm)
      : folder(control.output_path, comm), control(control), timers(timers)
  {
  }

  OutputFolder folder;

  /// Begins the series of the regular pictures in the folder, which is open; collective.
  /// @param saved what an earlier part of the run had written, null if there is none
  void begin_series(const nlohmann::ordered_json *saved);

  /// Makes those observables that are asked for; collective.
  using Sections = std::map<std::string, std::shared_ptr<ObservableSection>>;
  void make_observables(const Sections &sections, Simulation &simulation);
  bool has_observables() const { return !observables.empty(); }

  /// Whether an observable wants the forces on solids of the coming step.
  bool want_solid_loads(unsigned long long step) const;

  /// Looks at the state with which a run begins that takes over that of another one; collective.
  void begin(const Clock &clock, Simulation &simulation);
  /// Lets the observables look at a step.
  void step(Simulation &simulation);
  /// Lets them look once more after the last one.
  void finish(Simulation &simulation);

  /// Whether the regular pictures are due; to be asked once after every step.
  /// @param begins whether the run begins with this step
  bool are_pictures_due(const Clock &clock, bool begins = false);
  /// Writes them; collective.
  void draw(Simulation &simulation);

  /// What the observables add to the particles in every picture; collective.
  std::vector<PictureField> fields(Simulation &simulation) const;

  /// What the observables have measured, and what it is.
  std::vector<Measurement> measurements() const;
  std::vector<ObservableDescription> descriptions() const;

  /// All that was written is on the disk afterwards; collective.
  nlohmann::ordered_json save();
  /// Takes back what `save` gave, but for what `open` needs; collective.
  void load(const nlohmann::ordered_json &saved);

private:
  const ControlParameters &control;
  Timers &timers;
  std::map<std::string, std::unique_ptr<Observable>> observables;
  std::shared_ptr<PictureSeries> particle_pictures, solid_pictures;
  double next_pictures = 0.; ///< (s)
};

} // namespace eunoe

#endif
