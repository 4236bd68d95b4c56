// Random booleans: how many come out closed, two-manifold, oriented, without self-intersections.
//
//   bench_csg [COUNT [FIRST [fragments]]]      seeds FIRST, FIRST + 1, … (1); exit status 1 when one of them does not
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "../tests/pipeline/random_solids.h"
#include "evenmesh/mesh_shape.h"

using namespace evenmesh;

int main(int argc, char** argv) {
  const int count = argc > 1 ? std::atoi(argv[1]) : 200, first = argc > 2 ? std::atoi(argv[2]) : 1;
  MeshOptions options;
  if (argc > 3 && std::string(argv[3]) == "fragments")
    options.connect = Connect::fragments, options.topology = TopologyRule::simplify;
  const auto start = std::chrono::steady_clock::now();
  int sound = 0, empty = 0, more = 0, balls = 0;
  double rounds = 0, q_sum = 0, q_least = 1, slowest = 0;
  for (int seed = first; seed < first + count; ++seed) {
    const auto begin = std::chrono::steady_clock::now();
    try {
      RandomSolids random(static_cast<std::uint64_t>(seed));
      const Shape shape = random.tree();
      const std::size_t vertices = random.vertices();
      ExecutionContext context;
      options.vertices = vertices;
      const MeshResult result = mesh_shape(shape, options, context);
      const MeshQuality& q = result.report.quality;
      const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
      const bool good = q.closed() && q.two_manifold() && q.oriented() && result.report.self_intersections == 0 &&
                        q.degenerate_faces == 0;
      sound += good, q_sum += q.q_avg, q_least = std::min(q_least, q.q_min), slowest = std::max(slowest, seconds);
      more += static_cast<double>(q.vertices) > 1.005 * static_cast<double>(vertices);
      balls += result.report.regularization_rounds > 0,
          rounds += static_cast<double>(result.report.regularization_rounds);
      if (!good || seconds > 20)
        std::printf(
            "seed %d: %zu vertices of %zu, closed %d, two-manifold %d, oriented %d, %zu self-intersections, %.1f s\n",
            seed, q.vertices, vertices, q.closed(), q.two_manifold(), q.oriented(), result.report.self_intersections,
            seconds);
    } catch (const UnusableInput&) {
      ++empty;  // nothing was left
    } catch (const std::exception& error) {
      std::printf("seed %d: %s\n", seed, error.what());
    }
    std::fflush(stdout);
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const int meshed = count - empty;
  std::printf("%d scenes, %d of them empty; %d of %d closed, two-manifold, oriented, without self-intersections\n",
              count, empty, sound, meshed);
  std::printf(
      "Q mean %.3f, least %.3f; %d needed more vertices, %d balls (%.2f rounds each on average); %.1f s each, at most "
      "%.1f s\n",
      q_sum / std::max(1, meshed), q_least, more, balls, rounds / std::max(1, meshed), seconds / count, slowest);
  return sound == meshed ? 0 : 1;
}
