// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Settings of libtorch at run time: its threads, and the libraries that it uses.

#include <cstdint>
#include <string>

namespace aquafarm::agents {

/// Sets the number of threads of libtorch and of OpenBLAS. Must be called before a network is made.
/// The first call stores a warning for TakeTorchWarning if the BLAS is the slow reference BLAS.
void PrepareTorch(std::int32_t threads);

/// Returns the warning of PrepareTorch as one readable line, and clears it. Returns an empty text
/// if there is no warning.
std::string TakeTorchWarning();

/// Returns the libraries used by the networks, such as "libtorch 1.13.1, OpenBLAS 0.3.21 …
/// SkylakeX, products by avx512". With other versions or kernels, the results of a training may
/// differ in the last bits. Empty before PrepareTorch is called.
std::string NetworkLibraries();

}  // namespace aquafarm::agents
