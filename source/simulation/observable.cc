#include <eunoe/core/declare.h>
#include <eunoe/simulation/observable.h>
#include <eunoe/simulation/output.h>

namespace eunoe {

ObservableRegistry &observables()
{
  static ObservableRegistry registry("observable");
  return registry;
}

std::vector<PictureField> Observable::fields(Simulation &) const
{
  return {};
}

void RecordSection::declare(dealii::ParameterHandler &prm)
{
  for (const std::string &name : path)
    declare::enter(prm, name);
  declare::entry(prm, "calculation", calculation, texts.what);
  declare::entry(prm, "filename", file, texts.naming);
  if (frequency > 0)
    declare::count(prm, "output frequency", frequency, "Steps between two rows.", 1);
  for (std::size_t k = 0; k < path.size(); ++k)
    declare::leave(prm);
}

void RecordSection::check(const ParameterCheck &check) const
{
  check.require(!file.empty() && file.find('/') == std::string::npos, path, "filename",
                "is '" + file + "'.", "Give a name without '/'.");
}

std::vector<ObservableSection::Table> RecordSection::tables() const
{
  return calculation ? std::vector<Table>{{path, "filename", file, file + texts.ending}}
                     : std::vector<Table>();
}

void SwitchSection::declare(dealii::ParameterHandler &prm)
{
  declare::enter(prm, "post-processing");
  declare::entry(prm, entry, calculation, what);
  declare::leave(prm);
}

} // namespace eunoe
