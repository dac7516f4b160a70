// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>

namespace aquafarm {

/// Calls body(i, thread) for each i in [0, count) on `threads` threads. `thread` is the number of
/// the calling thread in [0, threads). If the process has used several threads here and then forks,
/// its child processes use one thread. With one thread, an exception of `body` ends the loop. With
/// several threads, all calls are made, and one of the exceptions is rethrown afterwards. Pass
/// std::cref(body) to avoid a copy.
void ForEachFarm(std::int32_t count, std::int32_t threads,
                 const std::function<void(std::int32_t i, std::int32_t thread)>& body);

}  // namespace aquafarm
