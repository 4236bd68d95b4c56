#include "evenmesh/execution_context.h"

namespace evenmesh {

Run& Run::silent() {
  // One per thread, so that nobody's cancel reaches somebody else.
  thread_local Run run;
  return run;
}

}  // namespace evenmesh
