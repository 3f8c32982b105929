// When the regular pictures are due, by steps and by time and within a window, also after a
// restart.

#include <eunoe/core/files.h>
#include <eunoe/simulation/outputs.h>

#include "../tests.h"
#include <nlohmann/json.hpp>

using namespace test;

namespace {

ControlParameters control()
{
  ControlParameters c;
  c.output_path = "outputs_of_test";
  return c;
}

/// Steps of 0.1 s at which pictures are due.
/// @param restart step after which a new object continues from the saved state
/// @param later what rules from then on; null: the same
std::string pictures(const ControlParameters &c, unsigned long long restart = 0,
                     const ControlParameters *later = nullptr)
{
  Timers timers;
  auto outputs = std::make_unique<Outputs>(c, timers, MPI_COMM_WORLD);
  outputs->folder.open();
  outputs->begin_series(nullptr);
  Clock clock(0.1, 100);
  std::string steps;
  while (true) {
    if (outputs->are_pictures_due(clock))
      steps += " " + std::to_string(clock.step());
    if (clock.step() == 20)
      return steps;
    if (restart > 0 && clock.step() == restart) {
      const auto saved = nlohmann::ordered_json::parse(outputs->save().dump());
      outputs = std::make_unique<Outputs>(later != nullptr ? *later : c, timers, MPI_COMM_WORLD);
      outputs->folder.open();
      outputs->begin_series(&saved);
      outputs->load(saved);
    }
    clock.advance();
  }
}

/// A table of an observable that is off for a part of a run goes on where it was.
void tables_that_pause()
{
  const std::vector<std::string> columns = {"time"};
  nlohmann::ordered_json saved;
  for (const bool is_on : {true, false, true}) {
    OutputFolder folder("outputs_of_test", MPI_COMM_WORLD);
    folder.open();
    if (!saved.is_null())
      folder.resume(saved);
    if (is_on) {
      const auto table = folder.table("pausing.csv", columns);
      table->write({saved.is_null() ? 1. : 2.});
    }
    saved = folder.save();
  }
  const std::string text = read_file("outputs_of_test/pausing.csv", MPI_COMM_WORLD);
  check("a table that pauses", text == "time\n1\n2\n", text);
}

void expect(const std::string &name, const std::string &found, const std::string &expected)
{
  check(name, found == expected, "at" + found);
}

} // namespace

EUNOE_MPI_TEST()
{
  ControlParameters c = control();
  expect("none", pictures(c), "");
  c.output_frequency = 7;
  expect("by steps", pictures(c), " 0 7 14");
  c.output_window = {0.74, 1.33};
  expect("within the window, half a step wider", pictures(c), " 7");
  c = control();
  c.output_control = "time";
  c.output_time = 0.5;
  expect("by time", pictures(c), " 0 5 10 15 20");
  expect("by time, restarted", pictures(c, 7), " 0 5 10 15 20");
  ControlParameters by_steps = control(), rarely = c;
  by_steps.output_frequency = 3;
  rarely.output_time = 5.;
  expect("by steps, then by time", pictures(by_steps, 7, &c), " 0 3 6 11 16");
  expect("rarely, then more often", pictures(rarely, 7, &c), " 0 8 13 18");
  c.output_window = {0.9, 1e308};
  expect("by time, from a moment on", pictures(c), " 10 15 20");
  Timers timers;
  Outputs closed(c, timers, MPI_COMM_WORLD);
  check("none without a folder", !closed.are_pictures_due(Clock(0.1, 100)));
  tables_that_pause();
}
