#ifndef eunoe_solids_disturbed_motion_h
#define eunoe_solids_disturbed_motion_h

#include <eunoe/solids/motion.h>

#include <memory>
#include <vector>

namespace eunoe {

/// A motion with a harmonic vibration on top: amplitude sin(2 pi f t), from t = 0 on.
class VibratingMotion : public Motion
{
public:
  /// @param amplitude direction and length (m)
  /// @param frequency (Hz)
  VibratingMotion(std::shared_ptr<const Motion> motion, const Vec3 &amplitude, double frequency)
      : motion(std::move(motion)), amplitude(amplitude), pulsation(2. * M_PI * frequency)
  {
  }

  RigidState at(double time) const override;
  bool rotates() const override { return motion->rotates(); }

private:
  const std::shared_ptr<const Motion> motion;
  const Vec3 amplitude;
  const double pulsation;
};

/// A motion with excursions on top, each there and back along a squared sine, so that they begin
/// and end at rest.
class YieldingMotion : public Motion
{
public:
  /// @param excursion at the middle of its duration (m)
  YieldingMotion(std::shared_ptr<const Motion> motion, const Vec3 &excursion)
      : motion(std::move(motion)), excursion(excursion)
  {
  }

  /// Appends an excursion, which must not begin before the last one ends (s).
  void add(double time, double duration) { intervals.push_back({time, duration}); }

  RigidState at(double time) const override;
  bool rotates() const override { return motion->rotates(); }

private:
  struct Interval
  {
    double start, duration;
  };

  const std::shared_ptr<const Motion> motion;
  const Vec3 excursion;
  std::vector<Interval> intervals;
};

} // namespace eunoe

#endif
