// The command `microlane`.
#include <cstdio>

#include "command.h"

int main(int argc, char** argv) {  // NOLINT(bugprone-exception-escape): only memory can run out
  CLI::App app(
      "Microfacet BSDF kernels for packets: what there is, what it computes, its error and its speed.",
      "microlane");
  app.require_subcommand(1);
  int exit_code = 0;
  microlane::AddList(app);
  microlane::AddEval(app);
  microlane::AddAccuracy(app, exit_code);
  microlane::AddBench(app);
  microlane::AddQuadrature(app);
  microlane::AddCavities(app, exit_code);
  microlane::AddTables(app);
  microlane::AddReport(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help) {
    return app.exit(help);
  } catch (const CLI::RequiredError& error) {
    if (!app.get_subcommands().empty()) microlane::Fail(error.what());
    microlane::FailWithoutCommand(app, argc > 1 ? argv[1] : "");
  } catch (const CLI::ParseError& error) {
    microlane::Fail(error.what());
  } catch (const std::exception& error) {
    microlane::Fail(error.what());
  }
  if (std::fflush(stdout) != 0) microlane::Fail("cannot write to standard output");
  return exit_code;
}
