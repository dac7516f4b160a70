// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>

namespace aquafarm::python {

/// Rejects a call of an object while a call of another thread runs. Acquired and released under the
/// GIL, which the call itself may release during its work.
class Turn {
 public:
  /// @param busy of the object @param name of its class, for the message
  /// @throws std::runtime_error while a call of another thread runs
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
