#include <eunoe/processes/powder_spreading/schedule.h>

#include <algorithm>

namespace eunoe::spreading {

std::vector<Pass> make_schedule(const SpreadingParameters &p, const Apparatus &a,
                                const double beginning, const unsigned int first_layer)
{
  std::vector<Pass> passes;
  const double v = p.velocity;
  const double duration = a.path() / v;
  const double fall = p.plate_stroke() / p.plate_velocity;
  // The plate must have fallen before the powder that a spreader pushes arrives there.
  const double to_plate = std::max(0., a.x_gap - a.front - a.pile_length() - a.x_start) / v;
  for (unsigned int layer = first_layer; layer < p.n_layers; ++layer) {
    const std::size_t k = passes.size();
    Pass pass;
    const double rise = p.actual_stroke(layer) / p.platform_velocity;
    if (k == 0) {
      pass.feed = beginning;
      pass.start = pass.feed + rise;
      if (first_layer > 0)
        pass.start = std::max(pass.start, beginning + fall - to_plate);
    } else {
      const Pass &last = passes.back();
      // The platform may rise when the last spreader has left it.
      const double platform_free = last.start + (a.x_transfer + a.rear - a.x_start) / v;
      pass.start = std::max({last.start + p.overlap * duration, platform_free + rise,
                             last.weighing + fall - to_plate});
      if (k >= Apparatus::n_spreaders)
        pass.start = std::max(pass.start, passes[k - Apparatus::n_spreaders].end);
      pass.feed = pass.start - rise;
    }
    pass.over_plate = pass.start + (a.x_plate - a.x_start) / v;
    pass.past_plate = pass.start + (a.x_plate_end - a.x_start) / v;
    pass.weighing = pass.past_plate + a.rear / v + p.rest_before_weighing;
    pass.end = pass.start + duration;
    passes.push_back(pass);
  }
  return passes;
}

} // namespace eunoe::spreading
