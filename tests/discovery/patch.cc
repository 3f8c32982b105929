// Values of patched entries: expressions of the amplitude and of the case's own value.

#include <eunoe/discovery/catalogue.h>

#include "../tests.h"

EUNOE_TEST()
{
  using namespace test;
  using discovery::patched_value;
  const auto give = [](const std::string &pattern, const std::string &base) {
    try {
      return patched_value(pattern, base, 0.25);
    } catch (const std::invalid_argument &error) {
      return std::string(error.what());
    }
  };
  print(give("epsd", "constant"));
  print(give("${amplitude}", "words"));
  print(give("${base + amplitude}", "0.5"));
  print(give("${base * (1 + amplitude)}", "1, 2e-3"));
  print(give("0, ${amplitude}, ${-2 * amplitude}", "1, 2, 3"));
  print(give("${base + amplitude}, -9.81, ${max(base, 0.5)}", "1, 2, 3"));
  print(give("${base}", "epsd"));
  print(give("${base}, 0", "1, 2, 3"));
  print(give("${amplitude", "1"));
  print(give("${amplitude + nonsense}", "1"));
  print(give("${1 / (amplitude - 0.25)}", "1"));
  // The value of an expression is read back without loss.
  check("full precision", std::stod(patched_value("${amplitude / 3}", "", 1.)) == 1. / 3.);

  const std::vector<std::string> path = {"a", "b"};
  EntryValues values = {{{path, "c"}, "2"}};
  discovery::Effect patch;
  patch.entries = {{path, "", "", "x.prm:1"}, {path, "c", "${base * amplitude}", "x.prm:2"}};
  std::vector<std::string> overrides;
  patch.apply(3., values, overrides);
  patch.apply(3., values, overrides);
  for (const std::string &line : overrides)
    print(line);
  patch.entries[1].value = "${base";
  try {
    patch.apply(1., values, overrides);
  } catch (const UserError &error) {
    print(error.what());
  }
}
