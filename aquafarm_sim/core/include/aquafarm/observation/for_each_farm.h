// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>

namespace aquafarm {

/// Calls body(i, thread) for each i in [0, count) on `threads` threads. `thread` is the number of
/// the calling thread in [0, threads). If the process has used several threads here and then forks,
/// its children use one thread. With several threads, an exception of `body` is thrown again after
/// all calls; with one thread, it prevents the calls that remain. Pass std::cref(body) to avoid a
/// copy.
void ForEachFarm(std::int32_t count, std::int32_t threads,
                 const std::function<void(std::int32_t i, std::int32_t thread)>& body);

}  // namespace aquafarm
