// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/training/register_learner.h"

#include <dlfcn.h>

#include <set>
#include <sstream>
#include <utility>

#include "aquafarm/base/check.h"

namespace aquafarm::agents {
namespace {

struct Registration {
  Algorithm algorithm;
  std::string built_with;
};

// Returns all registrations. The vector is a function-local static, because the first registration
// may run before the other static objects of this library are initialized.
std::vector<Registration>& Registrations() {
  static std::vector<Registration> registrations;
  return registrations;
}

void LoadLibrary(const std::string& path) {
  static std::set<void*> loaded;  // a library has the same handle for each of its paths
  const std::size_t count = Registrations().size();
  // The library is never closed, because its code is used until the program ends.
  void* const library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    const char* const reason = dlerror();
    throw InputError(std::string(kLearnersVariable) + ": " + path + ": cannot be loaded (" +
                     (reason == nullptr ? "no reason given" : reason) +
                     "), expected a shared library that registers a learner");
  }
  if (loaded.count(library) != 0) return;
  if (Registrations().size() == count) {
    throw InputError(std::string(kLearnersVariable) + ": " + path +
                     ": registers no learner, expected a call of RegisterLearner while it loads");
  }
  loaded.insert(library);
}

}  // namespace

bool RegisterLearner(const Algorithm& algorithm, const char* built_with) {
  Registrations().push_back({algorithm, built_with});
  return true;
}

std::vector<Algorithm> LoadLearners(const std::string& libraries) {
  std::istringstream paths(libraries);
  for (std::string path; std::getline(paths, path, ':');) {
    if (!path.empty()) LoadLibrary(path);
  }
  std::vector<Algorithm> algorithms;
  for (const Registration& one : Registrations()) {
    if (one.built_with != kVersion) {
      throw InputError(std::string("learner ") + one.algorithm.name + ": built with aquafarm " +
                       one.built_with + ", expected " + kVersion + ": compile it again");
    }
    algorithms.push_back(one.algorithm);
  }
  return algorithms;
}

}  // namespace aquafarm::agents
