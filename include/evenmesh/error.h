#pragma once
/// Typed errors. Every message is one sentence that says what is wrong and what to do.

#include <stdexcept>
#include <string>

namespace evenmesh {

/// Base of everything the library throws on purpose.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The caller's mistake: an option out of range, an expression that does not parse, a count that cannot be met.
class InvalidInput : public Error {
 public:
  using Error::Error;
};

/// A file or stream that cannot be read or written, or a shape that holds no surface.
class UnusableInput : public Error {
 public:
  using Error::Error;
};

/// A documented feature that this version does not contain.
class NotAvailable : public Error {
 public:
  using Error::Error;
};

/// The caller asked to stop (see ExecutionContext::cancel).
class Cancelled : public Error {
 public:
  Cancelled() : Error("cancelled") {}
};

}  // namespace evenmesh
