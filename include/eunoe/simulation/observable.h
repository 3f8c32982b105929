#ifndef eunoe_simulation_observable_h
#define eunoe_simulation_observable_h

#include <eunoe/core/parameter_section.h>
#include <eunoe/core/registry.h>
#include <eunoe/simulation/measurement.h>

#include <memory>

namespace eunoe {

class Simulation;
struct PictureField;

/// Something that is measured during a run. An observable is one file in source/observables that
/// registers itself.
class Observable
{
public:
  virtual ~Observable() = default;

  /// Whether the forces on the solids are to be summed during the coming step.
  virtual bool wants_solid_loads(unsigned long long /*step*/) const { return false; }

  /// Called after every step and once before the first. Must call Simulation::complete_step
  /// before it looks at particles.
  virtual void step(Simulation &) {}

  /// Called whenever the regular pictures are written.
  virtual void draw(Simulation &) {}

  /// What it adds to the particles in every picture.
  virtual std::vector<PictureField> fields(Simulation &) const;

  /// Called once after the last step.
  virtual void finish(Simulation &) {}

  /// What was measured for comparison with data, the same on every rank, and what it is.
  virtual std::vector<Measurement> measurements() const { return {}; }
  virtual std::vector<ObservableDescription> descriptions() const { return {}; }

  /// Writes the rows that it holds back, adds what it remembers from step to step to a checkpoint,
  /// the same on any number of ranks, and takes it back on every rank; collective. `resume` throws
  /// a std::invalid_argument for a text that is no saved state.
  ///@{
  virtual void save(nlohmann::ordered_json &) {}
  virtual void resume(const nlohmann::ordered_json &) {}
  ///@}
};

/// What the input file says of an observable.
class ObservableSection : public ParameterSection
{
public:
  /// Null where the observable is not asked for; collective.
  virtual std::unique_ptr<Observable> make(Simulation &simulation) const = 0;

  /// Whether it asks for the cells of the background mesh.
  virtual bool needs_cells() const { return false; }

  /// The table that it writes, and where the input names it.
  struct Table
  {
    ParameterCheck::Path path;
    std::string entry, name, file; ///< value of the entry, and what it makes a file
  };
  /// Those that it is asked for.
  virtual std::vector<Table> tables() const { return {}; }
};

using ObservableRegistry = Registry<std::unique_ptr<ObservableSection>>;
ObservableRegistry &observables();

/// The entries that most observables have, in a subsection of their own.
class RecordSection : public ObservableSection
{
public:
  /// Texts of the documentation.
  struct Texts
  {
    std::string what; ///< begins with "Whether"
    std::string naming = "Name of the file without its ending.";
    std::string ending = ".csv"; ///< of the file; # for a number
  };

  /// @param path of the subsection
  /// @param frequency steps between two rows if the input gives none; 0: there is no such entry
  RecordSection(const ParameterCheck::Path &path, const Texts &texts, const std::string &file,
                unsigned long long frequency = 1000)
      : file(file), frequency(frequency), path(path), texts(texts)
  {
  }

  void declare(dealii::ParameterHandler &prm) override;
  void check(const ParameterCheck &check) const override;
  std::vector<Table> tables() const override;

  bool calculation = false;
  std::string file;
  unsigned long long frequency; ///< steps between two rows

protected:
  const ParameterCheck::Path path;

private:
  const Texts texts;
};

/// The one entry of observables that are only switched on, in `subsection post-processing`.
class SwitchSection : public ObservableSection
{
public:
  /// @param what begins with "Whether"
  SwitchSection(const std::string &entry, const std::string &what) : entry(entry), what(what) {}

  void declare(dealii::ParameterHandler &prm) override;

  bool calculation = false;

private:
  const std::string entry, what;
};

/// Those entries for an observable that is made of them and the simulation.
template <typename Kind, typename Entries = RecordSection>
class SectionOf : public Entries
{
public:
  using Entries::Entries;

  std::unique_ptr<Observable> make(Simulation &simulation) const override
  {
    return this->calculation ? std::make_unique<Kind>(*this, simulation) : nullptr;
  }
};

} // namespace eunoe

#endif
