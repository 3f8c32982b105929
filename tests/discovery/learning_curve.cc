// When a study has said the same for long enough.

#include <eunoe/discovery/inference/learning_curve.h>

#include "../tests.h"

namespace {

using namespace eunoe::discovery;
using test::check;

constexpr double level = 0.02;

const FactorSpace &no_factors()
{
  static const FactorSpace space{std::vector<Factor>()};
  return space;
}

/// Adds rounds in which nothing is detected.
void add_nothing(const double p, const unsigned int rounds, Json &curve)
{
  Findings findings;
  findings.p_nothing = p;
  findings.models.resize(1);
  findings.models.front().is_discrepancy = true;
  for (unsigned int k = 0; k < rounds; ++k)
    curve.push_back(describe_round(findings, no_factors(), k));
}

/// Adds a round that finds something of no catalogued shape.
void add_something(const double probability, Json &curve)
{
  Findings findings;
  findings.detected = true;
  findings.verdict = Verdict::off_catalogue;
  findings.p_nothing = 1e-3;
  findings.models.resize(1);
  findings.models.front().is_discrepancy = true;
  findings.models.front().probability = probability;
  curve.push_back(describe_round(findings, no_factors(), 0));
}

bool is_steady_after(const double p, const unsigned int rounds)
{
  Json curve = Json::array();
  add_nothing(p, rounds, curve);
  return is_steady(curve, level);
}

} // namespace

EUNOE_TEST()
{
  constexpr double clear = 0.5, near = 1.5 * level;
  check("three rounds are enough", is_steady_after(clear, 3) && !is_steady_after(clear, 2));
  check("six where p lies near the level", is_steady_after(near, 6) && !is_steady_after(near, 5));

  Json found = Json::array();
  add_nothing(clear, 6, found);
  for (const double probability : {0.8, 0.9, 0.91})
    add_something(probability, found);
  check("an answer that still changes is not steady", !is_steady(found, level));
  add_something(0.92, found);
  check("and one that does not is", is_steady(found, level));
}
