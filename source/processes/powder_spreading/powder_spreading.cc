#include <eunoe/checkpoint/checkpoint_file.h>
#include <eunoe/core/files.h>
#include <eunoe/core/random.h>
#include <eunoe/processes/powder_spreading/feed_bed.h>
#include <eunoe/processes/powder_spreading/layer_log.h>
#include <eunoe/processes/powder_spreading/schedule.h>

#include <algorithm>
#include <cmath>

namespace eunoe::spreading {

namespace {

/// Steps between two looks at whether the bed has come to rest.
constexpr unsigned long long settling_check = 500;
/// Distance of the grid points of loose particles over the largest diameter, and their shifts.
constexpr double loose_pitch = 1.05, loose_offset = 0.05;
/// Loose particles inserted over those that the settled bed is expected to take.
constexpr double loose_excess = 1.2;
/// Share of the particles that may still move in a bed that counts as settled.
constexpr double moving_share = 0.01;
/// Solid fraction of a settled bed, for estimates.
constexpr double bed_fraction = 0.55;

/// Layer-by-layer spreading of powder: settles a bed of feedstock, then runs the passes of the
/// schedule and weighs every layer.
class PowderSpreading : public Process
{
public:
  void declare(dealii::ParameterHandler &prm) override { p.declare(prm); }
  void check(const ParameterCheck &check) const override { p.check(check); }
  void check_with(const Parameters &parameters, const ParameterCheck &check) const override;
  void prepare(Parameters &parameters) override;
  RunEstimate estimate(const Parameters &parameters) const override;
  std::vector<Field> fields() const override { return LayerLog::fields(); }
  std::vector<Solid> make_solids(const Parameters &parameters) override
  {
    return apparatus->make_solids(parameters.physics.wall_material());
  }
  void start(Simulation &simulation) override;
  void save(CheckpointWriter &writer) const override;
  void resume(Simulation &simulation, const Checkpoint &checkpoint) override;
  void step(Simulation &simulation) override;
  bool wants_solid_loads(unsigned long long step) const override
  {
    return pass_over_plate >= 0 && step % p.force_sampling == 0;
  }
  double progress(const Simulation &simulation) const override;
  std::string stage() const override;
  bool finished() const override { return phase == Phase::done; }

private:
  enum class Phase
  {
    settling_bed,   ///< the bed that is copied
    settling_stack, ///< the reservoir of the first pass, made of copies
    passes,
    done
  };

  void insert_loose_bed(Simulation &simulation);
  void fill_reservoir(Simulation &simulation, double platform_height);
  bool has_settled(Simulation &simulation);
  void go_on_after_settling(Simulation &simulation);
  void lower_platform(double time);
  void schedule_passes(double beginning);
  void step_passes(Simulation &simulation);
  double bed_particles(const Parameters &parameters, double bed_depth) const;

  SpreadingParameters p;
  std::unique_ptr<Apparatus> apparatus;
  std::unique_ptr<LayerLog> layers;
  FeedBed bed;

  Phase phase = Phase::settling_bed;
  double phase_start = 0.;
  /// When the platform went down for the reservoir of the first pass (s); negative: it did not.
  double lowering = -1.;
  unsigned int n_fillings = 0;
  std::vector<Pass> passes;
  std::size_t next_feed = 0, next_weighing = 0;
  int pass_over_plate = -1;
};

const ProcessRegistry::Registration registration(process_kinds(), "powder spreading", [] {
  return std::make_unique<PowderSpreading>();
});

void PowderSpreading::check_with(const Parameters &parameters, const ParameterCheck &check) const
{
  const std::string section = "powder spreading";
  const double largest = parameters.physics.largest_diameter();
  check.require(parameters.physics.types.size() == 1, {"lagrangian physical properties"},
                "number of particle types",
                "is " + std::to_string(parameters.physics.types.size()) + ".",
                "Powder spreading works with one type; give the size classes as a custom "
                "distribution.");
  check.require(parameters.physics.gravity.y < 0. && parameters.physics.gravity.x == 0. &&
                    parameters.physics.gravity.z == 0.,
                {"lagrangian physical properties"}, "g", "does not point to -y.",
                "Set it to 0, -9.81, 0: in powder spreading y points upwards.");
  for (const auto &[value, entry] : {std::pair(p.w1, "feedstock platform length W1"),
                                     std::pair(p.w3, "measuring plate length W3")})
    check.require(p.length_factor * value > 3. * largest, {section}, entry,
                  "times the length factor is " + format(p.length_factor * value) +
                      " m, less than three of the largest particles.",
                  "Give a larger length or factor.");
  check.require(p.depth >= 2. * largest, {section}, "depth",
                "is " + format(p.depth) + " m, less than two of the largest particles.",
                "Give a larger depth, 2e-3 in the paper.");
  for (const char *const other : {"mesh", "DEM boundary conditions", "insertion info"})
    check.require(!check.has_changes(other), {other}, "", "is set, but the process makes its own.",
                  "Remove the subsection.");
  for (const char *const end : {"end control", "time end", "iteration end"})
    check.require(!check.is_changed({"simulation control"}, end), {"simulation control"}, end,
                  "is set, but the process ends when its last layer is weighed.",
                  "Remove the entry; 'number of layers' rules the length of the run.");
}

void PowderSpreading::prepare(Parameters &parameters)
{
  const double largest = parameters.physics.largest_diameter();
  apparatus = std::make_unique<Apparatus>(p, largest);
  const Apparatus &a = *apparatus;

  // Background cells of 8 to 10 particles of a settled bed, in powers of two over a coarse mesh.
  const double reach = 1.02 * (largest + parameters.model.skin(largest));
  const double width = std::max(1.5 * largest, reach);
  const double lengths[3] = {a.x_end, a.y_top - a.y_bottom, a.depth};
  unsigned int cells[3];
  for (unsigned int d = 0; d < 3; ++d)
    cells[d] = std::max(1u, static_cast<unsigned int>(lengths[d] / width));
  const unsigned int fewest = *std::min_element(cells, cells + 3);
  unsigned int refinement = 0;
  while ((2u << refinement) <= fewest && refinement < 4)
    ++refinement;
  std::string counts;
  for (unsigned int d = 0; d < 3; ++d)
    counts += (d > 0 ? ", " : "") + std::to_string(std::max(1u, cells[d] >> refinement));

  char corners[256];
  std::snprintf(corners, sizeof corners, " : 0, %.17g, 0 : %.17g, %.17g, %.17g : true", a.y_bottom,
                a.x_end, a.y_top, a.depth);
  parameters.mesh.type = "dealii";
  parameters.mesh.grid_type = "subdivided_hyper_rectangle";
  parameters.mesh.grid_arguments = counts + corners;
  parameters.mesh.refinement = refinement;

  BoundaryCondition collector, bottom, period;
  collector.type = bottom.type = "outlet";
  collector.id = 1;
  bottom.id = 2;
  period.type = "periodic";
  period.periodic_ids[0] = 4;
  period.periodic_ids[1] = 5;
  period.periodic_direction = 2;
  parameters.boundaries.conditions = {collector, bottom, period};

  // The process decides when all is done; this is no more than an upper bound.
  parameters.control.end_control = "time";
  parameters.control.time_end =
      make_schedule(p, a, 22. * p.settling_time).back().end + p.settling_time;
}

double PowderSpreading::bed_particles(const Parameters &parameters, const double bed_depth) const
{
  const double volume = M_PI / 6. * parameters.physics.types[0].sizes.make()->mean_cube();
  return bed_fraction * apparatus->x_transfer * apparatus->depth * bed_depth / volume;
}

RunEstimate PowderSpreading::estimate(const Parameters &parameters) const
{
  const Apparatus &a = *apparatus;
  const double volume = M_PI / 6. * parameters.physics.types[0].sizes.make()->mean_cube();
  const double layer = bed_fraction * a.plate_area() * p.layer_thickness / volume;
  const double first = bed_particles(parameters, a.first_bed_depth);
  const double later = p.feedstock == "full"
                           ? 0.5 * (first + bed_particles(parameters, p.bed_margin))
                           : bed_particles(parameters, a.bed_depth);
  const double transit = bed_particles(parameters, p.stroke);
  const auto schedule = make_schedule(p, a, 0.25 * p.settling_time);
  RunEstimate estimate;
  estimate.steps = schedule.back().weighing / parameters.control.time_step;
  estimate.particles = later + transit + 0.5 * p.n_layers * layer;
  estimate.most_particles = std::max(first + transit, later + transit + p.n_layers * layer);
  return estimate;
}

void PowderSpreading::start(Simulation &simulation)
{
  layers = std::make_unique<LayerLog>(simulation, p, *apparatus);
  int rank;
  MPI_Comm_rank(simulation.communicator(), &rank);
  if (rank == 0)
    write_file(simulation.output_file("apparatus.json"),
               apparatus->as_json(simulation.get_parameters().physics.types[0].density));
  insert_loose_bed(simulation);
}

void PowderSpreading::insert_loose_bed(Simulation &simulation)
{
  const Parameters &parameters = simulation.get_parameters();
  const ParticleType &type = parameters.physics.types[0];
  const auto sizes = type.sizes.make();
  const double largest = sizes->largest();
  const ParticleArrays &particles = simulation.complete_step();

  double top = -apparatus->bed_depth;
  for (const std::size_t row : in_reservoir(particles, *apparatus))
    top = std::max(top, particles.position[row].y + particles.position[row].w);
  MPI_Allreduce(MPI_IN_PLACE, &top, 1, MPI_DOUBLE, MPI_MAX, simulation.communicator());

  VolumeGrid grid;
  grid.lower = {0., top, 0.};
  grid.upper = {apparatus->x_transfer, apparatus->y_top, apparatus->depth};
  grid.pitch = loose_pitch * largest;
  grid.offset = loose_offset * largest;
  grid.order = {0, 2, 1};
  // More than the bed takes, as what stands above the level is taken away; what is still missing
  // after settling is added then.
  const double missing = n_fillings == 0 ? apparatus->bed_depth : 0.2 * apparatus->bed_depth;
  const auto n = std::min<std::size_t>(
      grid.capacity(),
      static_cast<std::size_t>(loose_excess * bed_particles(parameters, missing)) + 1);

  const auto [begin, end] = share_of(n, simulation.communicator());
  Delivery delivery;
  for (std::size_t k = begin; k < end; ++k) {
    NewParticle particle;
    particle.id = simulation.next_id + static_cast<ParticleId>(k);
    particle.radius = 0.5 * sizes->diameter(uniform(type.sizes.seed, Draw::size, particle.id));
    particle.mass = sphere_mass(particle.radius, type.density);
    particle.position = grid.point(k, p.seed, particle.id);
    particle.velocity = {0., -p.insertion_speed, 0.};
    delivery.particles.push_back(particle);
  }
  simulation.next_id += static_cast<ParticleId>(n);
  simulation.exchange(delivery, {});
  phase_start = simulation.time();
  ++n_fillings;
}

void PowderSpreading::fill_reservoir(Simulation &simulation, const double platform_height)
{
  simulation.exchange(bed.stack(simulation, *apparatus, platform_height, p.seed,
                                static_cast<unsigned int>(next_feed)),
                      in_reservoir(simulation.complete_step(), *apparatus));
}

bool PowderSpreading::has_settled(Simulation &simulation)
{
  const double waited = simulation.time() - phase_start;
  if (simulation.step_number() % settling_check != 0 || waited < 1e-3)
    return false;
  const ParticleArrays &particles = simulation.complete_step();
  unsigned long long count[2] = {0, particles.n_owned};
  for (std::size_t row = 0; row < particles.n_owned; ++row)
    if (norm(particles.velocity[row].vec()) > p.settled_speed)
      ++count[0];
  MPI_Allreduce(MPI_IN_PLACE, count, 2, MPI_UNSIGNED_LONG_LONG, MPI_SUM, simulation.communicator());
  // The last few that bounce on the surface are no reason to wait.
  const bool settled = static_cast<double>(count[0]) < moving_share * static_cast<double>(count[1]);
  if (!settled && waited < p.settling_time)
    return false;
  if (!settled)
    simulation.get_log().warning("after the settling time of " + format(p.settling_time) + " s, " +
                                 std::to_string(count[0]) + " of " + std::to_string(count[1]) +
                                 " particles of the feedstock still move faster than " +
                                 format(p.settled_speed) + " m/s; going on.");
  return true;
}

void PowderSpreading::go_on_after_settling(Simulation &simulation)
{
  const std::vector<std::size_t> above = above_level(simulation.complete_step(), *apparatus);
  unsigned long long n_above = above.size();
  MPI_Allreduce(MPI_IN_PLACE, &n_above, 1, MPI_UNSIGNED_LONG_LONG, MPI_SUM,
                simulation.communicator());
  constexpr unsigned int most_fillings = 20;
  if (phase == Phase::settling_bed && n_above == 0 && n_fillings < most_fillings) {
    insert_loose_bed(simulation);
    return;
  }
  simulation.exchange({}, above);
  if (phase == Phase::settling_bed) {
    bed.take(simulation, *apparatus, -apparatus->bed_depth);
    simulation.get_log().line("The feedstock bed is at rest after " + format(simulation.time()) +
                              " s: " + std::to_string(bed.size()) + " particles");
    if (apparatus->first_bed_depth > apparatus->bed_depth) {
      lower_platform(simulation.time());
      simulation.renew_solids();
      fill_reservoir(simulation, -apparatus->first_bed_depth);
      phase = Phase::settling_stack;
      phase_start = simulation.time();
      return;
    }
  }
  phase = Phase::passes;
  schedule_passes(simulation.time());
  next_feed = 1;
}

void PowderSpreading::lower_platform(const double time)
{
  lowering = time;
  apparatus->platform->add(time, 0., {0., apparatus->bed_depth - apparatus->first_bed_depth, 0.});
}

void PowderSpreading::schedule_passes(const double beginning)
{
  passes = make_schedule(p, *apparatus, beginning);
  double height = -apparatus->first_bed_depth;
  for (std::size_t k = 0; k < passes.size(); ++k) {
    const Pass &pass = passes[k];
    const double stroke = k == 0 ? p.first_stroke : p.stroke;
    if (k > 0 && p.feedstock == "replenished") {
      apparatus->platform->add(pass.feed, 0., {0., -apparatus->bed_depth - height, 0.});
      height = -apparatus->bed_depth;
    }
    apparatus->platform->add(pass.feed, stroke / p.platform_velocity, {0., stroke, 0.});
    height += stroke;
    apparatus->spreaders[k % Apparatus::n_spreaders]->add(pass.start);
    apparatus->plate->add(pass.weighing, p.layer_thickness / p.plate_velocity,
                          {0., -p.layer_thickness, 0.});
  }
}

void PowderSpreading::save(CheckpointWriter &writer) const
{
  writer.head["powder spreading"] = {{"phase", static_cast<int>(phase)},
                                     {"phase_start", phase_start},
                                     {"fillings", n_fillings},
                                     {"lowering", lowering},
                                     {"beginning", passes.empty() ? -1. : passes.front().feed},
                                     {"next_feed", next_feed},
                                     {"next_weighing", next_weighing},
                                     {"pass_over_plate", pass_over_plate},
                                     {"layers", layers->save()}};
  bed.save(writer);
}

void PowderSpreading::resume(Simulation &simulation, const Checkpoint &checkpoint)
{
  const auto &saved = checkpoint.head.at("powder spreading");
  phase = static_cast<Phase>(saved.at("phase").get<int>());
  phase_start = saved.at("phase_start");
  n_fillings = saved.at("fillings");
  if (saved.at("lowering") >= 0.)
    lower_platform(saved.at("lowering"));
  if (saved.at("beginning") >= 0.)
    schedule_passes(saved.at("beginning"));
  next_feed = saved.at("next_feed");
  next_weighing = saved.at("next_weighing");
  pass_over_plate = saved.at("pass_over_plate");
  layers = std::make_unique<LayerLog>(simulation, p, *apparatus);
  layers->load(saved.at("layers"));
  bed.load(simulation, checkpoint);
}

void PowderSpreading::step(Simulation &simulation)
{
  if (phase == Phase::passes)
    step_passes(simulation);
  else if (phase != Phase::done && has_settled(simulation))
    go_on_after_settling(simulation);
}

void PowderSpreading::step_passes(Simulation &simulation)
{
  const double t = simulation.time();
  if (wants_solid_loads(simulation.step_number()))
    layers->sample_force(simulation,
                         "spreader " + std::to_string(pass_over_plate % Apparatus::n_spreaders));
  if (next_feed < passes.size() && t >= passes[next_feed].feed) {
    if (p.feedstock == "replenished")
      fill_reservoir(simulation, -apparatus->bed_depth);
    ++next_feed;
  }
  pass_over_plate = -1;
  for (std::size_t k = next_weighing; k < passes.size() && t >= passes[k].over_plate; ++k)
    if (t < passes[k].past_plate)
      pass_over_plate = static_cast<int>(k);
  if (t >= passes[next_weighing].weighing) {
    layers->weigh(simulation, static_cast<unsigned int>(next_weighing),
                  apparatus->plate->at(t).centre.y);
    if (++next_weighing == passes.size())
      phase = Phase::done;
  }
}

double PowderSpreading::progress(const Simulation &simulation) const
{
  const double begin =
      passes.empty() ? simulation.time() + 0.25 * p.settling_time : passes.front().feed;
  const double end = begin + make_schedule(p, *apparatus, 0.).back().weighing;
  return std::min(1., simulation.time() / end);
}

std::string PowderSpreading::stage() const
{
  switch (phase) {
  case Phase::settling_bed:
    return "settling the feedstock";
  case Phase::settling_stack:
    return "filling the reservoir";
  case Phase::passes:
    return "layer " + std::to_string(next_weighing) + " of " + std::to_string(passes.size() - 1);
  default:
    return "";
  }
}

} // namespace
} // namespace eunoe::spreading
