// Studies on recorded DEM simulations, a small part of the recorded suite. They draw all their
// numbers from seeds, so each gives the same answer every time: the expected output has the answers
// line by line, and shows any change of the inference that changes one. The quality of the answers
// is tested separately, with bounds. At the rates of the whole suite (doc/discovery.md) a sample
// misses a bound in at most four of a hundred cases; with a broken part, nearly always. The budget
// is small, so that a study takes a second.

#include "recorded_cases.h"

#include <mpi.h>

namespace {

using namespace test;

/// Whether a study names, without a tie, an effect that is not part of the truth.
bool is_wrong(const RecordedStudy &study)
{
  if (study.discovery.verdict != Verdict::named)
    return false;
  for (const auto &[name, amplitude] : study.discovery.model_after)
    if (study.one.strengths.count(name) == 0 || !study.one.excluded.empty())
      return true;
  return false;
}

bool is_detected(const RecordedStudy &study)
{
  return study.discovery.verdict != Verdict::none &&
         study.discovery.verdict != Verdict::underpowered;
}

struct Answers
{
  int studies = 0, detected = 0, right = 0, wrong = 0, off_catalogue = 0;

  void add(const RecordedStudy &study)
  {
    tell(study);
    ++studies;
    detected += is_detected(study);
    wrong += is_wrong(study);
    off_catalogue += study.discovery.verdict == Verdict::off_catalogue;
    const std::string first = study.discovery.content["candidates"][0]["effect"];
    right += is_detected(study) && study.one.strengths.count(first) > 0;
  }

  /// The answer beside the truth.
  static void tell(const RecordedStudy &study)
  {
    std::string truth;
    for (const auto &[name, strength] : study.one.strengths)
      truth += " " + name + (study.one.excluded.empty() ? "" : ", not in the catalogue");
    const auto &candidates = study.discovery.content["candidates"];
    print("seed " + std::to_string(study.one.seed) +
          ", truth:" + (truth.empty() ? " none" : truth) + "; " + name_of(study.discovery.verdict) +
          (is_detected(study) ? ", first " + candidates[0]["effect"].get<std::string>() : ""));
  }

  std::string text() const
  {
    return std::to_string(studies) + " studies, detected " + std::to_string(detected) +
           ", first name right " + std::to_string(right) + ", wrong " + std::to_string(wrong) +
           ", off catalogue " + std::to_string(off_catalogue);
  }
};

StudyOptions small()
{
  StudyOptions options;
  options.budget = 500;
  return options;
}

Answers interpolated(const RecordedTable &table, const StudyKind &kind, std::uint32_t first_seed,
                     std::uint32_t number)
{
  Answers answers;
  for (std::uint32_t seed = first_seed; seed < first_seed + number; ++seed)
    answers.add(interpolated_study(table, kind, seed, small()));
  return answers;
}

} // namespace

EUNOE_MPI_TEST()
{
  const RecordedTable table(std::string(DISCOVERY_TESTS) + "/recorded/micro.txt");
  check("runs of every experiment", table.of("spreading", "base").size() >= 8 &&
                                        table.of("heap", "base").size() >= 8 &&
                                        table.n_failed == 0);

  // Behind each bound: how often a sample of this size is beyond it at the suite's rate.
  const Answers nothing = interpolated(table, {"none"}, 1, 3);
  // 2 % false alarms: 0.1 %.
  check("false alarms", nothing.detected <= 1, nothing.text());
  const Answers strong = interpolated(table, {"single", 8., 1}, 1, 5);
  // At least 97 % detected: 0.8 %. 85 % of first names right: 2.7 %; a guess reaches that in 0.1
  // %. 5 % wrong names: 2.3 %.
  check("strong effects are detected", strong.detected >= 4, strong.text());
  check("and named", strong.right >= 3, strong.text());
  check("nothing else is", strong.wrong <= 1, strong.text());
  // The first rounds of this study see nothing, as the effect's fingerprint is hardly known.
  StudyOptions patient;
  patient.budget = 700;
  const RecordedStudy late = interpolated_study(table, {"single", 4., 1}, 9631, patient);
  check("a study looks on while an effect could be detected",
        is_detected(late) &&
            late.discovery.content["learning curve"][0]["verdict"] == name_of(Verdict::none),
        late.discovery.content["learning curve"].dump());
  const Answers deleted = interpolated(table, {"deleted", 8., 1}, 1, 3);
  // At least 97 % detected: 0.3 %.
  check("an effect that the catalogue lacks is detected", deleted.detected >= 2, deleted.text());

  Answers simulated_nothing, simulated;
  for (const LeftOut &left_out : simulated_data(table)) {
    constexpr int enough = 2;
    Answers &answers = left_out.factor.empty() ? simulated_nothing : simulated;
    if (answers.studies < enough)
      answers.add(simulated_study(table, left_out, 1, small()));
  }
  // 2 % false alarms: 0.04 %.
  check("simulations of the base model as data", simulated_nothing.detected <= 1,
        simulated_nothing.text());
  // At least 97 % detected: 0.1 %; 5 % wrong names: 0.3 %.
  check("simulations of effects as data", simulated.detected >= 1 && simulated.wrong <= 1,
        simulated.text());
}
