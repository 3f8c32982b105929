// Whole studies on synthetic simulators, whose truth is known: each verdict for a suitable truth.

#include <eunoe/core/problems.h>

#include "synthetic.h"

#include <mpi.h>
#include <set>

namespace {

using namespace test;

const std::vector<std::string> both = {"spreading", "heap"}, thick = {"thick layers"};

Nature nature(std::uint32_t seed)
{
  Nature result;
  result.seed = seed;
  result.n_effects = 6;
  result.n_nuisances = 1;
  return result;
}

Discovery study(SyntheticSimulator &simulator, const MeasuredData &data,
                const std::vector<Factor> &factors, StageStore &store,
                const StudyOptions &options = {})
{
  Log log(MPI_COMM_SELF, true);
  return discover(options, data, factors, simulator, store, log);
}

Discovery study(SyntheticSimulator &simulator, const MeasuredData &data,
                const StudyOptions &options = {})
{
  TransientStore store;
  return study(simulator, data, simulator.factors(), store, options);
}

void false_alarms()
{
  int alarms = 0;
  const int n = 20;
  for (std::uint32_t seed = 1; seed <= n; ++seed) {
    SyntheticSimulator simulator(nature(1000 + seed));
    const Discovery d = study(simulator, simulator.measure(both, {}, {}, 4, 0.2, seed));
    alarms += d.verdict != Verdict::none && d.verdict != Verdict::underpowered;
  }
  // More than 3 of 20 at a true rate of 5 % would be a chance of 1.6 %.
  check("false alarms", alarms <= 3, std::to_string(alarms) + " of 20");
}

void named_with_amplitude()
{
  int right = 0, covered = 0, withdrawn = 0;
  const int n = 12;
  for (std::uint32_t seed = 1; seed <= n; ++seed) {
    SyntheticSimulator simulator(nature(2000 + seed));
    const std::string name(1, static_cast<char>('a' + seed % 6));
    const double a = simulator.amplitude_of(name, 8., both);
    const Discovery d = study(simulator, simulator.measure(both, thick, {{name, a}}, 4, 0.2, seed));
    withdrawn += d.verdict == Verdict::off_catalogue;
    if (d.model_after.size() != 1 || d.model_after.count(name) == 0)
      continue;
    ++right;
    const auto &row = d.content["amplitudes"][0];
    covered += a >= row["lower"] && a <= row["upper"];
  }
  check("one effect is named", right >= 11, std::to_string(right) + " of 12");
  // Fewer than 9 of 12 at a true coverage of 95 % would be a chance of 0.2 %.
  check("its amplitude lies in the interval", covered >= 9, std::to_string(covered) + " of 12");
}

void steep_from_the_first_bit()
{
  // A small amplitude of each effect makes nearly its whole change, and only a third of the data
  // points change, as with the angle of repose and rolling resistance. The true amplitude is far
  // below those of the screening.
  int named = 0, covered = 0;
  double deviation = 0.;
  for (std::uint32_t seed = 1; seed <= 8; ++seed) {
    Nature steep = nature(5000 + seed);
    steep.power = 0.45;
    steep.bend = 0.;
    steep.strength_of_scale = 40.;
    SyntheticSimulator simulator(steep);
    for (const Factor &factor : simulator.factors())
      simulator.hide(factor.name, "spreading");
    const std::string name(1, static_cast<char>('a' + seed % 3));
    const double a = simulator.amplitude_of(name, 16., both);
    const Discovery d = study(simulator, simulator.measure(both, thick, {{name, a}}, 5, 0.2, seed));
    if (d.model_after.size() != 1 || d.model_after.count(name) == 0)
      continue;
    ++named;
    const auto &row = d.content["amplitudes"][0];
    covered += a >= row["lower"] && a <= row["upper"];
    deviation += row["amplitude"].get<double>() / a - 1.;
  }
  check("steep effects are named", named >= 6, std::to_string(named) + " of 8");
  // If runs approached the amplitude only from above, 15 % would remain, and 3 of 8 would lie in
  // their intervals.
  check("their amplitudes are not too large", deviation < 0.1 * named,
        std::to_string(deviation / named));
  check("and lie in the intervals", covered >= named - 2, std::to_string(covered));
}

void rivals_get_their_chance()
{
  // The heap is the only experiment. There effect d does nearly the same as b, the truth. The
  // fingerprints of d are made at amplitudes where it does so; those of b at far larger ones.
  int n = 0, slivers = 0, fair = 0, compared = 0, modest = 0, wrong = 0;
  for (std::uint32_t seed = 1; n < 10; ++seed) {
    Nature steep = nature(5100 + seed);
    steep.n_effects = 4;
    steep.power = 0.45;
    steep.bend = 0.;
    steep.strength_of_scale = 20.;
    SyntheticSimulator simulator(steep);
    simulator.make_alike("d", "b", 0.15, {"heap"});
    const double a = simulator.amplitude_of("b", 14., {"heap"});
    if (a > 0.3 * simulator.factor("b").upper)
      continue;
    ++n;
    const Discovery d = study(simulator, simulator.measure({"heap"}, {}, {{"b", a}}, 5, 0.2, seed));
    wrong += d.verdict == Verdict::named && d.model_after.count("b") == 0;
    const auto &stages = d.content["stages"];
    std::map<std::string, double> alone, leverage, probability, confidence;
    for (const auto &row : d.content["candidates"]) {
      alone[row["effect"]] = row["amplitude alone"];
      confidence[row["effect"]] = row["confidence"];
    }
    for (const auto &round : stages["confirm"]["rounds"])
      for (const auto &row : round["confirmed"])
        slivers += std::abs(row["amplitude"].get<double>()) < 0.15 * std::abs(alone[row["effect"]]);
    for (const auto &row : stages["iterate"]["models"]) {
      leverage[row["effects"]] = row["leverage"];
      probability[row["effects"]] = row["probability"];
    }
    if (probability["b"] > 0. && probability["d"] > 0. && d.model_after.size() == 1) {
      ++compared;
      modest += std::abs(std::log(confidence["b"] / confidence["d"])) <
                0.99 * std::abs(std::log(probability["b"] / probability["d"]));
    }
    const bool undecided = probability["b"] > 0.05 && probability["d"] > 0.05;
    fair += !undecided || std::abs(std::log(leverage["b"] / leverage["d"])) < std::log(1.5);
  }
  // The amplitude of an effect in a set that does not need it says nothing about the effect.
  check("effects are confirmed where they explain the data", slivers <= 5, std::to_string(slivers));
  check("rivals are known alike", fair >= 9, std::to_string(fair) + " of 10");
  check("the likelier is not overrated", compared >= 5 && modest == compared,
        std::to_string(modest) + " of " + std::to_string(compared));
  check("no other name is given", wrong == 0, std::to_string(wrong) + " of 10");
}

void two_effects()
{
  SyntheticSimulator simulator(nature(31));
  const Amplitudes truth = {{"b", simulator.amplitude_of("b", 9., both)},
                            {"e", simulator.amplitude_of("e", 9., both)}};
  const Discovery d = study(simulator, simulator.measure(both, {}, truth, 5, 0.2, 5));
  check("two effects are named",
        d.model_after.size() == 2 && d.model_after.count("b") == 1 && d.model_after.count("e") == 1,
        d.content["verdict"].get<std::string>() + ": " + d.content["amplitudes"].dump());
  bool tried = false;
  for (const auto &round : d.content["stages"]["iterate"]["rounds"])
    tried = tried || !round["deletions tried"].empty();
  check("each is tried without", tried);
}

void not_in_the_catalogue()
{
  Nature unlike = nature(41);
  unlike.alike = 0.3;
  SyntheticSimulator simulator(unlike);
  const Amplitudes truth = {{"c", simulator.amplitude_of("c", 12., both)}};
  TransientStore store;
  const Discovery d = study(simulator, simulator.measure(both, thick, truth, 4, 0.2, 3),
                            simulator.factors_without("c"), store);
  check("off catalogue", d.verdict == Verdict::off_catalogue,
        d.content["verdict"].get<std::string>());
  check("what it resembles is told", !d.content["remainder"]["resembles"].empty());
  check("no model comes of it", d.model_after.empty());
}

void tie_and_how_to_break_it()
{
  SyntheticSimulator simulator(nature(51));
  simulator.make_alike("b", "c", 0., {"heap"});
  const Amplitudes truth = {{"b", simulator.amplitude_of("b", 8., {"heap"})}};
  StudyOptions options;
  options.further_experiments = {"spreading"};
  const Discovery heap =
      study(simulator, simulator.measure({"heap"}, {}, truth, 4, 0.2, 2), options);
  check("a tie from the heap alone", heap.verdict == Verdict::tie,
        heap.content["verdict"].get<std::string>());
  std::set<std::string> names;
  for (const auto &row : heap.content["tie"])
    names.insert(row["effects"].get<std::string>());
  check("between the two that are alike there", names.count("b") == 1 && names.count("c") == 1);
  const auto &best = heap.content["measurements that would break the tie"][0];
  check("the spreading would break it",
        best["experiment"] == "spreading" && best["separation"].get<double>() > 2., best.dump());
  const Discovery more = study(simulator, simulator.measure(both, {}, truth, 4, 0.2, 2));
  check("and does", more.verdict == Verdict::named && more.model_after.count("b") == 1,
        more.content["verdict"].get<std::string>());
}

void tie_that_held_out_data_break()
{
  // In the heap the two effects are the same; the thick layers, where they differ, are held out.
  SyntheticSimulator simulator(nature(51));
  simulator.make_alike("b", "c", 0., {"heap"});
  const Amplitudes truth = {{"b", simulator.amplitude_of("b", 12., {"heap"})}};
  const Discovery d =
      study(simulator, simulator.measure({"heap"}, {"spreading"}, truth, 4, 0.2, 2));
  const auto &members = d.content["gaps"]["held-out"]["members of the tie"];
  check("members of a tie are judged by held-out data", members.size() >= 2, members.dump());
  check("that which they refute goes", d.verdict == Verdict::named && d.model_after.count("b") == 1,
        d.content["verdict"].get<std::string>());
  check("and has no confidence", d.content["candidates"][0]["effect"] == "b" &&
                                     d.content["candidates"][1]["confidence"].get<double>() < 0.05);
}

void second_look()
{
  unsigned int twice = 0, sure = 0, base_runs = 0;
  for (std::uint32_t seed = 1; seed <= 10; ++seed) {
    SyntheticSimulator simulator(nature(3000 + seed));
    const Amplitudes truth = {{"a", simulator.amplitude_of("a", 3., both)}};
    const Discovery d = study(simulator, simulator.measure(both, {}, truth, 4, 0.2, seed));
    const auto &screen = d.content["stages"]["screen"];
    const auto &looks = screen["looks"];
    if (looks.size() == 2) {
      ++twice;
      base_runs = std::max(base_runs, looks[1]["sets of runs of the base model"].get<unsigned>());
    } else if (looks[0]["p"].get<double>() > 0.5 || screen["detected"].get<bool>()) {
      ++sure;
    }
  }
  check("studies in doubt look twice", twice >= 2 && twice < 10, std::to_string(twice) + " of 10");
  check("with more runs", base_runs == 75, std::to_string(base_runs));
  check("the others do not", twice + sure == 10);
  SyntheticSimulator simulator(nature(3001));
  StudyOptions options;
  options.second_look = false;
  const Discovery d = study(simulator, simulator.measure(both, {}, {}, 4, 0.2, 1), options);
  const auto &looks = d.content["stages"]["screen"]["looks"];
  check("only one look if it is switched off",
        looks.size() == 1 && looks[0]["share of the level"] == 1.);
}

void too_weak_to_see()
{
  Nature weak = nature(61);
  weak.strength_of_scale = 0.02;
  weak.n_nuisances = 0;
  weak.changed_chaos = 0.;
  SyntheticSimulator simulator(weak);
  const Discovery d = study(simulator, simulator.measure(both, {}, {}, 3, 0.2, 2));
  check("underpowered", d.verdict == Verdict::underpowered, d.content["verdict"].dump());
}

void withdrawn()
{
  // Under the held-out condition the truth equals the base model, so the effect that fits is not
  // the true one.
  SyntheticSimulator simulator(nature(72));
  const Amplitudes truth = {{"c", simulator.amplitude_of("c", 9., both)}};
  MeasuredData data = simulator.measure(both, {}, truth, 4, 0.2, 1);
  data.held_out = simulator.measure(both, thick, {}, 4, 0.2, 1).held_out;
  const Discovery d = study(simulator, data);
  check("a name that does not hold is withdrawn",
        d.verdict == Verdict::off_catalogue && d.model_after.empty(), d.content["gaps"].dump());
}

void goes_on()
{
  Nature frail = nature(81);
  frail.failures = 0.15;
  SyntheticSimulator simulator(frail);
  const Amplitudes truth = {{"a", simulator.amplitude_of("a", 8., both)}};
  const MeasuredData data = simulator.measure(both, thick, truth, 4, 0.2, 1);
  TransientStore store;
  const Discovery first = study(simulator, data, simulator.factors(), store);
  check("named although runs fail",
        first.model_after.count("a") == 1 && first.content["runs"]["failed"].get<int>() > 10);
  const std::uint64_t runs = simulator.n_runs();
  const Discovery again = study(simulator, data, simulator.factors(), store);
  check("a second start makes no run", simulator.n_runs() == runs);
  check("and gives the same", again.content.dump() == first.content.dump());
  StudyOptions other;
  other.seed = 2;
  study(simulator, data, simulator.factors(), store, other);
  check("another study does not use its tables", simulator.n_runs() > runs);
}

void budget()
{
  SyntheticSimulator simulator(nature(91));
  const Amplitudes truth = {{"a", simulator.amplitude_of("a", 8., both)}};
  StudyOptions options;
  options.budget = 180;
  const Discovery d = study(simulator, simulator.measure(both, thick, truth, 4, 0.2, 1), options);
  check("within the budget", d.n_runs <= 180 && simulator.n_runs() <= 180);
  try {
    options.budget = 10;
    study(simulator, simulator.measure(both, {}, truth, 4, 0.2, 1), options);
    check("too small a budget is refused", false);
  } catch (const UserError &) {
    check("too small a budget is refused", true);
  }
}

} // namespace

EUNOE_MPI_TEST()
{
  false_alarms();
  named_with_amplitude();
  steep_from_the_first_bit();
  rivals_get_their_chance();
  two_effects();
  not_in_the_catalogue();
  tie_and_how_to_break_it();
  tie_that_held_out_data_break();
  second_look();
  too_weak_to_see();
  withdrawn();
  goes_on();
  budget();
}
