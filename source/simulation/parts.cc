#include "parts.h"

#include "announcements.h"

#include <algorithm>

namespace eunoe {

namespace {

std::vector<std::unique_ptr<Load>> make_loads(const Parameters &parameters)
{
  std::vector<std::unique_ptr<Load>> loads;
  for (const auto &[name, section] : parameters.loads)
    if (auto load = section->make(parameters.physics))
      loads.push_back(std::move(load));
  return loads;
}

} // namespace

std::unique_ptr<Process> make_process(const Parameters &parameters)
{
  return parameters.process() != nullptr ? parameters.process()->make(parameters) : nullptr;
}

std::unique_ptr<Insertion> make_insertion(const Parameters &parameters, MPI_Comm comm, Log &log)
{
  if (parameters.process_name != "none")
    return nullptr;
  const InsertionSection &method = parameters.insertion.chosen();
  method.announce(parameters.insertion, parameters.physics, log);
  return method.make(parameters.insertion, parameters.physics, comm);
}

Background background_of(const Parameters &parameters, Log &log)
{
  Background background = {parameters.mesh, parameters.refinement, parameters.grid_motion.make()};
  background.needs_cells =
      (parameters.process_name == "none" && parameters.insertion.chosen().needs_cells()) ||
      std::any_of(parameters.observables.begin(), parameters.observables.end(),
                  [](const auto &named) { return named.second->needs_cells(); });
  announce_mesh(background, log);
  return background;
}

double largest_diameter(const Parameters &parameters, const Inserter &inserter)
{
  return inserter.get_method() != nullptr ? inserter.get_method()->largest_diameter()
                                          : parameters.physics.largest_diameter();
}

Skins::Skins(const Parameters &parameters, const Inserter &inserter)
{
  constexpr double least_share = 0.01;
  const double largest = largest_diameter(parameters, inserter);
  wanted = parameters.detection.skin(largest);
  least = std::min(wanted, least_share * largest);
  contact = largest + parameters.contact_model(largest).range();
}

double Skins::limited(double skin, const PeriodicBox &box) const
{
  for (unsigned int d = 0; d < 3; ++d)
    if (box.is_periodic(d))
      skin = std::min(skin, std::max(least, 0.5 * box.length[d] - contact));
  return skin;
}

double skin_of(const Parameters &parameters, const Inserter &inserter, const Domain &domain)
{
  return Skins(parameters, inserter).in(domain.periods());
}

std::optional<SkinTuner> skin_tuner_of(const Parameters &parameters, const Inserter &inserter,
                                       const Domain &domain)
{
  if (parameters.detection.neighborhood_threshold)
    return std::nullopt;
  const Skins skins(parameters, inserter);
  const double largest = largest_diameter(parameters, inserter);
  return SkinTuner(largest, skins.in(domain.periods()),
                   skins.limited((SkinTuner::largest_threshold - 1.) * largest, domain.periods()));
}

ParticlePhysics physics_of(const Parameters &parameters, const Inserter &inserter,
                           Process *const process, Sleeper &sleeper)
{
  ParticleFields fields;
  if (process != nullptr)
    process->add_fields(fields);
  sleeper.add_fields(fields);
  const double largest = largest_diameter(parameters, inserter);
  ContactModel pairs = parameters.contact_model(largest), walls = parameters.wall_model(largest);
  pairs.widen(walls.history_size());
  walls.widen(pairs.history_size());
  return {std::move(pairs), std::move(walls),     make_loads(parameters),
          fields,           sleeper.get().flag(), parameters.physics.gravity};
}

} // namespace eunoe
