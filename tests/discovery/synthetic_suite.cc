// A blind suite on synthetic simulators: many studies with hidden truths, one line of
// JSON per study. It takes minutes to hours and is not part of ctest.
//   synthetic-suite [first seed] [seeds] [options] > answers.jsonl
//   contrib/tools score answers.jsonl
// Options: only=KIND; budget=NUMBER.

#include "suite.h"
#include "synthetic.h"

namespace {

using namespace test;

const std::vector<std::string> fit = {"spreading", "heap"}, held_out = {"thick layers"};

void one_study(const StudyKind &kind, std::uint32_t seed, StudyOptions options)
{
  RandomStream random(seed, 99);
  Nature nature;
  nature.seed = seed;
  nature.strength_of_scale *= 0.6 + 0.8 * random.uniform();
  nature.seed_correlation = 0.6 * random.uniform();
  SyntheticSimulator simulator(nature);
  if (kind.kind == "confounded") {
    const std::size_t at = random.index(nature.n_effects);
    const auto name = [&](std::size_t k) {
      return std::string(1, static_cast<char>('a' + k % nature.n_effects));
    };
    for (std::size_t k = at; k < at + nature.n_effects; k += 2)
      simulator.make_alike(name(k), name(k + 1), 0.1, fit);
  }
  SuiteCase one = draw_case(simulator, kind, fit, seed, random);
  const unsigned int repeats = 3 + static_cast<unsigned int>(random.index(4));
  const MeasuredData data =
      simulator.measure(fit, held_out, one.truth, repeats, 0.4 * random.uniform(), seed);
  options.further_experiments = {"shear"};
  print_outcome(one, study_of(one, simulator, data, options));
}

void run(const SuiteOptions &options)
{
  if (!options.others.empty())
    throw std::runtime_error("unknown option " + options.others.front());
  for (const StudyKind &kind : standard_kinds())
    for (std::uint32_t k = 0; options.wants(kind) && k < options.n_seeds; ++k)
      one_study(kind, options.first_seed + k, options.study);
}

} // namespace

int main(int argc, char **argv)
{
  return run_suite(argc, argv, run);
}
