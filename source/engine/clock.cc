#include <eunoe/checkpoint/head_values.h>
#include <eunoe/engine/clock.h>

namespace eunoe {

nlohmann::ordered_json Clock::save() const
{
  return {
      {"step", present}, {"time_step", dt}, {"begin_step", begin_step}, {"begin_time", begin_time}};
}

void Clock::load(const nlohmann::ordered_json &saved)
{
  present = first = count_in(saved.at("step"));
  begin_step = count_in(saved.at("begin_step"));
  begin_time = number_in(saved.at("begin_time"));
}

void Clock::begin_phase(const nlohmann::ordered_json &saved,
                        const std::function<unsigned long long(const Clock &)> &end)
{
  load(saved);
  const double earlier_dt = number_in(saved.at("time_step"));
  if (earlier_dt != dt) {
    begin_time += static_cast<double>(present - begin_step) * earlier_dt;
    begin_step = present;
  }
  last = end(*this);
}

} // namespace eunoe
