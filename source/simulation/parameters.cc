#include <eunoe/core/declare.h>
#include <eunoe/core/parameter_input.h>
#include <eunoe/simulation/lethe_notes.h>
#include <eunoe/simulation/lethe_spellings.h>
#include <eunoe/simulation/parameters.h>

#include <deal.II/base/parameter_handler.h>

#include "general_seed.h"

#include <algorithm>

namespace eunoe {

ProcessRegistry &process_kinds()
{
  static ProcessRegistry registry("process");
  return registry;
}

namespace {

/// The subsections that are numbered, and where their numbers are kept.
struct Repeated
{
  RepeatedSections sections;
  unsigned int SectionCounts::*count;
};

const std::vector<Repeated> &repeated_sections()
{
  static const std::vector<Repeated> list = {
      {{{"lagrangian physical properties"}, "number of particle types", "particle type", 5, 1},
       &SectionCounts::particle_types},
      {{{"lagrangian physical properties"}, "number of wall materials", "wall material", 20, 0},
       &SectionCounts::wall_materials},
      {{{"DEM boundary conditions"}, "number of boundary conditions", "boundary condition", 10, 0},
       &SectionCounts::boundary_conditions},
      {{{"floating walls"}, "number of floating walls", "wall", 50, 0},
       &SectionCounts::floating_walls},
      {{{"box refinement"}, "number of refinement boxes", "box", 20, 0},
       &SectionCounts::refinement_boxes},
      {{{"solid objects", "solid surfaces"}, "number of solids", "solid object", 50, 0},
       &SectionCounts::solids}};
  return list;
}

std::vector<RepeatedSections> numbered_sections()
{
  std::vector<RepeatedSections> list;
  for (const Repeated &repeated : repeated_sections())
    list.push_back(repeated.sections);
  return list;
}

SectionCounts count(const std::vector<InputEntry> &entries)
{
  SectionCounts counts;
  for (const Repeated &repeated : repeated_sections())
    counts.*repeated.count = repeated.sections.count(entries);
  counts.particle_types = std::max(1u, counts.particle_types);
  return counts;
}

/// Two tables in one file would destroy each other.
void check_file_names(const std::map<std::string, std::shared_ptr<ObservableSection>> &observables,
                      const ProcessSection *const process, const ParameterCheck &check)
{
  std::vector<std::string> of_run = {"measurements.csv"};
  if (process != nullptr)
    for (const std::string &file : process->results())
      of_run.push_back(file);
  std::map<std::string, ObservableSection::Table> taken;
  for (const auto &[name, observable] : observables)
    for (const ObservableSection::Table &table : observable->tables()) {
      check.require(std::find(of_run.begin(), of_run.end(), table.file) == of_run.end(), table.path,
                    table.entry,
                    "is '" + table.name + "', and " + table.file +
                        " is where other results of the run are written.",
                    "Give another name.");
      const auto [first, is_new] = taken.emplace(table.file, table);
      check.require(is_new, table.path, table.entry,
                    "is '" + table.name + "', as " +
                        describe(first->second.path, first->second.entry) + " is.",
                    "Give each its own name.");
    }
}

/// A process counts its particles itself: all types may be there.
void ignore_numbers(PhysicalProperties &physics, const ParameterCheck &check)
{
  for (std::size_t k = 0; k < physics.types.size(); ++k) {
    const ParameterCheck::Path type = {"lagrangian physical properties",
                                       "particle type " + std::to_string(k)};
    check.advise(!check.is_changed(type, "number of particles"), type, "number of particles",
                 "has no effect, as the process counts its particles itself.", "Remove the entry.");
    physics.types[k].number = 0;
  }
}

} // namespace

Parameters::Parameters(const SectionCounts &counts)
    : refinement(counts.refinement_boxes), boundaries(counts.boundary_conditions),
      physics(counts.particle_types, counts.wall_materials), floating_walls(counts.floating_walls),
      solids(counts.solids)
{
  processes = process_kinds().make_all();
  loads = eunoe::loads().make_all();
  observables = eunoe::observables().make_all();
}

std::vector<ParameterSection *> Parameters::sections()
{
  std::vector<ParameterSection *> all = {&control,        &mesh,
                                         &refinement,     &grid_motion,
                                         &boundaries,     &physics,
                                         &insertion,      &contacts,
                                         &integration,    &detection,
                                         &faults,         &contact_history,
                                         &load_balancing, &sparse_contacts,
                                         &floating_walls, &solids,
                                         &restart};
  for (auto &[name, load] : loads)
    all.push_back(load.get());
  for (auto &[name, observable] : observables)
    all.push_back(observable.get());
  return all;
}

void Parameters::declare(dealii::ParameterHandler &prm)
{
  declare::choice(prm, "process", process_name, "none|" + process_kinds().names(),
                  "Experiment to run: 'none' for a general case, or a process that makes its own "
                  "mesh, solids and schedule from the section of the same name.");
  for (ParameterSection *section : sections())
    section->declare(prm);
  for (const auto &[name, section] : processes)
    section->declare(prm);
}

std::string Parameters::description()
{
  SectionCounts one_of_each;
  for (const Repeated &repeated : repeated_sections())
    one_of_each.*repeated.count = 1;
  dealii::ParameterHandler prm;
  Parameters(one_of_each).declare(prm);
  return describe_entries(prm, numbered_sections());
}

void Parameters::set(std::vector<InputEntry> &entries, Problems &problems)
{
  const auto prm = std::make_shared<dealii::ParameterHandler>();
  handler = prm;
  declare(*prm);
  const std::vector<RepeatedSections> repeated = numbered_sections();
  set_entries(*prm, entries, repeated, problems);
  naming_files = entries_naming_files(*prm);
  values = values_of(*prm);
  for (const InputEntry &entry : entries)
    if (!entry.is_default)
      changed[{entry.path, entry.name}] = entry.value;
  if (control.seed < 0)
    return;
  std::vector<InputEntry> seeds =
      turned_seeds(control.seed, values, entries, process_name != "none", problems);
  set_entries(*prm, seeds, repeated, problems);
  values = values_of(*prm);
}

std::string Parameters::as_input_file() const
{
  return complete_text(*handler);
}

Parameters Parameters::of_run() const
{
  Parameters complete = *this;
  if (const ProcessSection *const section = process())
    section->decide(complete);
  return complete;
}

ContactModel Parameters::contact_model(const double largest_diameter) const
{
  return contacts.model(physics.materials(), largest_diameter);
}

ContactModel Parameters::wall_model(const double largest_diameter) const
{
  return contacts.wall_model(physics.materials(), largest_diameter);
}

Parameters Parameters::read(const std::string &text, const std::string &file,
                            const std::vector<std::string> &overrides, Problems &problems,
                            const FileLoader &load)
{
  std::vector<InputEntry> entries =
      parse_input_and_overrides(text, file, overrides, problems, load);
  const std::vector<std::string> notes = notes_for_lethe(entries);
  translate_lethe(entries, problems);
  Parameters parameters(count(entries));
  parameters.lethe_notes = notes;
  parameters.set(entries, problems);
  if (load)
    parameters.physics.read_files(load);
  const ParameterCheck check(entries, file, problems);
  const ProcessSection *const process = parameters.process();
  for (const ParameterSection *const section : parameters.sections())
    // A process makes its own insertion.
    if (process == nullptr || section != &parameters.insertion)
      section->check(check);
  check_file_names(parameters.observables, process, check);
  parameters.sparse_contacts.check_with(parameters.physics.gravity, check);
  parameters.contacts.check_with(parameters.physics, check);
  if (process != nullptr)
    ignore_numbers(parameters.physics, check);
  // Sizes and materials make sense only now.
  ControlParameters &control = parameters.control;
  if (!control.given_time_step && problems.empty())
    control.time_step = parameters.physics.longest_time_step(control.rayleigh_share,
                                                             1. / ParticleGuard::steps_per_contact,
                                                             parameters.contacts.normal_laws());
  if (process != nullptr) {
    process->check(check);
    try {
      process->check_with(parameters, check);
    } catch (const UserError &) {
      // Without sizes nothing more can be said. What is wrong with them has been noted with its
      // place.
      if (problems.empty())
        throw;
    }
  }
  return parameters;
}

} // namespace eunoe
