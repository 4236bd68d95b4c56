/// The program `evenmesh`: finds the command, turns errors into sentences and exit statuses.

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <string>
#include <string_view>

#include "command.h"
#include "evenmesh/glsl.h"
#include "interrupt.h"
#include "terminal.h"

namespace {

using namespace evenmesh;
using cli::say;
using cli::Status;

/// With -v also the renderer that would run shaders.
std::string version(bool verbose) {
  std::string text = "evenmesh " EVENMESH_VERSION;
  if (!verbose) return text;
  try {
    return text + "\nshaders: " + gl_renderer();
  } catch (const Error& error) {
    return text + "\nshaders: none (" + error.what() + ")";
  }
}

void describe(CLI::App& app, bool verbose) {
  app.name("evenmesh");
  app.get_formatter()->column_width(34);
  app.get_formatter()->label("SUBCOMMAND", "COMMAND");
  app.get_formatter()->label("Subcommands", "Commands");
  app.require_subcommand(0, 1);
  app.add_flag("-v,--verbose")->description("with --version: also what renders shaders");
  app.set_version_flag(
      "--version", [verbose] { return version(verbose); }, "print the version and exit");
  app.set_help_flag("-h,--help", "print this and exit");
  app.footer(
      "evenmesh COMMAND --help shows every option with default, unit and range.\n\n"
      "Exit status: 0 done, 1 internal error, 2 wrong usage, 3 input cannot be read or holds no surface,\n"
      "4 done but a promise could not be kept (said which), 130 cancelled (nothing written).\n");
}

/// Leaves the process, past a driver that does not come back.
int finish(int status) {
  if (!gl_stuck()) return status;
  std::fflush(nullptr);
  std::_Exit(status);
}

int parse_and_act(int argc, char** argv) {
  CLI::App app("evenmesh: any surface in, an even mesh out.");
  describe(app,
           std::any_of(argv, argv + argc, [](std::string_view word) { return word == "-v" || word == "--verbose"; }));
  cli::Action action;
  cli::add_mesh_command(app, action);
  cli::add_wrap_command(app, action);
  cli::add_repair_command(app, action);
  cli::add_boolean_command(app, action);
  cli::add_offset_command(app, action);
  cli::add_info_command(app, action);
  cli::add_compare_command(app, action);
  cli::add_gallery_command(app, action);
  cli::add_render_command(app, action);
  cli::add_unavailable_commands(app, action);
  const auto named = [&](const CLI::App* command) { return command->check_name(argc > 1 ? argv[1] : ""); };
  if (argc > 1 && argv[1][0] != '-' && app.get_subcommands(named).empty()) {
    throw InvalidInput(fmt::format("there is no command '{}'; evenmesh --help lists them", argv[1]));
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {  // --help, --version
    return app.exit(success);
  } catch (const CLI::ParseError& error) {
    throw InvalidInput(error.what());
  }
  if (!action) {
    fmt::print(stderr, "{}", app.help());
    return Status::wrong_usage;
  }
  return action();
}

int run(int argc, char** argv) {
  try {
    return parse_and_act(argc, argv);
  } catch (const Cancelled&) {
    fmt::print(stderr, "cancelled; nothing was written\n");
    return Status::cancelled;
  } catch (const cli::WriteFailed& error) {
    say("error", error.what());
    return Status::internal_error;
  } catch (const UnusableInput& error) {
    say("error", error.what());
    return Status::unusable_input;
  } catch (const Error& error) {  // InvalidInput, NotAvailable
    say("error", error.what());
    return Status::wrong_usage;
  } catch (const std::bad_alloc&) {
    say("error", "out of memory; ask for fewer vertices or a lower resolution");
    return Status::internal_error;
  } catch (const std::exception& error) {
    say("internal error", error.what());
    return Status::internal_error;
  }
}

}  // namespace

int main(int argc, char** argv) {
  cli::watch_for_interrupts();
  return finish(run(argc, argv));
}
