#include "packing.h"

#include <eunoe/contact/contact_grid.h>
#include <eunoe/core/exact_sum.h>
#include <eunoe/core/first_rank.h>
#include <eunoe/core/message_tags.h>
#include <eunoe/core/problems.h>
#include <eunoe/core/random.h>
#include <eunoe/core/sparse_exchange.h>
#include <eunoe/simulation/insertion.h>

#include <algorithm>
#include <numeric>

namespace eunoe {

namespace {

/// Share by which all are larger than they are while they are pushed, so that they do not even
/// touch in the end.
constexpr double margin = 1e-3;
constexpr unsigned int most_steps = 20000;
/// Distance beyond touching up to which neighbours are listed, over the largest radius.
constexpr double skin_share = 0.3;

} // namespace

Vec3 PackingPlace::inside(Vec3 x, const double r) const
{
  x = box.wrap(x);
  for (unsigned int d = 0; d < 3; ++d)
    if (!box.is_periodic(d))
      x[d] = std::min(std::max(x[d], lower[d] + r), upper[d] - r);
  return x;
}

Vec3 PackingPlace::accepted(const Vec3 &from, Vec3 to, const double r, const double h) const
{
  // Newton's method along the gradient, and a little further.
  for (unsigned int tries = 0; tries < 5; ++tries) {
    const double value = acceptance(to);
    if (value > 0.)
      return holds(to) ? to : from;
    Vec3 gradient;
    for (unsigned int d = 0; d < 3; ++d) {
      Vec3 shift;
      shift[d] = h;
      gradient[d] = (acceptance(to + shift) - acceptance(to - shift)) / (2. * h);
    }
    const double steepness = norm(gradient);
    if (!(steepness > 0.))
      return from;
    to = inside(to + (1e-2 * h + 1.001 * -value / steepness) / steepness * gradient, r);
  }
  return from;
}

Packing::Packing(PackingPlace place, const std::vector<Solid> &solids, MPI_Comm comm)
    : place(std::move(place)), obstacles(solids), comm(comm)
{
  MPI_Comm_rank(comm, &rank);
}

Vec3 Packing::draw(const ParticleId id, const double radius, const unsigned int seed) const
{
  constexpr std::uint32_t most_tries = 100000;
  for (std::uint32_t t = 0; t < most_tries; ++t) {
    Vec3 x;
    for (unsigned int d = 0; d < 3; ++d)
      x[d] = place.lower[d] +
             (place.upper[d] - place.lower[d]) * uniform(seed, Draw::packing, id, 3 * t + d);
    x = place.inside(x, radius);
    if (place.acceptance(x) > 0. && place.holds(x))
      return x;
  }
  throw UserError("subsection 'insertion info' / subsection 'insertion acceptance function': "
                  "hardly any place of the insertion box is in the mesh and has a positive "
                  "value. Correct the expression, or move the box.");
}

void Packing::take_to_parts()
{
  std::map<int, std::vector<Sphere>> out;
  for (std::size_t k = 0; k < n_own; ++k)
    out[parts->at(spheres[k].position)].push_back(spheres[k]);
  spheres.clear();
  for (const auto &[from, list] : exchange_lists(std::move(out), comm))
    spheres.insert(spheres.end(), list.begin(), list.end());
  n_own = spheres.size();
}

void Packing::fetch_ghosts(const double skin)
{
  std::map<int, Link> by_rank;
  std::vector<int> near;
  for (std::size_t k = 0; k < n_own; ++k) {
    const double reach = (1. + margin) * (spheres[k].radius + largest) + skin;
    parts->near(spheres[k].position, reach, near);
    for (const int part : near)
      if (part != rank)
        by_rank[part].sent.push_back(static_cast<std::int32_t>(k));
  }
  std::map<int, std::vector<Sphere>> out;
  for (const auto &[part, link] : by_rank)
    for (const std::int32_t k : link.sent)
      out[part].push_back(spheres[k]);
  for (const auto &[part, list] : exchange_lists(std::move(out), comm)) {
    by_rank[part].n_received = list.size();
    spheres.insert(spheres.end(), list.begin(), list.end());
  }
  links.clear();
  for (auto &[part, link] : by_rank) {
    link.rank = part;
    link.out.resize(link.sent.size());
    links.push_back(std::move(link));
  }
}

void Packing::find_neighbours()
{
  const double skin = skin_share * largest;
  take_to_parts();
  fetch_ghosts(skin);
  const ContactGrid grid(place.lower, place.upper, place.box, 2. * largest * (1. + margin) + skin);
  std::vector<std::uint64_t> keys;
  for (const Sphere &sphere : spheres)
    keys.push_back(grid.key(sphere.position));
  std::vector<std::int32_t> order(spheres.size());
  std::iota(order.begin(), order.end(), 0);
  const auto comes_first = [&](const std::int32_t a, const std::int32_t b) {
    return keys[a] != keys[b] ? keys[a] < keys[b] : spheres[a].id < spheres[b].id;
  };
  const auto first_ghost = order.begin() + static_cast<std::ptrdiff_t>(n_own);
  std::sort(order.begin(), first_ghost, comes_first);
  std::sort(first_ghost, order.end(), comes_first);

  // Only what the grid looks at.
  ParticleArrays rows;
  rows.n_owned = n_own;
  rows.n_ghosts = spheres.size() - n_own;
  for (const std::int32_t k : order) {
    const Vec3 &x = spheres[k].position;
    rows.position.push_back({x.x, x.y, x.z, (1. + margin) * spheres[k].radius});
    rows.reference.push_back(x);
    rows.id.push_back(spheres[k].id);
  }
  PairList pairs;
  pairs.clear(0);
  grid.find_pairs(rows, skin, pairs);
  neighbours.assign(n_own, {});
  const auto add = [this](const std::int32_t k, const std::int32_t other) {
    if (static_cast<std::size_t>(k) < n_own)
      neighbours[k].push_back(other);
  };
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    add(order[pairs.i[p]], order[pairs.j[p]]);
    add(order[pairs.j[p]], order[pairs.i[p]]);
  }
  for (std::vector<std::int32_t> &list : neighbours)
    std::sort(list.begin(), list.end(), [this](const std::int32_t a, const std::int32_t b) {
      return spheres[a].id < spheres[b].id;
    });
  search_obstacles(margin * largest + skin);
}

void Packing::search_obstacles(const double skin)
{
  searched.clear();
  std::vector<double> radii;
  for (std::size_t k = 0; k < n_own; ++k) {
    searched.push_back(spheres[k].position);
    radii.push_back(spheres[k].radius);
  }
  obstacles.search(searched, radii, 0, n_own, skin);
}

void Packing::update_ghosts()
{
  std::vector<Vec3> in(spheres.size() - n_own);
  std::vector<MPI_Request> requests(2 * links.size());
  std::size_t at = 0;
  for (std::size_t l = 0; l < links.size(); ++l) {
    Link &link = links[l];
    for (std::size_t k = 0; k < link.sent.size(); ++k)
      link.out[k] = spheres[link.sent[k]].position;
    MPI_Irecv(in.data() + at, static_cast<int>(3 * link.n_received), MPI_DOUBLE, link.rank,
              tag_packing, comm, &requests[2 * l]);
    MPI_Isend(link.out.data(), static_cast<int>(3 * link.out.size()), MPI_DOUBLE, link.rank,
              tag_packing, comm, &requests[2 * l + 1]);
    at += link.n_received;
  }
  MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
  for (std::size_t k = 0; k < in.size(); ++k)
    spheres[n_own + k].position = in[k];
}

Vec3 Packing::force_on(const std::size_t k, double &worst) const
{
  const Sphere &own = spheres[k];
  Vec3 sum;
  for (const std::int32_t n : neighbours[k]) {
    const Sphere &other = spheres[n];
    const Vec3 away = place.box.shortest(own.position - other.position);
    const double touch = (1. + margin) * (own.radius + other.radius), distance = norm(away);
    if (distance >= touch)
      continue;
    worst = std::max(worst, (touch - distance) / (own.radius + other.radius));
    // Two spheres at the same place separate along an axis, the first one downwards.
    sum += distance > 0. ? (touch / distance - 1.) * away
                         : Vec3{0., 0., (own.id < other.id ? -1. : 1.) * touch};
  }
  double depth = 0.;
  sum += obstacles.push(k, own.position, (1. + margin) * own.radius, depth);
  worst = std::max(worst, depth / own.radius);
  return sum;
}

double Packing::compute_forces()
{
  update_ghosts();
  double worst = 0.;
  force.resize(n_own);
  for (std::size_t k = 0; k < n_own; ++k)
    force[k] = force_on(k, worst);
  MPI_Allreduce(MPI_IN_PLACE, &worst, 1, MPI_DOUBLE, MPI_MAX, comm);
  return worst;
}

void Packing::move(const double time_step)
{
  double moved2 = 0.;
  for (std::size_t k = 0; k < n_own; ++k) {
    Sphere &sphere = spheres[k];
    const Vec3 aim = place.inside(sphere.position + time_step * sphere.velocity, sphere.radius);
    const Vec3 x = place.accepted(sphere.position, aim, sphere.radius, 1e-3 * largest);
    if (x != aim)
      sphere.velocity = 1. / time_step * place.box.shortest(x - sphere.position);
    sphere.position = x;
    moved2 = std::max(moved2, norm_square(place.box.shortest(x - searched[k])));
  }
  MPI_Allreduce(MPI_IN_PLACE, &moved2, 1, MPI_DOUBLE, MPI_MAX, comm);
  // Two spheres may have come closer by twice that.
  if (2. * std::sqrt(moved2) > skin_share * largest)
    find_neighbours();
}

void Packing::scatter(const std::function<double(ParticleId)> &radius, const ParticleId first_id,
                      const std::size_t n, const unsigned int seed)
{
  int n_ranks;
  MPI_Comm_size(comm, &n_ranks);
  const auto [begin, end] = share_of(n, comm);
  on_every_rank(comm, [&, begin = begin, end = end] {
    const std::size_t n_sample = std::min(n, BoxParts::sample_size(n_ranks));
    std::vector<Vec3> sample;
    for (std::size_t k = 0; k < n_sample; ++k) {
      const ParticleId id = first_id + static_cast<ParticleId>(k);
      sample.push_back(draw(id, radius(id), seed));
    }
    parts =
        std::make_unique<BoxParts>(place.lower, place.upper, place.box, std::move(sample), n_ranks);
    for (std::size_t k = begin; k < end; ++k) {
      const ParticleId id = first_id + static_cast<ParticleId>(k);
      const double r = radius(id);
      largest = std::max(largest, r);
      spheres.push_back({id, r, draw(id, r, seed), {}});
    }
  });
  n_own = spheres.size();
  MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPI_DOUBLE, MPI_MAX, comm);
}

bool Packing::relax()
{
  // The constants of the paper; masses and stiffnesses are 1.
  constexpr double start = 0.1, longest = 0.6, mixing_at_start = 0.1;
  double time_step = start, mixing = mixing_at_start;
  unsigned int downhill = 0;
  for (unsigned int step = 0; step < most_steps; ++step) {
    if (compute_forces() <= margin)
      return true;
    ExactSum power, force2, velocity2;
    for (std::size_t k = 0; k < n_own; ++k) {
      power += dot(force[k], spheres[k].velocity);
      force2 += norm_square(force[k]);
      velocity2 += norm_square(spheres[k].velocity);
    }
    ExactSum::reduce({&power, &force2, &velocity2}, comm);
    if (power.value() > 0.) {
      const double along = mixing * std::sqrt(velocity2.value() / force2.value());
      for (std::size_t k = 0; k < n_own; ++k)
        spheres[k].velocity = (1. - mixing) * spheres[k].velocity + along * force[k];
      if (++downhill > 5) {
        time_step = std::min(1.1 * time_step, longest);
        mixing *= 0.99;
      }
    } else {
      for (std::size_t k = 0; k < n_own; ++k)
        spheres[k].velocity = Vec3();
      time_step *= 0.5;
      mixing = mixing_at_start;
      downhill = 0;
    }
    for (std::size_t k = 0; k < n_own; ++k)
      spheres[k].velocity += time_step * force[k];
    move(time_step);
  }
  return false;
}

std::vector<Packing::Sphere> Packing::pack(const std::function<double(ParticleId)> &radius,
                                           const ParticleId first_id, const std::size_t n,
                                           const unsigned int seed)
{
  scatter(radius, first_id, n, seed);
  find_neighbours();
  if (!relax())
    throw UserError(
        "subsection 'insertion info' / entry 'insertion box points coordinates': the " +
        std::to_string(n) +
        " particles could not be packed into the box without overlap. Enlarge the box, "
        "or insert fewer particles; random packings fill up to about 0.6 of a wide box, less of a "
        "narrow one.");
  spheres.resize(n_own);
  return std::move(spheres);
}

} // namespace eunoe
