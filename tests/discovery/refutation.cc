// What held-out data make of an answer, from the probabilities of the models that were tested.

#include <eunoe/discovery/inference/refutation.h>

#include "../tests.h"
#include "models.h"

#include <cmath>

namespace {

using namespace eunoe::discovery;
using test::check;
using test::model_of;

constexpr double good = 0.5, doubtful = 0.03, refuted = 1e-4;

const Model a = model_of({0}, 0.5), b = model_of({1}, 0.4), both = model_of({0, 1}, 0.08),
            c = model_of({2}, 0.01), none_of_these = model_of({}, 0.01);

/// A tie of two effects.
Findings by_fit()
{
  Findings findings;
  findings.models = {a, b, both, c, none_of_these};
  findings.answer = {a, b};
  findings.off_catalogue = none_of_these.probability;
  findings.verdict = Verdict::tie;
  return findings;
}

struct Result
{
  Findings findings;
  std::optional<std::size_t> leader;
  unsigned int n_judged = 0;
};

/// Data that nothing else would look like, or that say nothing of that.
constexpr double rare = 0.2, usual = 1.;

Result of(const std::vector<Model> &models, const std::vector<double> &p,
          const Untested untested = Untested::fall, const Findings &before = by_fit(),
          const double passes = usual)
{
  Result result;
  result.findings = before;
  result.leader = refute(
      {models, p, std::vector<double>(models.size(), passes), refuted}, untested, {},
      [&](Findings &) { ++result.n_judged; }, result.findings);
  return result;
}

bool is(const std::vector<Model> &answer, const std::vector<Model> &expected)
{
  return std::equal(answer.begin(), answer.end(), expected.begin(), expected.end(),
                    [](const Model &x, const Model &y) { return x.effects == y.effects; });
}

void of_a_tie()
{
  const Result kept = of({a, b}, {good, good});
  check("a tie that is not refuted stays one", kept.findings.verdict == Verdict::tie &&
                                                   is(kept.findings.answer, {a, b}) &&
                                                   kept.leader == 0U && kept.n_judged == 0);

  const Result one = of({a, b}, {refuted, good});
  check("the model that is left is the name",
        one.findings.verdict == Verdict::named && is(one.findings.answer, {b}) && one.leader == 1U);
  check("it is judged by the data of the fit, as it did not lead before", one.n_judged == 1);
  // What only adds to the refuted model falls with it: a and the pair.
  const double left = 1. - a.probability - both.probability;
  check("the rest has the probability of what is refuted",
        std::abs(one.findings.answer.front().probability - b.probability / left) < 1e-12 &&
            std::abs(one.findings.off_catalogue - none_of_these.probability / left) < 1e-12 &&
            one.findings.models.front().effects == b.effects);

  Findings doubt = by_fit();
  doubt.none_of_these = true;
  doubt.p_fit = doubtful;
  check("the doubt about a leader stays with it",
        of({a, b}, {good, good}, Untested::fall, doubt).findings.none_of_these);
  check("and goes with it",
        of({a, b}, {refuted, good}, Untested::fall, doubt).findings.verdict == Verdict::named);
  Findings open = by_fit();
  open.models = {a, model_of({1}, 0.25), model_of({}, 0.24), c};
  check("it is no name where it may be none of them",
        of({a, b}, {refuted, good}, Untested::fall, open).findings.verdict == Verdict::tie);
  check("nor where the data are far from it, too",
        of({a, b}, {refuted, doubtful}).findings.verdict == Verdict::tie);

  Findings off = by_fit();
  const auto spurn = [](Findings &findings) { findings.verdict = Verdict::off_catalogue; };
  refute({{a, b}, {refuted, good}, {usual, usual}, refuted}, Untested::fall, {}, spurn, off);
  check("nor where the data of the fit refute it", off.verdict == Verdict::off_catalogue);
}

void of_none_of_these()
{
  Findings open = by_fit();
  open.models = {model_of({0}, 0.8), model_of({}, 0.2)};
  open.answer = {a};
  open.none_of_these = true;
  open.off_catalogue = 0.2;
  const auto share = [](const Result &result) { return result.findings.off_catalogue; };
  const Result unheard = of({a}, {good}, Untested::fall, open);
  check("data that anything passes say nothing",
        std::abs(share(unheard) - 0.2) < 1e-12 && unheard.findings.verdict == Verdict::tie);
  const Result heard = of({a}, {good}, Untested::fall, open, rare);
  check("what few would have passed speaks for the model that has",
        std::abs(share(heard) - 0.2 * rare / (0.8 + 0.2 * rare)) < 1e-12 &&
            heard.findings.verdict == Verdict::named);
  check("and not for one that has not",
        of({a}, {refuted}, Untested::fall, open, rare).findings.verdict == Verdict::off_catalogue);
  open.models = {model_of({0}, 0.6), model_of({1}, 0.2), model_of({}, 0.2)};
  check("nor for one that nothing has tested",
        std::abs(share(of({b}, {good}, Untested::fall, open, rare)) - 0.2) < 1e-12);
}

void of_all_of_an_answer()
{
  const Result off = of({a, b}, {refuted, refuted});
  check("without a model there is no name, and the page shows the fit's answer",
        off.findings.verdict == Verdict::off_catalogue && is(off.findings.answer, {a, b}) &&
            off.leader == 0U);

  const Result other = of({a, b, c}, {refuted, refuted, good});
  check("what an answer did not have is no name",
        other.findings.verdict == Verdict::tie && other.findings.none_of_these &&
            is(other.findings.answer, {c}) && other.leader == 2U);

  const Result next = of({a, b}, {refuted, refuted}, Untested::stay);
  check("what may still be tested comes into the answer",
        is(next.findings.answer, {c}) && !next.leader && next.findings.none_of_these);

  const Result all = of({a, b, both, c}, {refuted, refuted, refuted, refuted}, Untested::stay);
  check("none of these is never refuted", all.findings.verdict == Verdict::off_catalogue &&
                                              all.findings.models.front().is_discrepancy);
}

void of_no_answer()
{
  Findings none = by_fit();
  none.answer.clear();
  none.verdict = Verdict::none;
  const Result result = of({a}, {refuted}, Untested::fall, none);
  check("without an answer nothing changes", result.findings.verdict == Verdict::none &&
                                                 is(result.findings.models, none.models) &&
                                                 result.leader == 0U);
}

} // namespace

EUNOE_MPI_TEST()
{
  of_a_tie();
  of_none_of_these();
  of_all_of_an_answer();
  of_no_answer();
}
