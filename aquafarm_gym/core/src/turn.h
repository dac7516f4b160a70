// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>

namespace aquafarm::python {

/// Marks an object as busy during a call, so that calls from other threads are rejected. The
/// calling thread must hold the GIL (Python's global interpreter lock) in the constructor and the
/// destructor. In between, it may release the GIL.
class Turn {
 public:
  /// @param busy flag of the object
  /// @param name class of the object, for the message
  /// @throws std::runtime_error if a call from another thread is still running
  explicit Turn(bool& busy, const std::string& name = "FarmBatch") : busy_(busy) {
    if (busy_) {
      throw std::runtime_error(name + ": another thread's call is still running; use one " +
                               (name == "FarmBatch" ? "batch" : name) + " per thread");
    }
    busy_ = true;
  }
  ~Turn() { busy_ = false; }
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;

 private:
  bool& busy_;
};

}  // namespace aquafarm::python
