// The pairs that the contact grid finds, where particles fill its cells and where they lie far
// apart in a large domain, so that starts of cells are looked up. Reference: all pairs, tried one
// by one; the order does not depend on what else is in the domain.

#include <eunoe/contact/contact_grid.h>
#include <eunoe/core/random.h>

#include "../tests.h"

#include <algorithm>
#include <numeric>
#include <set>
#include <utility>

using namespace test;

namespace {

constexpr double radius = 1e-3, reach = 2e-4, cell_size = 2. * radius + reach;
using Pair = std::pair<ParticleId, ParticleId>;

/// A cloud of 400 spheres in a corner of the domain.
std::vector<Vec3> cloud(const Vec3 &corner)
{
  std::vector<Vec3> places;
  for (unsigned int k = 0; k < 400; ++k)
    places.push_back(corner + 0.02 * Vec3{uniform(1, Draw::size, k, 0),
                                          uniform(1, Draw::size, k, 1),
                                          uniform(1, Draw::size, k, 2)});
  return places;
}

ParticleArrays ordered(const std::vector<Vec3> &places, const ContactGrid &grid)
{
  std::vector<std::size_t> ids(places.size());
  std::iota(ids.begin(), ids.end(), 0);
  std::stable_sort(ids.begin(), ids.end(), [&](std::size_t a, std::size_t b) {
    return grid.key(places[a]) < grid.key(places[b]);
  });
  ParticleArrays p;
  p.resize(places.size(), 0, 0);
  for (std::size_t row = 0; row < ids.size(); ++row) {
    const Vec3 &x = places[ids[row]];
    p.position[row] = {x.x, x.y, x.z, radius};
    p.reference[row] = x;
    p.id[row] = static_cast<ParticleId>(ids[row]);
  }
  return p;
}

std::vector<Pair> found(const std::vector<Vec3> &places, const ContactGrid &grid)
{
  const ParticleArrays p = ordered(places, grid);
  PairList list;
  list.clear(0);
  grid.find_pairs(p, reach, list);
  std::vector<Pair> pairs;
  for (std::size_t k = 0; k < list.size(); ++k)
    pairs.emplace_back(p.id[list.i[k]], p.id[list.j[k]]);
  return pairs;
}

std::set<Pair> tried(const std::vector<Vec3> &places, const PeriodicBox &box)
{
  std::set<Pair> pairs;
  for (std::size_t a = 0; a < places.size(); ++a)
    for (std::size_t b = a + 1; b < places.size(); ++b)
      if (norm(box.shortest(places[b] - places[a])) < 2. * radius + reach)
        pairs.emplace(a, b);
  return pairs;
}

void check(const std::string &name, const PeriodicBox &box, const double size)
{
  const Vec3 lower{0., 0., 0.}, upper{size, size, size};
  const ContactGrid grid(lower, upper, box, cell_size);
  std::vector<Vec3> places = cloud({1e-3, 1e-3, 1e-3});
  const std::vector<Pair> near = found(places, grid);
  // Far corners, of which the last touches the cloud where the domain is periodic.
  places.push_back({size - radius, 1e-3, size - radius});
  places.push_back({1e-3, size - radius, 0.5 * size});
  places.push_back({2e-3, 2e-3, size - 5e-4});
  std::vector<Pair> all = found(places, grid);
  test::check(name + ": all pairs, each once",
              std::set<Pair>(all.begin(), all.end()) == tried(places, box) &&
                  all.size() == tried(places, box).size());
  all.erase(std::remove_if(all.begin(), all.end(), [](const Pair &p) { return p.second >= 400; }),
            all.end());
  test::check(name + ": in the same order without those that are far away", all == near);
  test::check(name + ": some pairs", near.size() > 100);
}

/// A cube of a cloud of which every tenth particle of one half moves, again and again.
void check_again(const std::string &name, const PeriodicBox &box)
{
  const double size = 0.04;
  const ContactGrid grid({0., 0., 0.}, {size, size, size}, box, cell_size);
  std::vector<Vec3> places;
  for (unsigned int k = 0; k < 3000; ++k)
    places.push_back(size * Vec3{uniform(2, Draw::size, k, 0), uniform(2, Draw::size, k, 1),
                                 uniform(2, Draw::size, k, 2)});
  ParticleArrays p = ordered(places, grid);
  PairList list;
  list.clear(0);
  ContactGrid::Found found;
  grid.find_pairs(p, reach, list, &found);
  std::vector<std::int32_t> record_of(p.size() * p.size(), ContactMemory::none);
  const auto record = [&](const PairList &pairs, std::size_t k) -> std::int32_t & {
    return record_of[p.size() * pairs.i[k] + pairs.j[k]];
  };
  for (std::size_t k = 0; k < list.size(); k += 3)
    list.record[k] = record(list, k) = static_cast<std::int32_t>(k);

  bool same = true, remembers = true;
  for (unsigned int round = 0; round < 20; ++round) {
    std::vector<ContactGrid::Moved> moved;
    for (std::size_t row = 0; row < p.size(); ++row)
      if (p.id[row] % 10 == 0 && p.reference[row].x < 0.5 * size) {
        moved.push_back({static_cast<std::int32_t>(row), p.reference[row]});
        const Vec3 way = 0.3 * radius *
                         Vec3{uniform(3 + round, Draw::size, row, 0) - 0.5,
                              uniform(3 + round, Draw::size, row, 1) - 0.5,
                              uniform(3 + round, Draw::size, row, 2) - 0.5};
        p.reference[row] = box.wrap(p.reference[row] + way);
      }
    // A contact that ends is forgotten.
    std::vector<std::uint8_t> listed(record_of.size(), 0);
    PairList anew;
    anew.clear(0);
    grid.find_pairs(p, reach, anew);
    for (std::size_t k = 0; k < anew.size(); ++k)
      listed[p.size() * anew.i[k] + anew.j[k]] = 1;
    for (std::size_t k = 0; k < record_of.size(); ++k)
      if (listed[k] == 0)
        record_of[k] = ContactMemory::none;

    grid.find_pairs_again(p, reach, moved, list, found);
    same = same && list.i == anew.i && list.j == anew.j;
    for (std::size_t k = 0; k < list.size(); ++k)
      remembers = remembers && list.record[k] == record(list, k);
  }
  test::check(name + ": the list is that of a search without the past", same);
  test::check(name + ": contacts keep their records", remembers);
}

} // namespace

EUNOE_TEST()
{
  check("walls", PeriodicBox{}, 50.);
  PeriodicBox box;
  box.length = {0., 0., 50.};
  check("periodic", box, 50.);
  check("small", PeriodicBox{}, 0.03);
  check_again("again, walls", PeriodicBox{});
  PeriodicBox short_box;
  short_box.length = {0.04, 0.04, 0.};
  check_again("again, periodic", short_box);
}
