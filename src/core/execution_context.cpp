#include "evenmesh/execution_context.h"

namespace evenmesh {

ExecutionContext& ExecutionContext::silent() {
  // One per thread, so that nobody's cancel reaches somebody else.
  thread_local ExecutionContext context;
  return context;
}

}  // namespace evenmesh
