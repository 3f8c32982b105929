#include <eunoe/core/declare.h>
#include <eunoe/observables/observable_parameters.h>

namespace eunoe {

namespace {
const std::string section = "post-processing";
} // namespace

void ObservableParameters::declare(dealii::ParameterHandler &prm)
{
  prm.enter_subsection(section);

  prm.enter_subsection("solid forces");
  prm.add_parameter("calculation", solid_forces,
                    "Whether force and torque of the particles on every solid are recorded.");
  prm.add_parameter("filename", solid_forces_file,
                    "Beginning of the names of the files, one a solid, with the columns time, f_x, "
                    "f_y, f_z, T_x, T_y, T_z (N, N m; torque about the centre of rotation).");
  declare::count(prm, "output frequency", solid_forces_frequency, "Steps between two rows.", 1);
  prm.leave_subsection();

  prm.enter_subsection("energies");
  prm.add_parameter("calculation", energies,
                    "Whether momentum and energies of the particles are recorded.");
  prm.add_parameter("filename", energies_file, "Name of the file without its ending.");
  declare::count(prm, "output frequency", energies_frequency, "Steps between two rows.", 1);
  prm.leave_subsection();

  prm.enter_subsection("final state");
  prm.add_parameter("calculation", write_state,
                    "Whether the particles are written at the end, in the format that the 'file' "
                    "insertion reads.");
  prm.add_parameter("filename", state_file, "Name of the file without its ending.");
  prm.leave_subsection();

  prm.leave_subsection();
}

void ObservableParameters::check(const ParameterCheck &check) const
{
  const std::pair<const char *, const std::string *> names[] = {
      {"solid forces", &solid_forces_file},
      {"energies", &energies_file},
      {"final state", &state_file}};
  for (const auto &[name, file] : names)
    check.require(!file->empty() && file->find('/') == std::string::npos, {section, name},
                  "filename", "is '" + *file + "'.", "Give a name without '/'.");
}

} // namespace eunoe
