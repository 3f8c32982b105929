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

Inserter::Event Inserter::next_event(const Domain &domain, const ParticleArrays &particles,
                                     const std::vector<Solid> &solids, const double time)
{
  Event event;
  std::vector<bool> leaving(particles.size(), false);
  const InsertionParameters &p = parameters;
  if (p.removes)
    for (std::size_t row = 0; row < particles.size(); ++row)
      if (is_in_box(particles.position[row].vec(), p.removal_lower, p.removal_upper)) {
        leaving[row] = true;
        if (row < particles.n_owned)
          event.removed.push_back(row);
      }
  method->survey({domain, particles, leaving, solids, time});
  event.delivery.particles = method->next(ids);
  ++n_events;
  return event;
}

nlohmann::ordered_json Inserter::save() const
{
  return {{"events", n_events}, {"next_id", ids.next()}};
}

void Inserter::load(const nlohmann::ordered_json &saved, const std::size_t n_inserted)
{
  n_events = count_in(saved.at("events"));
  ids.go_on_from(count_in<ParticleId>(saved.at("next_id")));
  if (method)
    method->skip(n_events, n_inserted);
}

} // namespace eunoe
