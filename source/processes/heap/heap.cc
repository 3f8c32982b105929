#include <eunoe/checkpoint/checkpoint_file.h>
#include <eunoe/processes/box_mesh.h>
#include <eunoe/processes/heap/heap.h>

#include <algorithm>

namespace eunoe::heap {

namespace {

const ProcessRegistry::Registration registration(process_kinds(), "heap",
                                                 [] { return std::make_unique<Heap>(); });

} // namespace

void Heap::check_with(const Parameters &parameters, const ParameterCheck &check) const
{
  const double largest = parameters.physics.largest_diameter();
  check.require(parameters.physics.types.size() == 1, {"lagrangian physical properties"},
                "number of particle types",
                "is " + std::to_string(parameters.physics.types.size()) + ".",
                "The heap works with one type; give the size classes as a custom distribution.");
  const Vec3 &g = parameters.physics.gravity;
  check.require(g.y < 0. && g.x == 0. && g.z == 0., {"lagrangian physical properties"}, "g",
                "does not point to -y.", "Set it to 0, -9.81, 0: the tube is lifted along +y.");
  check.require(p.tube_diameter >= 5. * largest, {"heap"}, "tube inner diameter",
                "is " + format(p.tube_diameter) + " m, less than five of the largest particles.",
                "Give a wider tube, 10e-3 in the paper.");
  check.advise(p.gap < largest, {"heap"}, "gap below the tube",
               "is " + format(p.gap) + " m, so that powder flows out while the tube is filled.",
               "Give less than the largest diameter.");
  for (const char *const other :
       {"mesh", "box refinement", "DEM boundary conditions", "insertion info"})
    check.require(!check.has_changes(other), {other}, "", "is set, but the process makes its own.",
                  "Remove the subsection.");
  for (const char *const end : {"end control", "time end", "iteration end"})
    check.require(!check.is_changed({"simulation control"}, end), {"simulation control"}, end,
                  "is set, but the process ends when the heap is measured.",
                  "Remove the entry; 'longest wait' bounds the length of the run.");
  if (p.measured_profile.empty())
    return;
  try {
    read_profile(p.measured_profile);
  } catch (const UserError &error) {
    check.require(false, {"heap"}, "measured profile", "is of no use.", error.what());
  }
}

void Heap::prepare(Parameters &parameters)
{
  const ParticleType &type = parameters.physics.types[0];
  const double largest = parameters.physics.largest_diameter();
  apparatus = std::make_unique<Apparatus>(p, largest, M_PI / 6. * type.sizes.make()->mean_cube(),
                                          type.density);
  gravity = -parameters.physics.gravity.y;
  const Apparatus &a = *apparatus;
  parameters.mesh = box_mesh(
      "heap", {-a.half_width, a.y_bottom, -a.half_width}, {a.half_width, a.y_top, a.half_width},
      largest, parameters.detection.skin(largest) + parameters.contact_model(largest).range());
  parameters.boundaries.conditions.clear();
  for (unsigned int side = 0; side < 6; ++side) {
    BoundaryCondition outlet;
    outlet.type = "outlet";
    outlet.id = side;
    parameters.boundaries.conditions.push_back(outlet);
  }
  // The process decides when all is done; this is no more than an upper bound.
  parameters.control.end_control = "time";
  parameters.control.time_end = 2.1 * p.longest_wait + (a.y_top - a.y_bottom) / p.lifting_velocity;
}

std::array<double, 3> Heap::expected_durations() const
{
  const double v = p.insertion_speed;
  const double fall = (std::sqrt(v * v + 2. * gravity * apparatus->loose_height()) - v) / gravity;
  const double lift = (apparatus->settled_height + apparatus->clearance()) / p.lifting_velocity;
  // Times in which waves of a collapse die out, from runs.
  return {fall + 0.02 + p.rest_duration, lift, 0.05 + p.rest_duration};
}

RunEstimate Heap::estimate(const Parameters &parameters) const
{
  const auto [filling, lifting, resting] = expected_durations();
  RunEstimate estimate;
  estimate.steps = (filling + lifting + resting) / parameters.control.time_step;
  estimate.particles = 0.7 * apparatus->n_particles;
  estimate.most_particles = apparatus->n_particles;
  return estimate;
}

void Heap::start(Simulation &simulation)
{
  simulation.output_folder().write(
      "apparatus.json", apparatus->as_json(simulation.get_parameters().physics.types[0].density));
  fill(simulation);
}

void Heap::step(Simulation &simulation)
{
  if (phase == Phase::filling && is_at_rest(simulation))
    begin_lifting(simulation);
  else if (phase == Phase::lifting && simulation.time() >= apparatus->tube->end()) {
    phase = Phase::resting;
    phase_start = simulation.time();
    calm_since = -1.;
  } else if (phase == Phase::resting && is_at_rest(simulation))
    finish(simulation);
}

void Heap::save(CheckpointWriter &writer) const
{
  writer.head["heap"] = {{"phase", static_cast<int>(phase)},
                         {"phase_start", phase_start},
                         {"calm_since", calm_since},
                         {"lift_start", lift_start},
                         {"lift_way", lift_way},
                         {"results", results.keys},
                         {"measured", to_json(results.measured)}};
}

void Heap::resume(Simulation &, const Checkpoint &checkpoint)
{
  const auto &saved = checkpoint.head.at("heap");
  phase = static_cast<Phase>(saved.at("phase").get<int>());
  phase_start = saved.at("phase_start");
  calm_since = saved.at("calm_since");
  lift_start = saved.at("lift_start");
  lift_way = saved.at("lift_way");
  results.keys = saved.at("results");
  results.measured = measurements_in(saved.at("measured"));
  if (lift_start >= 0.)
    apparatus->tube->begin(lift_start, lift_way);
}

double Heap::progress(const Simulation &simulation) const
{
  const auto durations = expected_durations();
  double before = 0.;
  const auto present = std::min<std::size_t>(static_cast<std::size_t>(phase), 2);
  for (std::size_t k = 0; k < present; ++k)
    before += durations[k];
  const double now = std::min(simulation.time() - phase_start, 0.99 * durations[present]);
  return (before + now) / (durations[0] + durations[1] + durations[2]);
}

std::string Heap::stage() const
{
  switch (phase) {
  case Phase::filling:
    return "filling the tube";
  case Phase::lifting:
    return "lifting the tube";
  case Phase::resting:
    return "the heap comes to rest";
  default:
    return "";
  }
}

} // namespace eunoe::heap
