/// Who includes whom: the folders are the pipeline, and data goes one way (docs/architecture.md).

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;
using Names = std::set<std::string>;

const fs::path root = EVENMESH_SOURCE_DIR;

/// Modules in the order of the pipeline; each sees itself and those before it.
const std::vector<std::string> pipeline{"core",     "geometry", "grid",    "shape",    "sample", "band",
                                        "features", "cvt",      "connect", "topology", "refine", "pipeline"};

/// Modules beside the pipeline, and what they see besides themselves.
const std::map<std::string, Names> beside{
    {"measure", {"core", "geometry"}},
    {"io", {"core", "geometry", "shape"}},
    {"gl", {"core", "geometry", "grid", "shape", "sample"}},
    {"scene", {"core", "geometry", "shape", "io"}},
    {"jobs", {"core", "geometry", "shape"}},
    {"view", {"core", "geometry", "measure"}},
};

/// Public headers, and the module from which on they may be included.
const std::map<std::string, std::string> public_headers{
    {"error.h", "core"},
    {"execution_context.h", "core"},
    {"findings.h", "geometry"},
    {"mesh.h", "geometry"},
    {"units.h", "geometry"},
    {"density.h", "geometry"},
    {"shape.h", "shape"},
    {"measure.h", "measure"},
    {"io.h", "io"},
    {"mesh_shape.h", "pipeline"},
    {"render.h", "view"},
    {"points.h", "geometry"},
    {"volume.h", "geometry"},
    {"solid.h", "shape"},
    {"scene.h", "scene"},
    {"repair.h", "geometry"},
    {"dexels.h", "shape"},
    {"glsl.h", "gl"},
    {"raster.h", "gl"},
    {"input.h", "jobs"},
    {"names.h", "jobs"},
    {"options_json.h", "jobs"},
    {"repaired.h", "jobs"},
    {"written.h", "jobs"},
    {"set_operation.h", "jobs"},
};

Names visible_from(const std::string& module) {
  if (const auto found = beside.find(module); found != beside.end()) {
    Names names = found->second;
    names.insert(module);
    return names;
  }
  Names names;
  for (const std::string& lower : pipeline) {
    names.insert(lower);
    if (lower == module) break;
  }
  // The loop that runs the stages also measures what came out.
  if (module == "pipeline") names.insert("measure");
  return names;
}

bool may_include_public(const std::string& module, const std::string& header) {
  const auto found = public_headers.find(header);
  if (found == public_headers.end()) return false;
  // Reports are about the pipeline's result: they see its public header, not its module.
  if (module == "view" && header == "mesh_shape.h") return true;
  // What every face needs is made of public functions.
  const std::set<std::string> rooms_of_jobs{"measure", "io", "scene", "gl", "pipeline"};
  if (module == "jobs" && rooms_of_jobs.contains(found->second)) return true;
  // Scenes name shaders; what runs them stays behind the public header.
  if (module == "scene" && (header == "glsl.h" || header == "raster.h")) return true;
  return visible_from(module).contains(found->second);
}

std::vector<fs::path> sources_under(const fs::path& folder) {
  std::vector<fs::path> files;
  if (!fs::exists(folder)) return files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string extension = entry.path().extension();
    if (extension == ".h" || extension == ".cpp") files.push_back(entry.path());
  }
  return files;
}

std::vector<std::string> includes_of(const fs::path& file) {
  static const std::regex pattern(R"re(^\s*#\s*include\s*["<]([^">]+)[">].*)re");
  std::vector<std::string> names;
  std::ifstream in(file);
  std::smatch match;
  for (std::string line; std::getline(in, line);) {
    if (std::regex_match(line, match, pattern)) names.push_back(match[1]);
  }
  return names;
}

/// "module/file.h" → "module", and "" for anything that is not ours.
std::string module_of_include(const std::string& name) {
  const std::string first = name.substr(0, name.find('/'));
  return name.find('/') != std::string::npos && fs::is_directory(root / "src" / first) ? first : "";
}

TEST(Layering, ModulesSeeOnlyLowerOnes) {
  for (const fs::path& file : sources_under(root / "src")) {
    const std::string module = fs::relative(file, root / "src").begin()->string();
    const bool known = beside.contains(module) || std::count(pipeline.begin(), pipeline.end(), module) > 0;
    ASSERT_TRUE(known) << module << " is not a module of docs/architecture.md";
    for (const std::string& name : includes_of(file)) {
      if (name.starts_with("evenmesh/")) {
        EXPECT_TRUE(may_include_public(module, name.substr(9))) << file << " includes " << name;
      } else if (const std::string other = module_of_include(name); !other.empty()) {
        EXPECT_TRUE(visible_from(module).contains(other)) << file << " includes " << name;
      }
      EXPECT_EQ(name.find(".."), std::string::npos) << file << " includes " << name;
    }
  }
}

TEST(Layering, PublicHeadersIncludeOnlyPublicHeadersAndTheStandardLibrary) {
  for (const fs::path& file : sources_under(root / "include")) {
    const std::string self = file.filename();
    ASSERT_TRUE(public_headers.contains(self)) << self << " is not in the table of this test";
    const std::string module = public_headers.at(self);
    for (const std::string& name : includes_of(file)) {
      if (name.starts_with("evenmesh/")) {
        EXPECT_TRUE(may_include_public(module, name.substr(9))) << self << " includes " << name;
      } else {
        EXPECT_EQ(name.find_first_of("./"), std::string::npos) << self << " includes " << name;
      }
    }
  }
}

TEST(Layering, TheProgramAndTheExamplesSeeOnlyPublicHeaders) {
  for (const char* folder : {"apps", "examples"}) {
    for (const fs::path& file : sources_under(root / folder)) {
      for (const std::string& name : includes_of(file)) {
        EXPECT_EQ(module_of_include(name), "") << file << " includes " << name;
        EXPECT_EQ(name.find("src/"), std::string::npos) << file << " includes " << name;
        if (name.starts_with("evenmesh/")) {
          EXPECT_TRUE(public_headers.contains(name.substr(9))) << file << " includes " << name;
        }
      }
    }
  }
}

/// Classes by name, and the modules that define one of that name.
std::map<std::string, Names> classes_by_module() {
  static const std::regex pattern(R"(^(?:class|struct) (\w+)(?: final)?(?: :[^;]*)? \{.*)");
  std::map<std::string, Names> classes;
  std::smatch match;
  const auto add = [&](const fs::path& file, const std::string& module) {
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);)
      if (std::regex_match(line, match, pattern)) classes[match[1]].insert(module);
  };
  for (const fs::path& file : sources_under(root / "src"))
    add(file, fs::relative(file, root / "src").begin()->string());
  for (const fs::path& file : sources_under(root / "include")) add(file, public_headers.at(file.filename()));
  return classes;
}

TEST(Layering, NoModuleDeclaresWhatAHigherOneDefines) {
  static const std::regex pattern(R"(^\s*(?:class|struct) (\w+);.*)");
  const std::map<std::string, Names> classes = classes_by_module();
  std::smatch match;
  const auto check = [&](const fs::path& file, const Names& visible) {
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);) {
      if (!std::regex_match(line, match, pattern)) continue;
      const auto found = classes.find(match[1]);
      if (found == classes.end()) continue;  // defined within a class, or by another library
      const bool seen = std::any_of(found->second.begin(), found->second.end(),
                                    [&](const std::string& module) { return visible.contains(module); });
      EXPECT_TRUE(seen) << file << " declares " << match[1];
    }
  };
  for (const fs::path& file : sources_under(root / "src"))
    check(file, visible_from(fs::relative(file, root / "src").begin()->string()));
  for (const fs::path& file : sources_under(root / "include"))
    check(file, visible_from(public_headers.at(file.filename())));
}

TEST(Layering, EveryHeaderIsGuardedAndNoFileIsTooLong) {
  for (const char* folder : {"src", "include", "apps", "tests", "bench", "examples", "fuzz"}) {
    for (const fs::path& file : sources_under(root / folder)) {
      std::ifstream in(file);
      std::size_t lines = 0;
      std::string first;
      for (std::string line; std::getline(in, line); ++lines) {
        if (lines == 0) first = line;
      }
      EXPECT_LE(lines, 400u) << file;
      // Highway compiles "-inl.h" files once per instruction set; they guard themselves.
      const bool many_times = file.filename().string().ends_with("-inl.h");
      if (file.extension() == ".h" && !many_times) {
        EXPECT_EQ(first, "#pragma once") << file;
      }
    }
  }
}

}  // namespace
