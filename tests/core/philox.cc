// The counter-based generator against the known answers that its authors publish (Random123), and
// its uniform numbers.

#include <eunoe/core/random.h>

#include "../tests.h"

EUNOE_TEST()
{
  using namespace test;
  using Four = std::array<std::uint32_t, 4>;
  check("zeros", philox({{0, 0, 0, 0}}, {{0, 0}}) ==
                     Four({{0x6627e8d5u, 0xe169c58du, 0xbc57ac4cu, 0x9b00dbd8u}}));
  const std::uint32_t f = 0xffffffffu;
  check("ones", philox({{f, f, f, f}}, {{f, f}}) ==
                    Four({{0x408f276du, 0x41c83b0eu, 0xa20bc7c6u, 0x6d5451fdu}}));
  check("digits of pi", philox({{0x243f6a88u, 0x85a308d3u, 0x13198a2eu, 0x03707344u}},
                               {{0xa4093822u, 0x299f31d0u}}) ==
                            Four({{0xd16cfe09u, 0x94fdccebu, 0x5001e420u, 0x24126ea1u}}));

  const unsigned int n = 100000;
  double sum = 0., squares = 0., product = 0.;
  bool inside = true;
  for (unsigned int id = 0; id < n; ++id) {
    const double u = uniform(1, Draw::size, id), v = uniform(1, Draw::offset, id);
    inside = inside && u >= 0. && u < 1.;
    sum += u;
    squares += u * u;
    product += (u - 0.5) * (v - 0.5);
  }
  // Five standard errors each.
  check("in [0, 1)", inside);
  check_close("mean", sum / n, 0.5, 5. * std::sqrt(1. / 12. / n));
  check_close("mean square", squares / n, 1. / 3., 5. * std::sqrt(4. / 45. / n));
  check_close("purposes are independent", product / n, 0., 5. / 12. / std::sqrt(1. * n));
  check("depends on the seed", uniform(1, Draw::size, 7) != uniform(2, Draw::size, 7));
}
