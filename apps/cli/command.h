#pragma once
/// What the commands of the program share: how one registers itself, exit statuses, errors of its own.

#include <CLI/CLI.hpp>
#include <functional>

#include "evenmesh/error.h"

namespace evenmesh::cli {

/// Exit statuses of the program (docs/cli.md).
enum Status : int {
  done = 0,
  internal_error = 1,
  wrong_usage = 2,
  unusable_input = 3,
  promise_broken = 4,
  cancelled = 130,
};

/// The result could not be written although its place looked fine before: disk full, device gone.
class WriteFailed : public Error {
 public:
  using Error::Error;
};

/// What the command line asks for; returns the exit status.
using Action = std::function<int()>;

/// Each adds its subcommand to `app`, which sets `action` when it is the one chosen.
void add_mesh_command(CLI::App& app, Action& action);
void add_wrap_command(CLI::App& app, Action& action);
void add_repair_command(CLI::App& app, Action& action);
void add_boolean_command(CLI::App& app, Action& action);
void add_offset_command(CLI::App& app, Action& action);
void add_info_command(CLI::App& app, Action& action);
void add_compare_command(CLI::App& app, Action& action);
void add_gallery_command(CLI::App& app, Action& action);
void add_render_command(CLI::App& app, Action& action);
/// Commands that are documented but not part of this version.
void add_unavailable_commands(CLI::App& app, Action& action);

}  // namespace evenmesh::cli
