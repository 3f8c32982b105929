// What the heap instrument asks of the other parameters, what it decides of them, what it will
// cost.

#include <eunoe/processes/box_mesh.h>
#include <eunoe/processes/common_checks.h>
#include <eunoe/processes/heap/heap.h>

namespace eunoe::heap {

namespace {

const ProcessRegistry::Registration registration(process_kinds(), "heap",
                                                 [] { return std::make_unique<HeapParameters>(); });

/// Beyond these, numbers of places and of particles are mistakes in the input.
constexpr double widest_tube = 5000., most_particles = 1e9;

} // namespace

void HeapParameters::check_with(const Parameters &parameters, const ParameterCheck &check) const
{
  require_one_type(parameters, check, "The heap");
  check_gravity_of_process(parameters, check, "the tube is lifted along +y");
  const double largest = parameters.physics.largest_diameter();
  check.require(tube_diameter >= 5. * largest, {section}, "tube inner diameter",
                "is " + format(tube_diameter) + " m, less than five of the largest particles.",
                "Give a wider tube, 10e-3 in the paper.");
  check.require(!(tube_diameter > widest_tube * largest), {section}, "tube inner diameter",
                "is " + format(tube_diameter) + " m, more than " + format(widest_tube) +
                    " of the largest particles.",
                "Give a narrower tube, 10e-3 in the paper.");
  const double number = wanted_particles(*this, parameters.physics.types[0]);
  check.require(number <= most_particles, {section}, "",
                "asks for " + format(number) + " particles, and " + format(most_particles) +
                    " are the most.",
                "Give a smaller 'number of particles', 'mass' or 'fill ratio'.");
  check.advise(gap < largest, {section}, "gap below the tube",
               "is " + format(gap) + " m, so that powder flows out while the tube is filled.",
               "Give less than the largest diameter.");
  refuse_decisions_of_process(check, "the heap is measured", "'longest wait' bounds");
  if (measured_profile.empty())
    return;
  try {
    read_profile(measured_profile);
  } catch (const UserError &error) {
    check.require(false, {section}, "measured profile", "is of no use.", error.what());
  }
}

void HeapParameters::decide(Parameters &parameters) const
{
  const double largest = parameters.physics.largest_diameter();
  const Apparatus a(*this, parameters.physics);
  parameters.mesh = box_mesh(
      section, {-a.half_width, a.y_bottom, -a.half_width}, {a.half_width, a.y_top, a.half_width},
      largest, parameters.detection.skin(largest) + parameters.contact_model(largest).range());
  parameters.boundaries.conditions.clear();
  for (const unsigned int side : box_side::all) {
    BoundaryCondition outlet;
    outlet.type = "outlet";
    outlet.id = side;
    parameters.boundaries.conditions.push_back(outlet);
  }
  // The process decides when all is done; this is no more than an upper bound.
  parameters.control.end_control = "time";
  parameters.control.time_end =
      2.1 * longest_wait + measurement_delay + (a.y_top - a.y_bottom) / lifting_velocity;
}

double HeapParameters::fastest_solid() const
{
  return lifting_velocity;
}

RunEstimate HeapParameters::estimate(const Parameters &parameters) const
{
  const Apparatus a(*this, parameters.physics);
  const auto [filling, lifting, resting] = a.expected_durations();
  RunEstimate estimate;
  estimate.steps = (filling + lifting + resting) / parameters.control.time_step;
  estimate.particles = 0.7 * a.n_particles;
  estimate.most_particles = a.n_particles;
  estimate.pictures = picture ? 1. : 0.;
  return estimate;
}

bool HeapParameters::is_done(const nlohmann::ordered_json &head) const
{
  return Heap::is_done(head);
}

std::unique_ptr<Process> HeapParameters::make(const Parameters &parameters) const
{
  return std::make_unique<Heap>(*this, parameters.physics);
}

std::vector<Measurement> HeapParameters::measure(
    const Parameters &parameters, const std::vector<std::vector<GivenParticle>> &moments) const
{
  if (moments.size() != 1)
    throw UserError("A heap is measured once, and there are " + std::to_string(moments.size()) +
                    " files of particles. Give one.");
  return heap::measure(*this, parameters.physics, moments.front());
}

std::vector<ObservableDescription> HeapParameters::observables() const
{
  return heap::observables();
}

std::vector<std::string> HeapParameters::results() const
{
  return {"heap.csv", "heap_profile.csv", "heap_map.pgm", "apparatus.json"};
}

} // namespace eunoe::heap
