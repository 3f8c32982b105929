#include <eunoe/processes/powder_spreading/apparatus.h>
#include <eunoe/solids/shapes.h>

#include <algorithm>

namespace eunoe::spreading {

namespace {

/// Distance of the spreader's front from the platform when a pass starts (m).
constexpr double run_up = 0.2e-3;
/// A typical slope of a heap of metal powder, for sizes that only need to be large enough.
const double slope = std::tan(35. * M_PI / 180.);

/// A surface along z through the points of a profile in the x-y plane.
TriangleMesh extrude(const std::vector<Vec3> &profile, double z, double length)
{
  TriangleMesh mesh;
  const Vec3 along = {0., 0., length};
  for (std::size_t k = 0; k + 1 < profile.size(); ++k) {
    const Vec3 a = profile[k] + Vec3{0., 0., z}, b = profile[k + 1] + Vec3{0., 0., z};
    mesh.add_quad(a, b, b + along, a + along);
  }
  return mesh;
}

} // namespace

Apparatus::Apparatus(const SpreadingParameters &p, const double largest_diameter)
    : p(p), margin(2. * largest_diameter)
{
  depth = p.depth;
  x_transfer = p.length_factor * p.w1;
  x_gap = x_transfer + p.length_factor * p.w2;
  x_plate = x_gap + p.gap + p.rim;
  x_plate_end = x_plate + p.length_factor * p.w3;
  x_exit = x_plate_end + p.rim + p.gap;
  x_end = x_exit + p.length_factor * p.w4;

  const bool round = p.spreader == "half round";
  front = round ? p.spreader_radius : 0.;
  rear = round ? p.spreader_radius : p.spreader_thickness;
  x_start = -run_up - front;

  // The bed is that of the nominal strokes, so errors of the stroke do not change the powder.
  const double strokes =
      p.feedstock == "full" ? p.first_stroke + (p.n_layers - 1) * p.stroke : p.first_stroke;
  bed_depth = p.bed_depth > 0. ? p.bed_depth : p.stroke + p.bed_margin;
  first_bed_depth = depth_for(strokes);
  bed_level = p.bed_level;

  const double largest_stroke =
      std::max(1., 1. + p.stroke_error) * std::max(p.first_stroke, p.stroke);
  const double pile_height = std::sqrt(2. * largest_stroke * x_transfer * slope);
  spreader_height = p.spreader_height > 0. ? p.spreader_height
                                           : std::max(1.2 * front, largest_stroke + pile_height);
  // A later series has a bed of its own, for strokes that may be larger than the first.
  y_bottom = -std::max({first_bed_depth, depth_for(p.stroke),
                        -p.plate_level(p.n_layers) + p.plate_recoil + p.lip}) -
             4. * largest_diameter;
  // Loose particles for the bed need five times its height.
  y_top = std::max(p.mean_clearance() + spreader_height + p.spreader_tilt + p.vibration_amplitude,
                   4.2 * (bed_depth + bed_level)) +
          2. * largest_diameter;

  platform = std::make_shared<StrokeMotion>(Vec3{0., -bed_depth, 0.});
  plate = std::make_shared<StrokeMotion>(Vec3{0., p.plate_level(0), 0.});
  if (p.plate_recoil > 0.)
    yielding_plate = std::make_shared<YieldingMotion>(plate, Vec3{0., -p.plate_recoil, 0.});
  for (auto &spreader : spreaders)
    spreader = std::make_shared<PassMotion>(Vec3{x_start, p.mean_clearance(), 0.},
                                            Vec3{p.velocity, 0., 0.}, path() / p.velocity,
                                            Vec3{2. * margin, 0., 0.});
}

double Apparatus::pile_length() const
{
  return std::sqrt(2. * p.actual_stroke(1) * x_transfer / slope);
}

double Apparatus::tilt(const double z) const
{
  const double place = z / depth;
  if (p.side_walls)
    return p.spreader_tilt * (place - 0.5);
  // The tilt goes up and down again, or the spreader would have a step at the period.
  const double share = place - std::floor(place);
  return p.spreader_tilt * (std::abs(2. * share - 1.) - 0.5);
}

TriangleMesh Apparatus::spreader_piece(const double z, const double length) const
{
  return p.spreader == "half round"
             ? shapes::half_round_bar({0., 0., z}, length, p.spreader_radius, spreader_height,
                                      p.spreader_facets)
             : shapes::flat_blade({0., 0., z}, length, p.spreader_thickness, spreader_height);
}

TriangleMesh Apparatus::spreader_surface() const
{
  if (p.spreader_tilt == 0.)
    return spreader_piece(-margin, depth + 2. * margin);
  // Ends of pieces over which the tilt is linear.
  std::vector<double> ends = {-margin, depth + margin};
  if (!p.side_walls)
    for (double z = 0.5 * depth * std::ceil(-2. * margin / depth); z < depth + margin;
         z += 0.5 * depth)
      if (z > -margin)
        ends.insert(ends.end() - 1, z);
  TriangleMesh all;
  for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
    TriangleMesh piece = spreader_piece(ends[k], ends[k + 1] - ends[k]);
    for (Vec3 &x : piece.vertices)
      x.y += tilt(x.z);
    all.append(piece);
  }
  return all;
}

TriangleMesh Apparatus::rim_piece(const double x, const double z, const double length) const
{
  const double foot = y_bottom - margin;
  return extrude({{x, foot, 0.}, {x, 0., 0.}, {x + p.rim, 0., 0.}, {x + p.rim, foot, 0.}}, z,
                 length);
}

Apparatus::SolidHandles Apparatus::add_solids(std::vector<Solid> &solids, const int material) const
{
  const double z = -margin, length = depth + 2. * margin;
  const double foot = y_bottom - margin, edge = p.rim > 0. ? foot : -p.lip;
  const auto add = [&](const std::string &name, const TriangleMesh &mesh,
                       std::shared_ptr<const Motion> motion) {
    Solid solid;
    solid.name = name;
    solid.shape = std::make_shared<TriangulatedSurface>(mesh);
    solid.motion = std::move(motion);
    solid.material = material;
    return add_solid(solids, solid);
  };
  SolidHandles handles;
  const TriangleMesh spreader = spreader_surface();
  for (unsigned int k = 0; k < n_spreaders; ++k) {
    std::shared_ptr<const Motion> motion = spreaders[k];
    if (p.vibration_amplitude > 0.)
      motion = std::make_shared<VibratingMotion>(motion, Vec3{0., p.vibration_amplitude, 0.},
                                                 p.vibration_frequency);
    handles.spreaders[k] = add("spreader " + std::to_string(k), spreader, motion);
  }
  handles.platform = add("feedstock platform",
                         extrude({{-margin, 0., 0.}, {x_transfer, 0., 0.}}, z, length), platform);
  add("transfer plate",
      extrude({{x_transfer, foot, 0.}, {x_transfer, 0., 0.}, {x_gap, 0., 0.}, {x_gap, edge, 0.}}, z,
              length),
      std::make_shared<AtRest>());
  handles.plate = add("measuring plate",
                      extrude({{x_plate, -p.lip, 0.},
                               {x_plate, 0., 0.},
                               {x_plate_end, 0., 0.},
                               {x_plate_end, -p.lip, 0.}},
                              z, length),
                      yielding_plate ? std::shared_ptr<const Motion>(yielding_plate) : plate);
  add("exit plate",
      extrude({{x_exit, edge, 0.}, {x_exit, 0., 0.}, {x_end + margin, 0., 0.}}, z, length),
      std::make_shared<AtRest>());
  if (p.rim > 0.) {
    TriangleMesh rims = rim_piece(x_plate - p.rim, z, length);
    rims.append(rim_piece(x_plate_end, z, length));
    add("rims", rims, std::make_shared<AtRest>());
  }
  return handles;
}

} // namespace eunoe::spreading
