// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Runtime settings of the network library: its threads and the libraries that it links.

#include <cstdint>
#include <string>

namespace aquafarm::agents {

/// Sets the number of threads of the library. A slow BLAS is reported by TakeTorchWarning.
void PrepareTorch(std::int32_t threads);

/// Warning about the network library, returned once after a learner or a policy was made. One
/// readable line; empty if there is no warning.
std::string TakeTorchWarning();

/// Libraries used by the networks, such as "libtorch 1.13.1, OpenBLAS 0.3.21 … SkylakeX". Other
/// versions or kernels change the last bits of a training. Empty if no network was made.
std::string NetworkLibraries();

}  // namespace aquafarm::agents
