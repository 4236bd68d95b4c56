/// Commands that the documentation plans and this version does not contain.

#include <array>
#include <string>

#include "command.h"
#include "values.h"

namespace evenmesh::cli {

void add_unavailable_commands(CLI::App& app, Action& action) {
  struct Planned {
    const char *name, *what;
  };
  constexpr std::array planned{
      Planned{"track", "meshes of a moving surface"},
      Planned{"advect", "a surface in a velocity field"},
      Planned{"mill", "a solid cut along a tool path"},
  };
  for (const Planned& entry : planned) {
    CLI::App* command =
        app.add_subcommand(entry.name, std::string(entry.what) + "; not available in this version")->prefix_command();
    command->callback([name = std::string(entry.name), &action] {
      action = [name]() -> int { not_available("the command " + name); };
    });
  }
}

}  // namespace evenmesh::cli
