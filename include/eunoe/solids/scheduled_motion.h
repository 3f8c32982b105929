#ifndef eunoe_solids_scheduled_motion_h
#define eunoe_solids_scheduled_motion_h

#include <eunoe/solids/motion.h>

#include <vector>

namespace eunoe {

/// A sequence of straight strokes with rest between them, each with a velocity that is a parabola
/// in time: it starts and ends at rest, and its mean is two thirds of its largest value.
class StrokeMotion : public Motion
{
public:
  explicit StrokeMotion(const Vec3 &start) : start(start) {}

  /// Appends a stroke, which must not begin before the last one ends; a duration of zero is a jump.
  void add(double time, double duration, const Vec3 &displacement)
  {
    strokes.push_back({time, duration, displacement});
  }

  RigidState at(double time) const override;

private:
  struct Stroke
  {
    double start, duration;
    Vec3 displacement;
  };

  const Vec3 start;
  std::vector<Stroke> strokes;
};

/// Passes along a line at constant velocity, each from the same place; at rest at the start before
/// the first one, and after one beyond its end, out of the way, until the next.
class PassMotion : public Motion
{
public:
  /// @param parking from the end of a pass to the place of rest (m)
  PassMotion(const Vec3 &start, const Vec3 &velocity, double duration, const Vec3 &parking = {})
      : start(start), velocity(velocity), parking(parking), duration(duration)
  {
  }

  /// Appends a pass, which must not begin before the last one ends (s).
  void add(double time) { passes.push_back(time); }

  RigidState at(double time) const override;

private:
  const Vec3 start, velocity, parking;
  const double duration;
  std::vector<double> passes;
};

} // namespace eunoe

#endif
