// The bed from which later feeds are copied reaches its level everywhere: grains that stand or fly
// above a lower surface do not end its filling.

#include <eunoe/processes/powder_spreading/apparatus.h>

#include "small_case.h"
#include "tests.h"

using namespace test;

namespace {

constexpr double largest = 80e-6, column = 2. * largest, reservoir = 1.2e-3;

const std::string long_reservoir = "  set feedstock platform length W1 = 1.2e-3\n"
                                   "  set first feedstock stroke = 0.25e-3\n";

/// The particles just after those above the level of the bed were removed.
std::vector<std::vector<double>> with_levelled_bed(const double level)
{
  Case bed(small_spreading("results",
                           long_reservoir + ("  set feedstock level = " + std::to_string(level))));
  return particles_when(*bed, [](const Simulation &simulation) {
    return simulation.get_ledger().taken_out.number > 0;
  });
}

void examine_surface(const double level)
{
  std::vector<double> surface(static_cast<std::size_t>(reservoir / column), -1.);
  for (const std::vector<double> &grain : with_levelled_bed(level)) {
    const auto k = static_cast<std::size_t>(grain[c_x] / column);
    if (k < surface.size())
      surface[k] = std::max(surface[k], grain[c_y] + grain[c_radius]);
  }
  const auto [lowest, highest] = std::minmax_element(surface.begin(), surface.end());
  check("none above the level", *highest <= level, std::to_string(*highest));
  check("the level is reached all over", *lowest > level - largest, std::to_string(*lowest));
}

/// Deepest overlap of two grains, or of one with the edge of the transfer plate, over a radius.
double deepest_overlap(const ParticleArrays &p)
{
  double deepest = 0.;
  for (std::size_t k = 0; k < p.n_owned; ++k) {
    const auto &a = p.position[k];
    const double r = p.radius(k);
    if (a.x < reservoir && a.y < 0.)
      deepest = std::max(deepest, (a.x + r - reservoir) / r);
    for (std::size_t l = 0; l < k; ++l) {
      const auto &b = p.position[l];
      double dz = std::abs(a.z - b.z);
      dz = std::min(dz, slice_depth - dz);
      const double distance = norm(Vec3{a.x - b.x, a.y - b.y, dz});
      deepest = std::max(deepest, (r + p.radius(l) - distance) / std::min(r, p.radius(l)));
    }
  }
  return deepest;
}

/// Whenever the reservoir is filled anew, with powder on the transfer plate beside it.
void examine_copies()
{
  Case run(small_spreading("results", long_reservoir +
                                          "  set number of layers = 4\n"
                                          "  set feedstock level = " +
                                          std::to_string(clearance)));
  unsigned long long taken_out = 0;
  unsigned int n_looks = 0;
  double deepest = 0.;
  run.run([&](Simulation &simulation) {
    const auto number = simulation.get_ledger().taken_out.number;
    if (number == taken_out)
      return;
    taken_out = number;
    ++n_looks;
    deepest = std::max(deepest, deepest_overlap(simulation.complete_step()));
  });
  check("beds were put in", n_looks >= 4, std::to_string(n_looks));
  check("they overlap with nothing", deepest < 0.1, std::to_string(deepest));
}

void examine_when_full()
{
  spreading::SpreadingParameters p;
  p.w1 = reservoir;
  p.depth = 0.3e-3;
  const spreading::Apparatus apparatus(p, largest);
  ParticleType grains;
  grains.sizes.average_diameter = largest;
  const auto layer = static_cast<unsigned long long>(
      std::ceil(spreading::bed_fraction * 6. / M_PI * reservoir * p.depth / (largest * largest)));
  check("one grain above the level does not fill the bed", !apparatus.is_full(grains, 1));
  check("almost a layer does not", !apparatus.is_full(grains, layer - 1));
  check("a layer does", apparatus.is_full(grains, layer));
}

} // namespace

EUNOE_MPI_TEST()
{
  examine_when_full();
  examine_surface(0.);
  examine_surface(largest);
  examine_copies();
}
