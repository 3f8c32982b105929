// Which models an answer has, from their probabilities, and what becomes of it where effects of the
// catalogue were not tried.

#include <eunoe/discovery/inference/decision.h>

#include "../tests.h"
#include "models.h"

namespace {

using namespace eunoe::discovery;
using test::check;
using test::model_of;

/// @param models the likeliest first
Findings chosen(const std::vector<Model> &models)
{
  Findings findings;
  findings.models = models;
  choose({}, findings);
  return findings;
}

bool has(const Findings &findings, const std::vector<std::size_t> &effects)
{
  return std::equal(findings.answer.begin(), findings.answer.end(), effects.begin(), effects.end(),
                    [](const Model &model, const std::size_t effect) {
                      return model.effects == std::vector<std::size_t>{effect};
                    });
}

Findings with_untried(const Verdict verdict, const std::size_t untried)
{
  constexpr std::size_t effects = 6;
  Findings findings;
  findings.answer = {model_of({0}, 0.99)};
  findings.verdict = verdict;
  allow_for_untried(untried, effects, findings);
  return findings;
}

void untried_effects()
{
  check("where all effects were tried, an answer stays what it is",
        with_untried(Verdict::named, 0).verdict == Verdict::named &&
            with_untried(Verdict::off_catalogue, 0).verdict == Verdict::off_catalogue);
  const Findings beside_one = with_untried(Verdict::named, 1);
  check("beside one that was not, nothing is named outright",
        beside_one.verdict == Verdict::tie && beside_one.none_of_these && has(beside_one, {0}));
  check("what half of the catalogue does not explain is off it",
        with_untried(Verdict::off_catalogue, 3).verdict == Verdict::off_catalogue);
  const Findings few = with_untried(Verdict::off_catalogue, 4);
  check("what less does not explain may be in it",
        few.verdict == Verdict::underpowered && few.answer.empty());
}

} // namespace

EUNOE_TEST()
{
  constexpr std::size_t a = 0, b = 1;
  const Findings sure = chosen({model_of({a}, 0.96), model_of({b}, 0.03), model_of({}, 0.01)});
  check("what has nearly all of the probability is named", has(sure, {a}) && !sure.none_of_these);

  const Findings open = chosen({model_of({a}, 0.9), model_of({}, 0.06), model_of({b}, 0.04)});
  check("'none of these' is listed from 5 % on", has(open, {a}) && open.none_of_these);

  const Findings few = chosen({model_of({a}, 0.91), model_of({}, 0.045), model_of({b}, 0.045)});
  check("below, it counts and is not listed", has(few, {a}) && !few.none_of_these);

  const Findings needless = chosen(
      {model_of({a}, 0.93), model_of({a, b}, 0.03), model_of({}, 0.02), model_of({b}, 0.02)});
  check("an effect that is not needed is not listed, and what is needed has its probability",
        has(needless, {a}) && !needless.none_of_these);

  untried_effects();
}
