#pragma once
/// Formulas by chance, the same in every run.

#include <cstdint>
#include <string>
#include <vector>

#include "core/random.h"
#include "evenmesh/mesh.h"

namespace evenmesh::testing {

inline const Box wide_cube{{-2, -2, -2}, {2, 2, 2}};

/// A random formula of bounded size whose value is a number nearly everywhere.
inline std::string random_formula(Random& random, int depth) {
  static const std::vector<std::string> leaves{"x", "y", "z", "r", "0.5", "2", "1.25"};
  if (depth == 0) return leaves[random.below(leaves.size())];
  const auto part = [&] { return random_formula(random, depth - 1); };
  switch (random.below(20)) {
    case 0:
      return "(" + part() + "+" + part() + ")";
    case 1:
      return "(" + part() + "-" + part() + ")";
    case 2:
      return "(" + part() + "*" + part() + ")";
    case 3:
      return "(" + part() + "/(1+(" + part() + ")^2))";
    case 4:
      return "sin(" + part() + ")";
    case 5:
      return "cos(" + part() + ")";
    case 6:
      return "min(" + part() + "," + part() + ")";
    case 7:
      return "max(" + part() + "," + part() + ")";
    case 8:
      return "abs(" + part() + ")";
    case 9:
      return "sqrt(abs(" + part() + ")+0.1)";
    case 10:
      return "exp(sin(" + part() + "))";
    case 11:
      return "log(1+abs(" + part() + "))";
    case 12:
      return "atan(" + part() + ")";
    case 13:
      return "atan2(" + part() + ",1+abs(" + part() + "))";
    case 14:
      return "(sin(" + part() + "))^3";
    case 15:
      return "(1+abs(" + part() + "))^0.7";
    case 16:
      return "asin(0.9sin(" + part() + "))";
    case 17:
      return "acos(0.9cos(" + part() + "))";
    case 18:
      return "mod(" + part() + ",1.5)";
    default:
      return "(3*" + part() + "-0.25*" + part() + "+1)";
  }
}

inline std::vector<std::string> random_formulas(int count, std::uint64_t seed) {
  Random random(seed);
  std::vector<std::string> formulas;
  for (int i = 0; i < count; ++i) formulas.push_back(random_formula(random, 1 + i % 5));
  return formulas;
}

}  // namespace evenmesh::testing
