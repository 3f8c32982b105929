#include <eunoe/checkpoint/head_values.h>
#include <eunoe/simulation/inserter.h>

namespace eunoe {

namespace {

bool is_in_box(const Vec3 &x, const Vec3 &lower, const Vec3 &upper)
{
  return x.x >= lower.x && x.x <= upper.x && x.y >= lower.y && x.y <= upper.y && x.z >= lower.z &&
         x.z <= upper.z;
}

} // namespace

bool Inserter::is_due(const unsigned long long step) const
{
  if (!method || method->finished())
    return false;
  return step == 0 || (parameters.frequency > 0 && step % parameters.frequency == 0);
}

bool Inserter::brings_more() const
{
  return method && method->has_more() && parameters.frequency > 0;
}

bool Inserter::waits_for_ever() const
{
  return method && method->has_more() && parameters.frequency == 0;
}

Inserter::Event Inserter::next_event(const Domain &domain, const ParticleArrays &particles,
                                     const std::vector<Solid> &solids, const double time)
{
  Event event;
  std::vector<bool> leaving(particles.size(), false);
  const InsertionParameters &p = parameters;
  if (p.removes)
    for (std::size_t row = 0; row < particles.size(); ++row)
      if (is_in_box(domain.periods().wrap(particles.position[row].vec()), p.removal_lower,
                    p.removal_upper))
      {
        leaving[row] = true;
        if (row < particles.n_owned)
          event.removed.push_back(row);
      }
  method->survey({domain, particles, leaving, solids, time});
  event.delivery.particles = method->next(ids);
  ++n_events;
  std::uint64_t n[2] = {event.delivery.particles.size(), 0};
  if (!method->gives_particles())
    n[1] = leave_out_what_is_outside(event.delivery.particles, domain);
  MPI_Allreduce(MPI_IN_PLACE, n, 2, MPI_UINT64_T, MPI_SUM, domain.communicator());
  n_supplied += n[0];
  event.n_outside = n[1];
  return event;
}

nlohmann::ordered_json Inserter::save() const
{
  return {{"events", n_events},
          {"supplied", n_supplied},
          {"next_id", ids.next()},
          {"method", parameters.method}};
}

void Inserter::load(const nlohmann::ordered_json &saved)
{
  n_supplied = count_in(saved.at("supplied"));
  n_events = count_in(saved.at("events"));
  ids.go_on_from(count_in<ParticleId>(saved.at("next_id")));
  if (method && saved.value("method", parameters.method) != parameters.method)
    n_events = method->events_for(n_supplied);
  if (method)
    method->skip(n_events, n_supplied);
}

} // namespace eunoe
