#include <eunoe/processes/powder_spreading/schedule.h>

#include <algorithm>

namespace eunoe::spreading {

std::vector<Pass> make_schedule(const SpreadingParameters &p, const Apparatus &a,
                                const double beginning)
{
  std::vector<Pass> passes;
  const double v = p.velocity;
  const double duration = a.path() / v;
  const double fall = p.plate_stroke() / p.plate_velocity;
  for (unsigned int k = 0; k < p.n_layers; ++k) {
    Pass pass;
    const double rise = p.actual_stroke(k) / p.platform_velocity;
    if (k == 0) {
      pass.feed = beginning;
      pass.start = pass.feed + rise;
    } else {
      const Pass &last = passes.back();
      // The platform may rise when the last spreader has left it; the plate must have fallen
      // before the powder that this spreader pushes arrives there.
      const double platform_free = last.start + (a.x_transfer + a.rear - a.x_start) / v;
      const double to_plate = std::max(0., a.x_gap - a.front - a.pile_length() - a.x_start) / v;
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
