// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace aquafarm_sim {

/// The last completed request of a kind and its answer. A client that did not receive the answer
/// can repeat the request. It then receives the stored answer, and the request is not executed
/// again.
/// @tparam Key has operator== and IsIdentified(), which returns false if a retry cannot be
///         recognized
template <typename Key, typename Answer>
class RequestLog {
 public:
  /// Returns the answer if `key` repeats the last completed request; null otherwise.
  const Answer* Find(const Key& key) const {
    return is_complete_ && key.IsIdentified() && key_ == key ? &answer_ : nullptr;
  }
  /// Forgets the last request and returns the object that the caller must fill with the next
  /// answer. Find ignores this answer until Complete is called.
  Answer& Begin() {
    is_complete_ = false;
    return answer_;
  }
  /// Marks the stored answer as the answer to `key`.
  void Complete(const Key& key) {
    key_ = key;
    is_complete_ = true;
  }
  void Forget() { is_complete_ = false; }

 private:
  bool is_complete_{};  // `key_` and `answer_` belong to a completed request
  Key key_{};
  Answer answer_{};
};

}  // namespace aquafarm_sim
