// The clock of a run: steps, their time, the end, and how it continues from a checkpoint.

#include <eunoe/engine/clock.h>

#include "../tests.h"
#include <nlohmann/json.hpp>

using namespace test;

EUNOE_MPI_TEST()
{
  Clock clock(0.1, 5);
  check("a run of no step is at its end", Clock(0.1, 0).is_at_end());
  for (unsigned int step = 0; step < 3; ++step)
    clock.advance();
  check("time without summed rounding", clock.time() == 3. * 0.1);
  check("three of five steps", clock.step() == 3 && clock.share() == 0.6 && !clock.is_at_end());

  // Of four more steps than are done.
  const Clock::End end = [](const unsigned long long step, double) { return step + 4; };
  const Clock::End fifth = [](unsigned long long, double) { return 5; };
  Clock continued(0.1, 5);
  continued.load(clock.save(), fifth);
  check("it goes on", continued.step() == 3 && continued.time() == clock.time());
  check("this part began there", continued.first_step() == 3 && clock.first_step() == 0);
  continued.advance();
  continued.advance();
  check("the end", continued.is_at_end() && continued.first_step() == 3);

  Clock shorter(0.05, 4);
  shorter.begin_phase(clock.save(), end);
  check("time goes on with other steps", shorter.step() == 3 && shorter.time() == clock.time());
  shorter.advance();
  check("which are shorter", shorter.time() == 3. * 0.1 + 0.05);
  for (unsigned int step = 0; step < 3; ++step)
    shorter.advance();
  check("to another end", shorter.is_at_end() && shorter.step() == 7);
  Clock phase_continued(0.05, 100);
  phase_continued.load(shorter.save(), end);
  check("which goes on, too", phase_continued.time() == shorter.time());
  check("to the end that follows from the phase's beginning", phase_continued.is_at_end());

  bool refused = false;
  try {
    nlohmann::ordered_json saved = clock.save();
    saved["step"] = 0.5;
    continued.load(saved, fifth);
  } catch (const std::invalid_argument &) {
    refused = true;
  }
  check("half a step is refused", refused);
}
