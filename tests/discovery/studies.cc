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

/// Studies of this test are small: they take a second.
StudyOptions small()
{
  StudyOptions options;
  options.budget = 500;
  return options;
}

Discovery study(SyntheticSimulator &simulator, const MeasuredData &data,
                const std::vector<Factor> &factors, const StudyOptions &options = small())
{
  Log log(MPI_COMM_SELF, true);
  return discover(options, data, factors, simulator, log);
}

Discovery study(SyntheticSimulator &simulator, const MeasuredData &data,
                const StudyOptions &options = small())
{
  return study(simulator, data, simulator.factors(), options);
}

void false_alarms()
{
  // At a true rate of 5 % most sets of 15 have one at most, and more than 4 of 30 would be a chance
  // of 1.6 %.
  int alarms = 0;
  for (std::uint32_t seed = 1; seed <= 30 && (seed != 16 || alarms > 1); ++seed) {
    SyntheticSimulator simulator(nature(1000 + seed));
    const Discovery d = study(simulator, simulator.measure(both, {}, {}, 4, 0.2, seed));
    alarms += d.content.at("detected").get<bool>() ? 1 : 0;
  }
  check("false alarms", alarms <= 4, std::to_string(alarms) + " of 30");
}

void named_with_amplitude()
{
  constexpr int enough = 5;
  int right = 0, covered = 0;
  for (std::uint32_t seed = 1; seed <= 6 && right < enough; ++seed) {
    SyntheticSimulator simulator(nature(2000 + seed));
    const std::string name(1, static_cast<char>('a' + seed % 6));
    const double a = simulator.amplitude_of(name, 8., both);
    const Discovery d = study(simulator, simulator.measure(both, thick, {{name, a}}, 4, 0.2, seed));
    if (d.model_after.size() != 1 || d.model_after.count(name) == 0)
      continue;
    ++right;
    const auto &row = d.content["amplitudes"][0];
    covered += a >= row["lower"] && a <= row["upper"];
  }
  check("one effect is named", right >= enough, std::to_string(right) + " of 6");
  // Fewer than 3 of 5 at a true coverage of 95 % would be a chance of 0.1 %.
  check("its amplitude lies in the interval", covered >= right - 2, std::to_string(covered));
}

void steep_from_the_first_bit()
{
  // A small amplitude of each effect makes nearly its whole change, and only the heap's data points
  // change, as with the angle of repose and rolling resistance.
  int named = 0, covered = 0;
  double deviation = 0.;
  for (std::uint32_t seed = 1; seed <= 5; ++seed) {
    Nature steep = nature(5000 + seed);
    steep.power = 0.45;
    steep.bend = 0.;
    steep.strength_of_scale = 40.;
    SyntheticSimulator simulator(steep);
    for (const Factor &factor : simulator.factors())
      simulator.hide(factor.name, "spreading");
    const std::string name(1, static_cast<char>('a' + seed % 3));
    const double a = simulator.amplitude_of(name, 16., both);
    const Discovery d = study(simulator, simulator.measure(both, {}, {{name, a}}, 5, 0.2, seed));
    if (d.model_after.size() != 1 || d.model_after.count(name) == 0)
      continue;
    ++named;
    const auto &row = d.content["amplitudes"][0];
    covered += a >= row["lower"] && a <= row["upper"];
    deviation += row["amplitude"].get<double>() / a - 1.;
  }
  check("steep effects are named", named >= 4, std::to_string(named) + " of 5");
  check("their amplitudes are right", std::abs(deviation) < 0.15 * named,
        std::to_string(deviation / named));
  check("and lie in the intervals", covered >= named - 2, std::to_string(covered));
}

void two_effects()
{
  SyntheticSimulator simulator(nature(31));
  const Amplitudes truth = {{"b", simulator.amplitude_of("b", 9., both)},
                            {"e", simulator.amplitude_of("e", 9., both)}};
  const Discovery d = study(simulator, simulator.measure(both, {}, truth, 5, 0.2, 5));
  check("two effects are found",
        d.model_after.size() == 2 && d.model_after.count("b") == 1 && d.model_after.count("e") == 1,
        d.content["verdict"].get<std::string>() + ": " + d.content["models"].dump());
}

void not_in_the_catalogue()
{
  Nature unlike = nature(41);
  unlike.alike = 0.3;
  SyntheticSimulator simulator(unlike);
  const Amplitudes truth = {{"c", simulator.amplitude_of("c", 12., both)}};
  const Discovery d = study(simulator, simulator.measure(both, thick, truth, 4, 0.2, 3),
                            simulator.factors_without("c"));
  check("off catalogue", d.verdict == Verdict::off_catalogue,
        d.content["verdict"].get<std::string>() + ": " + d.content["models"].dump());
  check("what it resembles is told", !d.content["remainder"]["resembles"].empty());
  const nlohmann::ordered_json &remainder = d.content["remainder"];
  check("and which model comes closest, and how badly it fits",
        remainder["closest model"] != "none of the catalogue" && remainder["p of its fit"] < 0.05,
        remainder.dump());
  check("no model comes of it", d.model_after.empty());
}

void tie_and_how_to_break_it()
{
  SyntheticSimulator simulator(nature(51));
  simulator.make_alike("b", "c", 0., {"heap"});
  const Amplitudes truth = {{"b", simulator.amplitude_of("b", 8., {"heap"})}};
  StudyOptions options = small();
  options.further_experiments = {"spreading"};
  // A study may end before it knows the other effect well enough.
  int ties = 0;
  nlohmann::ordered_json rows;
  for (const std::uint32_t seed : {1, 2, 3, 4}) {
    const Discovery heap =
        study(simulator, simulator.measure({"heap"}, {}, truth, 4, 0.2, seed), options);
    std::set<std::string> names;
    for (const auto &row : heap.content["tie"])
      names.insert(row["effects"].get<std::string>());
    if (heap.verdict == Verdict::tie && names.count("b") == 1 && names.count("c") == 1) {
      ++ties;
      rows = heap.content["measurements that would break the tie"];
    }
  }
  check("a tie from the heap alone, between the two that are alike there", ties >= 3,
        std::to_string(ties) + " of 4");
  check("the spreading would tell most", !rows.empty() && rows[0]["experiment"] == "spreading",
        rows.dump());
  MeasuredData few = simulator.measure({"heap"}, {}, truth, 4, 0.2, 2);
  few.fit.resize(few.fit.size() / 2);
  const Discovery half = study(simulator, few, options);
  const auto &plan = half.content["measurements that would break the tie"];
  const auto is_rest_of_heap = [](const auto &row) {
    return row["experiment"] == "heap" && row["observable"] == "all else" && row["again"] == false;
  };
  check("what else an experiment can measure is ranked, too",
        std::any_of(plan.begin(), plan.end(), is_rest_of_heap),
        half.content["verdict"].get<std::string>() + ": " + plan.dump());
  const Discovery more = study(simulator, simulator.measure(both, {}, truth, 4, 0.2, 2));
  check("and does", more.verdict == Verdict::named && more.model_after.count("b") == 1,
        more.content["verdict"].get<std::string>() + ": " + more.content["models"].dump());
}

void tie_that_held_out_data_break()
{
  // In the heap the two effects are the same; the spreading, where they differ, is held out.
  SyntheticSimulator simulator(nature(51));
  simulator.make_alike("b", "c", 0., {"heap"});
  const Amplitudes truth = {{"b", simulator.amplitude_of("b", 12., {"heap"})}};
  const Discovery d =
      study(simulator, simulator.measure({"heap"}, {"spreading"}, truth, 4, 0.2, 2));
  const auto &held_out = d.content["gaps"]["held-out"];
  check("members of a tie are judged by held-out data", held_out["members of the tie"].size() >= 2,
        held_out.dump());
  check("the one that they refute goes", d.model_after.count("b") == 1,
        d.content["verdict"].get<std::string>());
  std::set<std::string> tested;
  for (const char *const list : {"members of the tie", "could have refuted"})
    for (const auto &row : held_out[list])
      tested.insert(row["effects"].get<std::string>());
  check("and with it those that add an effect and were not tested",
        tested.count("c") == 1 &&
            std::none_of(d.content["models"].begin(), d.content["models"].end(),
                         [&](const auto &row) {
                           const auto name = row["effects"].template get<std::string>();
                           return (name.rfind("c + ", 0) == 0 || name == "a + c") &&
                                  tested.count(name) == 0 && row["probability"] > 0.;
                         }),
        d.content["models"].dump());
  check("that they can do so is told",
        held_out["could have refuted"][0]["would be refuted"].get<double>() > 0.5);
  check("the gap shrinks", held_out["gap after"] < held_out["gap before"], held_out.dump());
}

void too_weak_to_see()
{
  Nature weak = nature(61);
  weak.strength_of_scale = 0.02;
  weak.n_nuisances = 0;
  weak.changed_chaos = 0.;
  SyntheticSimulator simulator(weak);
  const Discovery d = study(simulator, simulator.measure(both, {}, {}, 3, 0.2, 3));
  check("underpowered", d.verdict == Verdict::underpowered,
        d.content["verdict"].dump() + d.content["learning curve"].dump());
}

void withdrawn()
{
  // Under the held-out condition the truth equals the base model, so the effect that fits is not
  // the true one.
  SyntheticSimulator simulator(nature(72));
  const Amplitudes truth = {{"c", simulator.amplitude_of("c", 16., both)}};
  MeasuredData data = simulator.measure(both, {}, truth, 4, 0.2, 1);
  data.held_out = simulator.measure(both, thick, {}, 4, 0.2, 1).held_out;
  StudyOptions options = small();
  options.budget = 1000; // has room for a second look at held-out data that are in doubt
  const Discovery d = study(simulator, data, options);
  const auto &held_out = d.content["gaps"]["held-out"];
  check("a name that does not hold is withdrawn",
        d.verdict == Verdict::off_catalogue && d.model_after.empty(), held_out.dump());
  check("and the gap grows, without a clip", held_out["gap after"] > held_out["gap before"]);
}

/// What was not run under the held-out condition is not judged by it.
void no_room_for_held_out_data()
{
  SyntheticSimulator simulator(nature(72));
  simulator.remember();
  const Amplitudes truth = {{"c", simulator.amplitude_of("c", 16., both)}};
  const MeasuredData data = simulator.measure(both, thick, truth, 4, 0.2, 1);
  MeasuredData of_fit = data;
  of_fit.held_out.clear();
  study(simulator, of_fit);
  StudyOptions poor = small();
  poor.budget = 1;
  const Discovery d = study(simulator, data, poor);
  const auto &held_out = d.content["gaps"]["held-out"];
  check("an answer that the budget cannot test stands", d.model_after.count("c") == 1);
  check("and is said to be untested",
        held_out["result"] == "the budget has no room to test the answer on held-out data",
        held_out.dump());
  // Half of it is kept for the base model and two models, but not all four.
  poor.budget = 2 * (2 * poor.validate_runs * 3);
  const Discovery some = study(simulator, data, poor);
  const auto &tested = some.content["gaps"]["held-out"];
  check("the answer is tested first",
        some.model_after.count("c") == 1 && tested.contains("p after"), tested.dump());
  check("others only as far as the budget goes", tested["could have refuted"].size() < 4,
        tested.dump());
}

/// A model whose runs under the held-out condition all fail is not judged by it.
void held_out_runs_that_fail()
{
  Nature picky = nature(72);
  picky.refused_from = 0.;
  picky.refused_in = "thick layers";
  SyntheticSimulator simulator(picky);
  const Amplitudes truth = {{"a", simulator.amplitude_of("a", 16., both)}};
  const Discovery d = study(simulator, simulator.measure(both, thick, truth, 4, 0.2, 1));
  const auto &held_out = d.content["gaps"]["held-out"];
  check("an answer that cannot be run there stands", d.model_after.count("a") == 1,
        d.content["verdict"].get<std::string>() + held_out.dump());
  check("and is said to be untested",
        held_out["result"] == "no run of the held-out experiments with the answer's effects "
                              "gave all that was measured, so it was not tested",
        held_out.dump());
}

bool has_note(const Discovery &discovery, const std::string &words)
{
  const auto &notes = discovery.content["notes"];
  return std::any_of(notes.begin(), notes.end(), [&](const auto &note) {
    return note.template get<std::string>().find(words) != std::string::npos;
  });
}

bool is_untried(const Discovery &discovery, const std::string &effect)
{
  const auto &untried = discovery.content["untried"];
  return std::count(untried.begin(), untried.end(), effect) == 1;
}

/// Room for the base model, and for one run of each experiment at some ends of ranges.
StudyOptions with_looks(const std::uint64_t looks)
{
  StudyOptions options;
  constexpr std::uint64_t experiments = 2;
  options.budget = experiments * (options.null_runs + 2 * options.nuisance_runs + looks);
  return options;
}

bool is_simulated(const Discovery &discovery, const std::string &effect)
{
  const auto &effects = discovery.content["effects"];
  return std::any_of(effects.begin(), effects.end(), [&](const auto &row) {
    return row["effect"] == effect && row["simulated"].template get<bool>();
  });
}

/// Where the budget ends within the first look, it was one at each effect.
void look_that_is_cut()
{
  Nature sound = nature(1001);
  sound.failures = 0.;
  for (const std::uint64_t looks : {2u, 7u}) {
    SyntheticSimulator simulator(sound);
    simulator.remember();
    const Discovery d =
        study(simulator, simulator.measure(both, {}, {}, 4, 0.2, 1), with_looks(looks));
    // Of the six effects one has a range with two ends.
    bool as_expected = true;
    for (const std::string name : {"a", "b", "c", "d", "e", "f"})
      as_expected = as_expected && is_simulated(d, name) == (looks == 7 || name < "c");
    check("a look that is cut is one at each effect", as_expected, d.content["effects"].dump());
    std::set<std::pair<std::string, double>> ends;
    std::set<std::uint32_t> seeds;
    for (const auto &[request, result] : simulator.known("heap")) {
      seeds.insert(request.seed);
      for (const auto &[name, amplitude] : request.amplitudes)
        if (const Factor &f = simulator.factor(name); f.kind == Factor::Kind::effect) {
          const double limit = amplitude < 0. ? f.lower : f.upper;
          if (std::abs(amplitude / limit - 1.) < 1e-2)
            ends.insert({name, amplitude});
        }
    }
    check("at the ends of the ranges, of seeds that differ",
          ends.size() == looks && seeds.size() == simulator.known("heap").size(),
          std::to_string(ends.size()) + ", " + std::to_string(seeds.size()));
  }
}

/// Who could try few effects does not say that none is missing.
void few_effects_tried()
{
  SyntheticSimulator simulator(nature(1001));
  const StudyOptions poor = with_looks(2);
  const Discovery d = study(simulator, simulator.measure(both, {}, {}, 4, 0.2, 1), poor);
  check("most effects were not tried", d.verdict == Verdict::underpowered,
        d.content["verdict"].get<std::string>());
  check("and are named", has_note(d, "never simulated") && has_note(d, "f."),
        d.content["notes"].dump());
}

/// What was run in vain is not said to be for want of runs.
void effect_that_fails()
{
  Nature picky = nature(1001);
  picky.refused_from = 0.;
  SyntheticSimulator simulator(picky);
  const Discovery d = study(simulator, simulator.measure(both, {}, {}, 4, 0.2, 1));
  check("an effect whose runs all fail is told",
        has_note(d, "All runs with these effects failed") && !has_note(d, "never simulated") &&
            is_untried(d, "a") && !is_untried(d, "b"),
        d.content["notes"].dump());
}

/// Who could not try the one that is missing says neither that it is another one nor that the
/// catalogue lacks it.
void missing_effect_not_tried()
{
  for (std::uint32_t seed = 1; seed <= 4; ++seed) {
    SyntheticSimulator simulator(nature(1000 + seed));
    const Amplitudes truth = {{"f", simulator.amplitude_of("f", 16., both)}};
    const Discovery d =
        study(simulator, simulator.measure(both, {}, truth, 4, 0.2, seed), with_looks(2));
    check("of a few effects that were tried none is the answer",
          d.verdict != Verdict::named && d.verdict != Verdict::off_catalogue && is_untried(d, "f"),
          d.content["verdict"].get<std::string>() + ": " + d.content["models"].dump());
  }
}

/// The table knows an effect well that is like the missing one, which is new in the catalogue.
void look_alike_beside_untried_effects()
{
  int named = 0, outright = 0;
  for (std::uint32_t seed = 1; seed <= 3; ++seed) {
    Nature unlike = nature(1000 + seed);
    unlike.alike = 0.;
    unlike.changed_chaos = 0.;
    SyntheticSimulator simulator(unlike);
    simulator.make_alike("f", "a", 0., both);
    simulator.remember();
    const Amplitudes truth = {{"f", simulator.amplitude_of("f", 12., both)}};
    const MeasuredData data = simulator.measure(both, {}, truth, 4, 0.2, seed);
    std::vector<Factor> old;
    for (const Factor &factor : simulator.factors())
      if (factor.kind == Factor::Kind::nuisance || factor.name < "d")
        old.push_back(factor);
    const Discovery before = study(simulator, data, old);
    named += before.verdict == Verdict::named && before.model_after.count("a") == 1;
    StudyOptions poor = small();
    poor.budget = 1;
    const Discovery d = study(simulator, data, poor);
    outright += d.verdict == Verdict::named || !is_untried(d, "f");
  }
  check("what looks like the missing effect is named where the catalogue lacks that", named >= 2,
        std::to_string(named) + " of 3");
  check("and not outright where it was not tried", outright == 0, std::to_string(outright));
}

/// p cannot be four times a high level, at which three of ten studies find something by chance.
void high_level()
{
  StudyOptions options = small();
  options.level = 0.3;
  bool one_settles = false;
  for (std::uint32_t seed = 1; seed <= 4 && !one_settles; ++seed) {
    SyntheticSimulator simulator(nature(1000 + seed));
    const Discovery d = study(simulator, simulator.measure(both, {}, {}, 4, 0.2, seed), options);
    one_settles = d.verdict == Verdict::none && !has_note(d, "was spent before");
  }
  check("studies with a high level settle", one_settles);
}

void runs_of_an_earlier_study()
{
  Nature frail = nature(81);
  frail.failures = 0.1;
  SyntheticSimulator simulator(frail);
  simulator.remember();
  const Amplitudes truth = {{"a", simulator.amplitude_of("a", 8., both)}};
  const Discovery first = study(simulator, simulator.measure(both, {}, truth, 4, 0.2, 1));
  check("named although runs fail",
        first.model_after.count("a") == 1 && first.content["runs"]["failed"].get<int>() > 10,
        first.content["runs"].dump());
  const std::uint64_t runs = simulator.n_runs();
  // Another measurement of the same truth.
  StudyOptions few = small();
  few.budget = 100;
  const Discovery again = study(simulator, simulator.measure(both, {}, truth, 4, 0.2, 2), few);
  check("a second measurement is answered from the table",
        again.model_after.count("a") == 1 && simulator.n_runs() <= runs + 100,
        again.content["verdict"].get<std::string>());
  check("which it counts", again.content["runs"]["known"] == runs);
}

/// Amplitudes at which all runs fail cost a few runs, of each study together with those before it.
void refused_amplitudes()
{
  Nature picky = nature(81);
  picky.failures = 0.;
  picky.refused_from = 2. * SyntheticSimulator(picky).factors().front().scale;
  SyntheticSimulator simulator(picky);
  simulator.remember();
  const Amplitudes truth = {{"b", simulator.amplitude_of("b", 4., both)}};
  for (std::uint32_t seed = 1; seed <= 3; ++seed) {
    const Discovery d = study(simulator, simulator.measure(both, {}, truth, 4, 0.2, seed));
    const auto failed = d.content["runs"]["failed"].get<std::uint64_t>();
    check("amplitudes that fail are left alone", failed <= (seed == 1 ? 24 : 4),
          std::to_string(failed));
  }
}

/// A table that is filled before anything is measured answers each measurement with few runs.
void filled_table()
{
  SyntheticSimulator simulator(nature(81));
  simulator.remember();
  StudyOptions options = small();
  options.budget = 900;
  Log log(MPI_COMM_SELF, true);
  const std::vector<std::string> all = {"spreading", "heap", "thick layers"};
  fill_table(options, all, simulator.factors(), simulator, log);
  check("the budget of a table is used", simulator.n_runs() == options.budget,
        std::to_string(simulator.n_runs()));
  options.budget = 40;
  for (const std::string name : {"a", "c"}) {
    const std::uint64_t before = simulator.n_runs();
    const Amplitudes truth = {{name, simulator.amplitude_of(name, 8., both)}};
    const Discovery d = study(simulator, simulator.measure(both, thick, truth, 4, 0.2, 1), options);
    check("answered from a table",
          d.model_after.count(name) == 1 && simulator.n_runs() <= before + options.budget,
          d.content["verdict"].get<std::string>());
  }
}

void budget()
{
  SyntheticSimulator simulator(nature(91));
  const Amplitudes truth = {{"a", simulator.amplitude_of("a", 8., both)}};
  StudyOptions options;
  options.budget = 300;
  const Discovery d = study(simulator, simulator.measure(both, thick, truth, 4, 0.2, 1), options);
  check("within the budget", simulator.n_runs() <= 300, std::to_string(simulator.n_runs()));
  check("the learning curve is told", !d.content["learning curve"].empty());
  try {
    options.budget = 10;
    study(simulator, simulator.measure(both, {}, truth, 4, 0.2, 1), options);
    check("too small a budget is refused", false);
  } catch (const UserError &) {
    check("too small a budget is refused", true);
  }
}

/// Two held-out experiments would like 144 runs, of 200. The base model comes first, and the fit
/// has half of the rest.
void budget_beside_tests()
{
  SyntheticSimulator simulator(nature(91));
  const Amplitudes truth = {{"a", simulator.amplitude_of("a", 8., both)}};
  StudyOptions options;
  options.budget = 200;
  const MeasuredData data = simulator.measure(both, {"thick layers", "shear"}, truth, 4, 0.2, 1);
  const Discovery d = study(simulator, data, options);
  check("tests leave runs for all effects",
        std::all_of(d.content["effects"].begin(), d.content["effects"].end(),
                    [](const auto &row) { return row["simulated"].template get<bool>(); }),
        d.content["effects"].dump());
  check("what is kept for them is told",
        has_note(d, "Of the budget of 200 runs 50 are kept for tests of the answer"),
        d.content["notes"].dump());
  check("and all is within the budget", simulator.n_runs() <= options.budget,
        std::to_string(simulator.n_runs()));
}

void plans()
{
  // Effects b and c are the same in the heap, so that the spreading tells more.
  Nature three = nature(51);
  three.n_effects = 3;
  SyntheticSimulator simulator(three);
  simulator.make_alike("b", "c", 0., {"heap"});
  simulator.make_alike("a", "c", 0., {"heap"});
  Log log(MPI_COMM_SELF, true);
  // With few runs all effects look different, as their emulators have different errors.
  simulator.remember();
  StudyOptions options = small();
  options.budget = 1500;
  fill_table(options, both, simulator.factors(), simulator, log);
  const auto rows = plan(options, both, simulator.factors(), simulator, log);
  check("what tells most comes first", rows[0]["experiment"] == "spreading", rows[0].dump());
  double heap = 0., spreading = 0.;
  for (const auto &row : rows)
    if (row["observable"] == "all")
      (row["experiment"] == "heap" ? heap : spreading) = row["information"];
  check("experiments where effects are alike tell less", spreading > 1.5 * heap,
        std::to_string(heap) + ", " + std::to_string(spreading));
  constexpr double error = 0.1;
  for (const auto &row : rows)
    if (row["observable"] != "all" &&
        row["information"] > (row["experiment"] == "heap" ? heap : spreading) + error)
      check("a part tells no more than the whole", false, row.dump());
}

} // namespace

EUNOE_MPI_TEST()
{
  false_alarms();
  named_with_amplitude();
  steep_from_the_first_bit();
  two_effects();
  not_in_the_catalogue();
  tie_and_how_to_break_it();
  tie_that_held_out_data_break();
  too_weak_to_see();
  withdrawn();
  no_room_for_held_out_data();
  held_out_runs_that_fail();
  look_that_is_cut();
  few_effects_tried();
  effect_that_fails();
  missing_effect_not_tried();
  look_alike_beside_untried_effects();
  high_level();
  runs_of_an_earlier_study();
  refused_amplitudes();
  filled_table();
  budget();
  budget_beside_tests();
  plans();
}
