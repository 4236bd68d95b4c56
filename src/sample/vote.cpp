#include "sample/tri_dexel.h"
namespace evenmesh {
void vote(TriDexel&, const std::array<DexelAxis, 3>&, const Run&) {}
}  // namespace evenmesh
