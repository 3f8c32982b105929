// A sum that does not round: any order, any grouping, terms of very different size.

#include <eunoe/core/exact_sum.h>

#include "../tests.h"

#include <algorithm>
#include <random>

EUNOE_TEST()
{
  using namespace test;
  ExactSum cancelling;
  for (const double term : {1e300, 1., 1e-300, -1e300, -1.})
    cancelling += term;
  check("what remains after cancellation", cancelling.value() == 1e-300);

  std::mt19937 generator(1);
  std::uniform_real_distribution<double> mantissa(-1., 1.);
  std::uniform_int_distribution<int> exponent(-1060, 1000);
  std::vector<double> terms;
  for (int k = 0; k < 10000; ++k)
    terms.push_back(std::ldexp(mantissa(generator), exponent(generator)));
  ExactSum forwards, backwards, parts[3];
  for (std::size_t k = 0; k < terms.size(); ++k) {
    forwards += terms[k];
    parts[k % 3] += terms[k];
  }
  std::reverse(terms.begin(), terms.end());
  for (const double term : terms)
    backwards += term;
  check("same in any order", forwards == backwards && forwards.value() == backwards.value());
  parts[0] += parts[1];
  parts[0] += parts[2];
  check("same in parts", parts[0] == forwards);
  parts[0] -= forwards;
  check("nothing left of the difference", parts[0].value() == 0.);

  ExactSum tenths;
  for (int k = 0; k < 10; ++k)
    tenths += 0.1;
  check("rounded once", tenths.value() == 1.0);
  ExactSum denormal;
  denormal += 5e-324;
  denormal += 5e-324;
  check("smallest numbers", denormal.value() == 1e-323);
  ExactSum broken;
  broken += std::nan("");
  check("not a number is not lost", std::isnan(broken.value()));
}
