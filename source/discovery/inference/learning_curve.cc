#include <eunoe/discovery/inference/learning_curve.h>

#include <algorithm>
#include <cmath>

namespace eunoe::discovery {

namespace {

/// Number of last rounds with the same answer.
std::size_t n_alike(const Json &rounds)
{
  const Json &last = rounds.back();
  const bool detected = last["verdict"] != name_of(Verdict::none);
  const auto is_alike = [&](const Json &row) {
    return row["verdict"] == last["verdict"] &&
           (!detected ||
            (row["answer"] == last["answer"] &&
             std::abs(row["probability"].get<double>() - last["probability"].get<double>()) <=
                 tuned::ending::same_probability));
  };
  std::size_t n = 0;
  while (n < rounds.size() && is_alike(rounds[rounds.size() - 1 - n]))
    ++n;
  return n;
}

} // namespace

Json describe_round(const Findings &findings, const FactorSpace &space, const std::uint64_t runs)
{
  Json answer = Json::array();
  for (const Model &model : findings.answer)
    answer.push_back(name_of(model, space));
  const Model &first = findings.models.front();
  return {{"runs", runs},
          {"p of nothing missing", findings.p_nothing},
          {"verdict", name_of(findings.detected ? findings.verdict : Verdict::none)},
          {"first", name_of(first, space)},
          {"probability", first.probability},
          {"probability off catalogue", findings.off_catalogue},
          {"answer", answer}};
}

bool is_steady(const Json &rounds, const double level)
{
  constexpr std::size_t enough = tuned::ending::rounds;
  if (rounds.size() < enough)
    return false;
  const double clear = std::min(tuned::ending::near_level * level, tuned::ending::not_near_level);
  const bool is_clear = std::all_of(rounds.end() - enough, rounds.end(), [&](const Json &row) {
    return row["verdict"] != name_of(Verdict::none) ||
           row["p of nothing missing"].get<double>() >= clear;
  });
  return n_alike(rounds) >= (is_clear ? enough : tuned::ending::rounds_near_level);
}

} // namespace eunoe::discovery
