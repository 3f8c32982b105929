#ifndef eunoe_simulation_parameters_h
#define eunoe_simulation_parameters_h

#include <eunoe/checkpoint/restart_parameters.h>
#include <eunoe/contact/contact_parameters.h>
#include <eunoe/domain/domain.h>
#include <eunoe/engine/contact_history.h>
#include <eunoe/engine/integrator.h>
#include <eunoe/engine/load.h>
#include <eunoe/engine/load_balancing.h>
#include <eunoe/engine/particle_guard.h>
#include <eunoe/engine/search_criterion.h>
#include <eunoe/engine/sparse_contacts.h>
#include <eunoe/simulation/control_parameters.h>
#include <eunoe/simulation/insertion.h>
#include <eunoe/simulation/observable.h>
#include <eunoe/simulation/process.h>
#include <eunoe/solids/solid_parameters.h>
#include <eunoe/state/physical_properties.h>

#include <map>
#include <memory>
#include <string>

namespace eunoe {

/// Numbers of the subsections that are repeated.
struct SectionCounts
{
  unsigned int particle_types = 1, wall_materials = 0;
  unsigned int boundary_conditions = 0, floating_walls = 0, solids = 0, refinement_boxes = 0;
};

/// Everything that an input file says, as plain structs that belong to the parts of the code that
/// use them.
class Parameters
{
public:
  explicit Parameters(const SectionCounts &counts = {});

  /// Reads an input file, then the overrides ("subsection/entry = value") in their order; all that
  /// is wrong goes to @p problems.
  /// @param load gives the files that the input file includes, and those of size distributions
  static Parameters read(const std::string &text, const std::string &file,
                         const std::vector<std::string> &overrides, Problems &problems,
                         const FileLoader &load = {});

  /// A complete, documented input file that gives the same parameters as those that were read.
  std::string as_input_file() const;

  /// The values of all entries.
  const EntryValues &entries() const { return values; }

  /// The entries whose values in the input are not their defaults.
  const EntryValues &changed_entries() const { return changed; }

  /// The entries that name files which the run reads, with their values.
  const EntryValues &file_entries() const { return naming_files; }

  /// All entries, with one of each of the numbered subsections: see describe_entries.
  static std::string description();

  /// What a run is built from: these parameters, with what the process decides. Throws a UserError
  /// if that is impossible.
  Parameters of_run() const;

  /// The section of the chosen process, null for a general case.
  const ProcessSection *process() const
  {
    return process_name == "none" ? nullptr : processes.at(process_name).get();
  }

  /// The laws of two particles.
  /// @param largest_diameter of the particles (m)
  ContactModel contact_model(double largest_diameter) const;
  /// The laws of a particle and a wall or solid.
  ContactModel wall_model(double largest_diameter) const;

  /// What a user of Lethe should know of an input that was written for it.
  std::vector<std::string> lethe_notes;

  ControlParameters control;
  MeshParameters mesh;
  RefinementParameters refinement;
  GridMotionParameters grid_motion;
  BoundaryParameters boundaries;
  PhysicalProperties physics;
  InsertionParameters insertion;
  ContactParameters contacts;
  IntegratorParameters integration;
  ContactDetectionParameters detection;
  FaultParameters faults;
  ContactHistoryParameters contact_history;
  LoadBalancingParameters load_balancing;
  SparseContactParameters sparse_contacts;
  FloatingWallParameters floating_walls;
  SolidObjectParameters solids;
  RestartParameters restart;
  std::string process_name = "none";
  /// The sections of plug-ins. Copies share them, as nothing changes them once they are read.
  ///@{
  std::map<std::string, std::shared_ptr<ProcessSection>> processes;
  std::map<std::string, std::shared_ptr<LoadSection>> loads;
  std::map<std::string, std::shared_ptr<ObservableSection>> observables;
  ///@}

private:
  void declare(dealii::ParameterHandler &prm);
  /// Those of the engine, then those of loads and observables.
  std::vector<ParameterSection *> sections();
  void set(std::vector<InputEntry> &entries, Problems &problems);

  /// Has all values, and prints them. Copies share it. As it would write into the object that was
  /// read, it is not to be changed afterwards.
  std::shared_ptr<const dealii::ParameterHandler> handler;
  EntryValues values, changed, naming_files;
};

} // namespace eunoe

#endif
