// A gas of a thousand spheres in a closed box: twenty thousand elastic collisions keep the energy,
// with an error that shrinks with the square of the step; with damping the energy never grows.
// elastic_box_million.cc is the long run.

#include "elastic_box.h"

using namespace test;

EUNOE_MPI_TEST()
{
  const ElasticBox::Outcome coarse = ElasticBox(1., 2e-6).run(7000, 100);
  const ElasticBox::Outcome fine = ElasticBox(1., 1e-6).run(14000, 200);
  check("twenty thousand collisions", coarse.collisions > 2e4 && fine.collisions > 2e4,
        format(coarse.collisions) + " and " + format(fine.collisions));
  check_close("energy with 37 steps a contact", coarse.drift, 0., 4e-4);
  check_close("energy with 75 steps a contact", fine.drift, 0., 1e-4);
  check("error of second order", coarse.drift > 3. * fine.drift,
        format(coarse.drift) + " and " + format(fine.drift));

  const ElasticBox::Outcome damped = ElasticBox(0.9, 2e-6).run(7000, 10);
  check("damping takes energy", damped.collisions > 5e3 && damped.left < 0.5, format(damped.left));
  check_close("no growth with damping", damped.growth, 0., 1e-12);
}
