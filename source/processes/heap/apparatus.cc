#include <eunoe/core/random.h>
#include <eunoe/processes/heap/apparatus.h>
#include <eunoe/processes/loose_powder.h>
#include <eunoe/solids/shapes.h>

#include <nlohmann/json.hpp>

#include <algorithm>

namespace eunoe::heap {

namespace {

/// Solid fraction of settled powder, for numbers that need not be exact.
constexpr double settled_fraction = 0.55;
/// The measured angle of the paper's powder, for the expected mass of a heap (degrees).
constexpr double expected_angle = 37.5;

} // namespace

RigidState Lift::at(const double time) const
{
  RigidState state;
  if (time < start)
    return state;
  const bool rising = time < end();
  state.centre.y = rising ? velocity * (time - start) : way;
  state.velocity.y = rising ? velocity : 0.;
  return state;
}

double wanted_particles(const HeapParameters &p, const ParticleType &type)
{
  const double mean_volume = M_PI / 6. * type.sizes.make()->mean_cube();
  const double heap = M_PI / 3. * std::pow(0.5 * p.disc_diameter, 3) *
                      std::tan(expected_angle * M_PI / 180.) * settled_fraction;
  const double number = p.n_particles > 0 ? p.n_particles
                        : p.mass > 0.     ? p.mass / (type.density * mean_volume)
                                          : p.fill_ratio * heap / mean_volume;
  return std::max(1., std::round(number));
}

Apparatus::Apparatus(const HeapParameters &p, const PhysicalProperties &physics)
    : gravity(-physics.gravity.y), tube(std::make_shared<Lift>(p.lifting_velocity)), p(p),
      largest_diameter(physics.largest_diameter()),
      rim_height(p.rim_height > 0. ? p.rim_height : 5. * largest_diameter),
      pitch(loose_pitch * largest_diameter)
{
  const ParticleType &type = physics.types[0];
  const double mean_volume = M_PI / 6. * type.sizes.make()->mean_cube();
  const double disc_radius = 0.5 * p.disc_diameter, tube_radius = 0.5 * p.tube_diameter;
  n_particles = static_cast<unsigned int>(wanted_particles(p, type));
  settled_height =
      n_particles * mean_volume / (settled_fraction * M_PI * tube_radius * tube_radius);

  // The facets cut into the circle.
  const double inner = tube_radius * std::cos(M_PI / p.n_facets);
  const double reach = inner - 0.5 * largest_diameter - loose_offset * largest_diameter;
  const int n = std::max(0, static_cast<int>(reach / pitch));
  for (int i = -n; i <= n; ++i)
    for (int k = -n; k <= n; ++k)
      if (pitch * std::hypot(i, k) <= std::max(reach, 0.))
        layer.push_back({i * pitch, 0., k * pitch});

  half_width = disc_radius + std::max(0.1 * disc_radius, 6. * largest_diameter);
  y_bottom = -rim_height - 4. * largest_diameter;
  y_top = std::max(loose_height(), p.gap + 3. * settled_height) + 2. * clearance();
}

double Apparatus::expected_heap() const
{
  return 0.5 * p.disc_diameter * std::tan(expected_angle * M_PI / 180.);
}

double Apparatus::loose_height() const
{
  return p.gap + pitch * static_cast<double>((n_particles + layer.size() - 1) / layer.size());
}

Vec3 Apparatus::loose_place(const std::size_t k, const ParticleId id) const
{
  Vec3 x = layer[k % layer.size()];
  x.y = p.gap + (static_cast<double>(k / layer.size()) + 0.5) * pitch;
  for (unsigned int d = 0; d < 3; ++d)
    x[d] += loose_offset * largest_diameter * (uniform(p.seed, Draw::offset, id, d) - 0.5);
  return x;
}

std::array<double, 3> Apparatus::expected_durations() const
{
  const double v = p.insertion_speed;
  const double fall = (std::sqrt(v * v + 2. * gravity * loose_height()) - v) / gravity;
  const double lift = (settled_height + clearance()) / p.lifting_velocity;
  // Times in which waves of a collapse die out, from runs.
  const double rest = p.measurement_delay > 0. ? p.measurement_delay : 0.05 + p.rest_duration;
  return {fall + 0.02 + p.rest_duration, lift, rest};
}

void Apparatus::add_solids(std::vector<Solid> &solids, const int material) const
{
  Solid moving, resting;
  moving.name = "tube";
  moving.shape = std::make_shared<TriangulatedSurface>(
      shapes::cylinder_shell({0., p.gap, 0.}, {0., loose_height() + clearance() - p.gap, 0.},
                             0.5 * p.tube_diameter, p.n_facets));
  moving.motion = tube;
  resting.name = "disc";
  resting.shape = std::make_shared<TriangulatedSurface>(
      shapes::disc({0., -rim_height, 0.}, {0., rim_height, 0.}, 0.5 * p.disc_diameter, p.n_facets));
  resting.motion = std::make_shared<AtRest>();
  for (Solid *const solid : {&moving, &resting}) {
    solid->material = material;
    add_solid(solids, *solid);
  }
}

std::string Apparatus::as_json(const double density) const
{
  nlohmann::ordered_json json;
  json["tube_diameter"] = p.tube_diameter;
  json["disc_diameter"] = p.disc_diameter;
  json["gap"] = p.gap;
  json["rim_height"] = rim_height;
  json["lifting_velocity"] = p.lifting_velocity;
  json["n_particles"] = n_particles;
  json["n_views"] = p.n_views;
  json["y_bottom"] = y_bottom;
  json["y_top"] = y_top;
  json["half_width"] = half_width;
  json["density"] = density;
  return json.dump(2) + "\n";
}

} // namespace eunoe::heap
