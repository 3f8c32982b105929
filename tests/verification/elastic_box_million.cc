// A million elastic collisions of a thousand spheres in a closed box keep the energy to one in ten
// thousand. Two minutes on one core.

#include "elastic_box.h"

using namespace test;

EUNOE_MPI_TEST()
{
  const ElasticBox::Outcome outcome = ElasticBox(1., 1e-6).run(680000, 2000);
  check("a million collisions", outcome.collisions > 1e6, format(outcome.collisions));
  check_close("energy", outcome.drift, 0., 1e-4);
}
