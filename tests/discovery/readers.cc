// The error messages for bad studies, effects and measurements; what tells cases apart; and files
// that are written can be read back.

#include <eunoe/discovery/measured_csv.h>
#include <eunoe/discovery/study_input.h>

#include "../tests.h"
#include "drop_process.h"

#include <fstream>
#include <set>

namespace {

using namespace test;
using namespace eunoe::discovery;

const std::string folder = DISCOVERY_TESTS;
const std::string heading = "experiment,observable,index,value,std,repeats,use\n";

/// The problems as text, without the path of the tests' folder.
void print_problems(const std::string &title, const Problems &problems)
{
  print("-- " + title);
  for (const Problem &problem : problems.all()) {
    std::string text = problem.text();
    for (std::size_t at; (at = text.find(folder + "/")) != std::string::npos;)
      text.erase(at, folder.size() + 1);
    print(text);
  }
}

void study(const std::string &title, const std::string &text)
{
  Problems problems;
  StudyParameters::read(text, "study.prm", {}, false, problems);
  print_problems(title, problems);
}

void effect(const std::string &title, const std::string &text)
{
  Problems problems;
  read_effect(text, "effects/humidity.prm", problems);
  print_problems(title, problems);
}

std::vector<Experiment> experiments()
{
  Problems problems;
  ExperimentParameters first, second;
  first.name = "box";
  first.case_file = second.case_file = folder + "/drop.prm";
  second.name = "other_box";
  second.held_out = true;
  return {Experiment(first, MPI_COMM_WORLD, problems),
          Experiment(second, MPI_COMM_WORLD, problems)};
}

void measured(const std::string &title, const std::string &text)
{
  Problems problems;
  read_measured(text, "measured.csv", experiments(), problems);
  print_problems(title, problems);
}

void studies()
{
  study("no experiment", "subsection discovery\nend\n");
  study("a near name", "subsection discovery\n set lavel = 0.1\nend\n");
  study("experiments that are not counted",
        "subsection discovery\n subsection experiment 0\n  set name = a\n end\nend\n");
  study("a twin in a study", "subsection twin\n set effects = tilt: 1\nend\n");
  study("names and numbers",
        "subsection discovery\n set number of experiments = 2\n set number of nuisances = 1\n"
        " subsection experiment 0\n  set name = a b\n  set case file = x.prm\n end\n"
        " subsection experiment 1\n  set name = a\n  set held out = true\n end\n"
        " subsection nuisance 0\n  set name = n\n end\nend\n");
  study("all is held out",
        "subsection discovery\n set number of experiments = 1\n subsection experiment 0\n"
        "  set name = a\n  set case file = x.prm\n  set held out = true\n end\nend\n");
}

void effects()
{
  effect("empty", "");
  effect(
      "range, scale and null value",
      "subsection effect\n set mechanism = m\n set source = s\n set range = 0, 1\n"
      " set null value = -1\n set scale = 3\n set sing = both\nend\nset process = ${amplitude}\n");
  effect("range, scale and null value",
         "subsection effect\n set mechanism = m\n set source = s\n set range = 0, 1\n"
         " set null value = -1\n set scale = 3\nend\nset process = ${amplitude}\n");
  Problems problems;
  const std::vector<Effect> all = read_effects({folder + "/effects"}, MPI_COMM_WORLD, problems);
  check("three effects", all.size() == 3 && problems.empty());
  select(all, {"all"}, {"bonce"}, "study.prm", problems);
  select(all, {"humidity"}, {}, "study.prm", problems);
  print_problems("selection", problems);
  check("all but one", select(all, {"all"}, {"tilt"}, "study.prm", problems).size() == 2);
  try {
    read_effects({folder + "/no_such_folder"}, MPI_COMM_WORLD, problems);
  } catch (const UserError &error) {
    print(std::string(error.what()).substr(folder.size() + 1));
  }
  Problems none;
  StudyInput study;
  study.experiments = experiments();
  study.factors = {read_effect(
      "subsection effect\n set mechanism = m\n set source = s\n set range = -0.55, 0.2\n"
      " set scale = 0.5\n set sign = both\nend\nsubsection lagrangian physical properties\n"
      " subsection particle type 0\n"
      "  set restitution coefficient particles = ${base + amplitude}\n end\nend\n",
      "effects/dull.prm", none)};
  check_patches(study, none);
  check("a scale that fits on one side only is tried there", none.empty());
}

void doubts()
{
  Problems problems;
  ExperimentParameters box;
  box.name = "box";
  box.case_file = folder + "/drop.prm";
  box.overrides = {"drop/seed = 3", "simulation control/seed = 5"};
  const Experiment experiment(box, MPI_COMM_WORLD, problems);
  check("a doubt about a case is told once",
        problems.empty() && problems.warnings().empty() && experiment.doubts().size() == 1);
}

/// The key of a case of the box.
std::string key_with(const std::vector<std::string> &overrides,
                     const RunRequest &request = {"box", {}, 1})
{
  Problems problems;
  ExperimentParameters box;
  box.name = "box";
  box.case_file = folder + "/drop.prm";
  box.overrides = overrides;
  const Experiment experiment(box, MPI_COMM_WORLD, problems);
  const std::vector<Effect> effects = read_effects({folder + "/effects"}, MPI_COMM_WORLD, problems);
  const StudyCase one = experiment.make_case(effects, request, MPI_COMM_WORLD);
  return problems.empty() && one.problem.empty() ? one.key : "";
}

void keys()
{
  const std::string base = key_with({}), file = "readers_named.txt";
  check("defaults that are written do not make another case",
        !base.empty() && key_with({"drop/number = 48"}) == base &&
            key_with({"drop/number = 12", "drop/number = 48"}) == base &&
            key_with({}, {"box", {{"tilt", 0.}}, 1}) == base);
  std::set<std::string> different = {
      base, key_with({"drop/number = 12"}), key_with({}, {"box", {}, 2}),
      key_with({}, {"box", {{"tilt", 1.}}, 1}), key_with({}, {"box", {{"tilt", -1.}}, 1})};
  for (const std::string text : {"first", "second"}) {
    std::ofstream(file) << text;
    different.insert(key_with({"mesh/file name = " + file}));
  }
  check("other values, seeds, effects and contents of files do",
        different.size() == 7 && different.count("") == 0, std::to_string(different.size()));
}

void measurements()
{
  const std::string row = "box,height,0,1e-3,1e-4,3,fit\n";
  measured("in order", heading + row);
  measured("with a byte-order mark", "\xEF\xBB\xBF" + heading + row);
  measured("empty", "");
  measured("only a heading", heading);
  measured("another heading", "experiment,observable\n" + row);
  measured("names", heading + row + "bxo,height,1,1,1,3,fit\nbox,heigth,1,1,1,3,fit\n");
  measured("numbers", heading + row +
                          "box,height,1,nan,1,3,fit\nbox,height,2,1,0,3,fit\n"
                          "box,height,3,1,-1,0,fit\nbox,drift,-1,1e999,1,3,fit\nbox,speed,0,1\n");
  measured("another encoding", "# place: Universit\xe4t\n" + heading + row);
  measured("twice", heading + row + row);
  measured("uses", heading + row +
                       "box,height,1,1,1,3,held-out\nother_box,height,1,1,1,3,fit\n"
                       "other_box,height,2,1,1,3,test\n");
  measured("units", "# unit of height: mm\n# unit of drift: m\n" + heading + row);

  Problems problems;
  MeasuredData data;
  data.header["place"] = "a laboratory: room 2";
  data.fit = {{{"box", "height", 0}, 1. / 3., 1e-300, 3}};
  data.held_out = {{{"other_box", "drift", 0}, -1e22 / 3., 0.1, 1}};
  const MeasuredData again =
      read_measured(write_measured(data), "measured.csv", experiments(), problems);
  check("written and read",
        problems.empty() && again.header == data.header && again.fit.size() == 1 &&
            again.held_out.size() == 1 && again.fit[0].value == data.fit[0].value &&
            again.fit[0].standard_deviation == data.fit[0].standard_deviation &&
            again.fit[0].repeats == 3 && again.held_out[0].point == data.held_out[0].point &&
            again.held_out[0].value == data.held_out[0].value);
  check_data_points(data,
                    {{"box", {{"box", "height", 1}, {"box", "height", 2}}}, {"other_box", {}}},
                    "measured.csv", problems);
  print_problems("cells that the model does not give", problems);
}

} // namespace

EUNOE_MPI_TEST()
{
  studies();
  effects();
  doubts();
  keys();
  measurements();
}
