// A series of layers on those of an earlier run, with other powder or another procedure. The
// measuring plate goes on where it is; the spreaders are taken away, the reservoir is emptied and
// filled with a bed of its own.

#include <eunoe/checkpoint/head_values.h>
#include <eunoe/core/input_file.h>
#include <eunoe/processes/powder_spreading/powder_spreading.h>

#include <algorithm>

namespace eunoe::spreading {

namespace {

/// What the plate and the powder on it stand in, which no series can change.
const std::vector<std::string> entries_of_apparatus = {"feedstock platform length W1",
                                                       "transfer plate length W2",
                                                       "measuring plate length W3",
                                                       "exit plate length W4",
                                                       "length factor",
                                                       "depth",
                                                       "gap",
                                                       "lip height",
                                                       "rim width",
                                                       "layer thickness delta_l",
                                                       "first layer thickness",
                                                       "layer thickness error",
                                                       "side walls"};

bool is_among(const Problem &difference, const std::vector<std::string> &entries)
{
  return std::any_of(entries.begin(), entries.end(), [&](const std::string &entry) {
    return difference.where == describe({section}, entry);
  });
}

} // namespace

void SpreadingParameters::check_phase(const std::vector<Problem> &differences,
                                      const nlohmann::ordered_json &head, Problems &problems) const
{
  for (const Problem &difference : differences)
    if (is_among(difference, entries_of_apparatus))
      problems.add(difference.where, difference.what, difference.mend);
  const auto &saved = head.at("powder spreading");
  const auto weighed = count_in<unsigned int>(saved.at("layers weighed"));
  const std::string number = describe({section}, "number of layers");
  const std::string lie = std::to_string(weighed) + " lie on the plate of the checkpoint.";
  // More layers of the same kind need no series of their own.
  const bool is_longer = differences.size() == 1 && differences[0].where == number &&
                         feedstock == "replenished" && n_layers > weighed;
  if (!is_done(head) && !is_longer)
    problems.add(describe({section}, ""),
                 "differs from that of the checkpoint, of whose layers " + std::to_string(weighed) +
                     " are weighed and others are still to come.",
                 "Spread these first with the section as it was, then go on with this one.");
  else if (n_layers <= weighed)
    problems.add(number, "is " + std::to_string(n_layers) + ", and " + lie,
                 "Give the number of all layers, with those to be added.");
  const auto begun = count_in<unsigned int>(saved.at("series").at("first_layer")) +
                     count_in<unsigned int>(saved.at("next_feed"));
  if (is_longer && n_layers < begun)
    problems.add(number,
                 "is " + std::to_string(n_layers) + ", and the pass of layer " +
                     std::to_string(begun - 1) + " has begun.",
                 "Give at least " + std::to_string(begun) + ".");
}

bool SpreadingParameters::is_done(const nlohmann::ordered_json &head) const
{
  return head.at("powder spreading").at("is done").get<bool>();
}

void PowderSpreading::begin_series(const double time, const unsigned int n_layers_so_far,
                                   const double platform_height)
{
  series = {n_layers_so_far, time, platform_height, -1.};
  set_out_series();
  phase = Phase::settling_bed;
}

/// Sets plate and platform where the earlier run left them, and lets the plate fall.
void PowderSpreading::set_out_series()
{
  const double stroke = p.plate_stroke();
  apparatus.plate->add(0., 0., {0., -(series.first_layer - 1.) * stroke, 0.});
  apparatus.plate->add(series.start, stroke / p.plate_velocity, {0., -stroke, 0.});
  const Vec3 from_bed = {0., apparatus.bed_depth + series.platform_height, 0.};
  apparatus.platform->add(0., 0., from_bed);
  if (series.emptying >= 0.)
    apparatus.platform->add(series.emptying, 0., -1. * from_bed);
}

void PowderSpreading::empty_reservoir(Simulation &simulation)
{
  series.emptying = simulation.time();
  apparatus.platform->add(series.emptying, 0.,
                          {0., -apparatus.bed_depth - series.platform_height, 0.});
  // Also what lies on the edge of the transfer plate, into which the loose bed would be put.
  simulation.insert_and_remove({}, reaching_into_reservoir(simulation.complete_step(), apparatus));
  simulation.renew_solids();
  insert_loose_bed(simulation);
}

nlohmann::ordered_json PowderSpreading::save_series() const
{
  return {{"first_layer", series.first_layer},
          {"start", series.start},
          {"platform_height", series.platform_height},
          {"emptying", series.emptying}};
}

void PowderSpreading::load_series(const nlohmann::ordered_json &saved)
{
  series.first_layer = count_in<unsigned int>(saved.at("first_layer"));
  series.start = number_in(saved.at("start"));
  series.platform_height = number_in(saved.at("platform_height"));
  series.emptying = number_in(saved.at("emptying"));
}

} // namespace eunoe::spreading
