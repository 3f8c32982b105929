#include <eunoe/discovery/inference/learning_curve.h>

#include <algorithm>
#include <cmath>

namespace eunoe::discovery {

void LearningCurve::add(const Findings &findings, const FactorSpace &space,
                        const std::uint64_t runs)
{
  const Model &first = findings.models.front();
  Json row = {{"runs", runs},
              {"p of nothing missing", findings.p_nothing},
              {"verdict", name_of(findings.detected ? findings.verdict : Verdict::none)},
              {"first", name_of(first, space)},
              {"probability", first.probability},
              {"probability off catalogue", findings.off_catalogue}};
  Json set = Json::array();
  for (const Model &model : findings.answer)
    set.push_back(name_of(model, space));
  row["answer"] = set;
  list.push_back(row);
}

std::size_t LearningCurve::n_alike() const
{
  constexpr double same = 0.05;
  const Json &last = list.back();
  const bool detected = last["verdict"] != name_of(Verdict::none);
  const auto is_alike = [&](const Json &row) {
    return row["verdict"] == last["verdict"] &&
           (!detected || (row["answer"] == last["answer"] &&
                          std::abs(row["probability"].get<double>() -
                                   last["probability"].get<double>()) <= same));
  };
  std::size_t n = 0;
  while (n < list.size() && is_alike(list[list.size() - 1 - n]))
    ++n;
  return n;
}

bool LearningCurve::is_steady(const double level) const
{
  constexpr std::size_t enough = 3, enough_near_the_level = 6;
  if (list.size() < enough)
    return false;
  const double clear = std::min(4. * level, 0.5);
  bool is_clear = true;
  for (std::size_t k = list.size() - enough; k < list.size(); ++k)
    is_clear = is_clear && (list[k]["verdict"] != name_of(Verdict::none) ||
                            list[k]["p of nothing missing"].get<double>() >= clear);
  return n_alike() >= (is_clear ? enough : enough_near_the_level);
}

} // namespace eunoe::discovery
