// Numbers as messages show them to the user.

#include "../tests.h"

EUNOE_TEST()
{
  using namespace test;
  const auto expect = [](const std::string &text, const std::string &wanted) {
    check(wanted, text == wanted, "got '" + text + "' instead of '" + wanted + "'");
  };
  expect(format_whole(3027.81), "3028");
  expect(format_whole(1206847.4), "1206847");
  expect(format_whole(7.8e13), "78000000000000");
  expect(format_whole(2.5e300), "2.5e+300");
  expect(format_count(0., "step", "steps"), "0 steps");
  expect(format_count(1., "step", "steps"), "1 step");
  expect(format_count(0.7, "mouse", "mice"), "1 mouse");
  expect(format_count(1.6, "mouse", "mice"), "2 mice");
  expect(format_roughly(0.0547408), "0.055");
  expect(format_roughly(1.96), "2");
  expect(format_roughly(0.3), "0.3");
  expect(format_roughly(9.4), "9.4");
  expect(format_roughly(3821.6), "3822");
}
