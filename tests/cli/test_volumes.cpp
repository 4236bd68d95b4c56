/// The shell as an OpenVDB file. Left out where evenmesh is built without OpenVDB.

#include "cli/program.h"

namespace evenmesh::test {
namespace {

using Volumes = ProgramTest;
using Words = std::vector<std::string>;

TEST_F(Volumes, WritesTheShellAndItsCut) {
  const Outcome outcome = run({"mesh", "gallery:sphere", "-n", "100", "--method", "shell", "-o", "s.ply",
                               "--dump-shell", "s.vdb", "--report", "s.html", "--connect", "flood", "-q"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(names(), (Words{"s.html", "s.ply", "s.vdb"}));
  EXPECT_GT(read("s.vdb").size(), 10'000u);
  EXPECT_NE(read("s.html").find("cut through the shell"), std::string::npos);
}

TEST_F(Volumes, RaysHaveNone) {
  const Outcome outcome = run({"mesh", "gallery:sphere", "-n", "100", "-o", "x.ply", "--dump-shell", "x.vdb"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.err.find("add --method shell"), std::string::npos) << outcome.err;
  EXPECT_EQ(names(), Words{});
}

}  // namespace
}  // namespace evenmesh::test
