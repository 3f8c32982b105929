// Registries of plug-ins: a name registered twice and a family that does not exist end the program
// with one sentence and an exit code; everything registered is found by its name.

#include <eunoe/contact/contact_model.h>

#include "../tests.h"

#include <sys/wait.h>
#include <unistd.h>

using namespace test;

namespace {

using Spices = Registry<std::string>;

/// Exit code of a process, and its error output.
struct End
{
  int code;
  std::string said;
};

/// How a process that does only this work ends.
End end_of(const std::function<void()> &work)
{
  int pipe_ends[2];
  if (pipe(pipe_ends) != 0)
    return {-1, "no pipe"};
  const pid_t child = fork();
  if (child == 0) {
    dup2(pipe_ends[1], STDERR_FILENO);
    work();
    _exit(0);
  }
  close(pipe_ends[1]);
  End end = {0, ""};
  char part[256];
  for (ssize_t n; (n = read(pipe_ends[0], part, sizeof part)) > 0;)
    end.said.append(part, static_cast<std::size_t>(n));
  close(pipe_ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  end.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return end;
}

void check_end(const std::string &name, const End &end, const std::string &sentence)
{
  check(name, end.code == 1 && end.said == sentence + "\n",
        "ends with " + std::to_string(end.code) + " and '" + end.said + "'");
}

} // namespace

EUNOE_TEST()
{
  const auto hot = [] { return std::string("hot"); };
  const auto white = [] { return std::string("white"); };
  Spices spices("spice");
  const Spices::Registration salt(spices, "salt", white), pepper(spices, "pepper", hot);
  check("names", spices.names() == "pepper|salt" && spices.has("salt") && !spices.has("sugar"));
  check("one by its name", spices.make("pepper") == "hot");
  check("all", spices.make_all() ==
                   std::map<std::string, std::string>({{"pepper", "hot"}, {"salt", "white"}}));
  try {
    spices.make("sugar");
    check("an unknown name", false);
  } catch (const std::invalid_argument &error) {
    check("an unknown name", error.what() == std::string("there is no 'sugar' among pepper|salt"),
          error.what());
  }

  const End once = end_of([&] { const Spices::Registration sugar(spices, "sugar", white); });
  check("a new name", once.code == 0 && once.said.empty(), once.said);
  check_end("a name given twice",
            end_of([&] { const Spices::Registration again(spices, "salt", hot); }),
            "The spice 'salt' is registered twice. Give one of the two another name.");
  check_end("a law registered twice", end_of([] {
              const ContactLawRegistry::Registration again(contact_laws("normal"), "hertz", {});
            }),
            "The normal contact law 'hertz' is registered twice. Give one of the two another "
            "name.");
  check_end("a mistyped family of laws", end_of([] { contact_laws("tangental"); }),
            "There is no contact law of the family 'tangental'. The families are 'cohesion', "
            "'further', 'normal', 'rolling', 'tangential'.");
}
