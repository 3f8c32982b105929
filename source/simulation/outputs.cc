#include <eunoe/checkpoint/head_values.h>
#include <eunoe/simulation/outputs.h>
#include <eunoe/simulation/simulation.h>

#include <algorithm>
#include <iterator>

namespace eunoe {

namespace {

template <typename Item>
void append(std::vector<Item> &all, std::vector<Item> &&more)
{
  all.insert(all.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

} // namespace

void Outputs::begin_series(const nlohmann::ordered_json *saved)
{
  if (saved != nullptr)
    folder.resume(saved->at("folder"));
  particle_pictures = folder.pictures(control.output_name);
  solid_pictures = folder.pictures(control.output_name + "_solids");
}

void Outputs::make_observables(const Sections &sections, Simulation &simulation)
{
  for (const auto &[name, section] : sections)
    if (auto observable = section->make(simulation))
      observables[name] = std::move(observable);
}

bool Outputs::want_solid_loads(const unsigned long long step) const
{
  return std::any_of(observables.begin(), observables.end(),
                     [step](const auto &entry) { return entry.second->wants_solid_loads(step); });
}

void Outputs::begin(const Clock &clock, Simulation &simulation)
{
  next_pictures = clock.time();
  step(simulation);
  if (are_pictures_due(clock, true))
    draw(simulation);
}

void Outputs::step(Simulation &simulation)
{
  for (const auto &[name, observable] : observables)
    observable->step(simulation);
}

void Outputs::finish(Simulation &simulation)
{
  for (const auto &[name, observable] : observables)
    observable->finish(simulation);
}

bool Outputs::are_pictures_due(const Clock &clock, const bool begins)
{
  const double half_step = 0.5 * clock.time_step(), now = clock.time();
  const bool by_time = control.output_control == "time";
  // A run that goes on may have another interval, which its earlier part is far ahead of or behind.
  if (next_pictures > now + control.output_time + half_step)
    next_pictures = now;
  const bool is_due = by_time ? now >= next_pictures - half_step
                              : control.output_frequency > 0 &&
                                    (begins || clock.step() % control.output_frequency == 0);
  if (is_due && by_time)
    next_pictures += control.output_time;
  if (next_pictures <= now - half_step) // behind
    next_pictures = now + control.output_time;
  const bool is_in_window =
      now >= control.output_window[0] - half_step && now <= control.output_window[1] + half_step;
  return is_due && is_in_window && folder.is_open();
}

void Outputs::draw(Simulation &simulation)
{
  simulation.write_pictures(*particle_pictures);
  const Timers::Scope scope(timers, Section::output);
  solid_pictures->write(simulation.time(), simulation.get_solids());
  for (const auto &[name, observable] : observables)
    observable->draw(simulation);
}

std::vector<PictureField> Outputs::fields(Simulation &simulation) const
{
  std::vector<PictureField> all;
  for (const auto &[name, observable] : observables)
    append(all, observable->fields(simulation));
  return all;
}

std::vector<Measurement> Outputs::measurements() const
{
  std::vector<Measurement> all;
  for (const auto &[name, observable] : observables)
    append(all, observable->measurements());
  return all;
}

std::vector<ObservableDescription> Outputs::descriptions() const
{
  std::vector<ObservableDescription> all;
  for (const auto &[name, observable] : observables)
    append(all, observable->descriptions());
  return all;
}

nlohmann::ordered_json Outputs::save()
{
  nlohmann::ordered_json saved;
  saved["next_pictures"] = next_pictures;
  saved["observables"] = nlohmann::ordered_json::object();
  for (const auto &[name, observable] : observables) {
    nlohmann::ordered_json remembered;
    observable->save(remembered);
    if (!remembered.is_null())
      saved["observables"][name] = remembered;
  }
  // After the observables, which may have held rows back.
  saved["folder"] = folder.save();
  folder.sync();
  return saved;
}

void Outputs::load(const nlohmann::ordered_json &saved)
{
  next_pictures = number_in(saved.at("next_pictures"));
  const nlohmann::ordered_json &remembered = saved.at("observables");
  for (const auto &[name, observable] : observables)
    if (remembered.contains(name))
      observable->resume(remembered.at(name));
}

} // namespace eunoe
