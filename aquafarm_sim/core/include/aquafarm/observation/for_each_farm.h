// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>

namespace aquafarm {

/// Calls body(i, thread) for each i in [0, count), on `threads` threads with numbers from 0. A
/// process forked from one that has used several threads uses one. An exception of `body` is thrown
/// again after all calls. Pass std::cref(body) to avoid a copy.
void ForEachFarm(std::int32_t count, std::int32_t threads,
                 const std::function<void(std::int32_t i, std::int32_t thread)>& body);

}  // namespace aquafarm
