// A small number that is off in its last digit: the comparison of this output with what is expected
// must fail (`expect=diff`), or no other test's output is compared, either.

#include "../tests.h"

EUNOE_TEST()
{
  test::print("force 1.00000000001e-9");
}
