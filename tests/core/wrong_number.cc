// A small number with a wrong last digit: the comparison of this output with the expected one must
// fail (`expect=diff`). If it does not, the outputs of the other tests are not compared, either.

#include "../tests.h"

EUNOE_TEST()
{
  test::print("force 1.00000000001e-9");
}
