// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/networks/torch_runtime.h"

#include <ATen/Context.h>
#include <ATen/Parallel.h>
#include <dlfcn.h>
#include <torch/version.h>

#include <mutex>
#include <utility>

#include "networks/gemm.h"

namespace aquafarm::agents {
namespace {

std::string torch_warning;
std::string network_libraries;

// Returns whether the loaded BLAS is an optimized one, such as OpenBLAS or MKL. The reference BLAS
// has none of these symbols.
bool HasFastBlas() {
  for (const char* symbol :
       {"openblas_get_config", "mkl_get_version", "bli_info_get_version_str", "ATL_buildinfo"}) {
    if (dlsym(RTLD_DEFAULT, symbol) != nullptr) return true;
  }
  return at::globalContext().hasMKL();
}

}  // namespace

void PrepareTorch(std::int32_t threads) {
  at::set_num_threads(threads);
  // Debian's OpenBLAS has its own threads. For the small matrices of the networks, the
  // synchronization of these threads costs more time than they save.
  using SetThreads = void (*)(int);
  const auto set_threads =
      reinterpret_cast<SetThreads>(dlsym(RTLD_DEFAULT, "openblas_set_num_threads"));
  if (set_threads != nullptr) set_threads(threads);
  static std::once_flag looked;
  std::call_once(looked, [] {
    network_libraries = "libtorch " TORCH_VERSION;
    using Config = const char* (*)();
    const auto openblas = reinterpret_cast<Config>(dlsym(RTLD_DEFAULT, "openblas_get_config"));
    if (openblas != nullptr) network_libraries += std::string(", ") + openblas();
    network_libraries += std::string(", products by ") + ProductsBy();
    if (HasFastBlas()) return;
    network_libraries += ", reference BLAS";
    torch_warning =
        "libblas.so.3 is the reference BLAS, some ten times slower than OpenBLAS; install "
        "libopenblas0-pthread";
  });
}

std::string TakeTorchWarning() { return std::exchange(torch_warning, {}); }

std::string NetworkLibraries() { return network_libraries; }

}  // namespace aquafarm::agents
