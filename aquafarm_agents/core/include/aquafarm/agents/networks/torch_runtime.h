// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The network library as it runs here: its threads, and the libraries beneath it.

#include <cstdint>
#include <string>

namespace aquafarm::agents {

/// Sets the library's threads. A slow BLAS is noted for TakeTorchWarning.
void PrepareTorch(std::int32_t threads);

/// What there is to warn of about the network library, told once, after a learner or a policy was
/// made; one line for people, empty: nothing.
std::string TakeTorchWarning();

/// The libraries that networks learn with here, such as "libtorch 1.13.1, OpenBLAS 0.3.21 …
/// SkylakeX": where they or the kernels differ, the last bits of a training do. Empty: no network
/// was made.
std::string NetworkLibraries();

}  // namespace aquafarm::agents
