// SPDX-License-Identifier: BSD-3-Clause
// Replaces libFuzzer if the compiler is not clang: passes each sample of the folders to the target,
// followed by mutated copies of it. The mutations are the same in every run with the same seed. A
// crash, a hang or an unexpected exception is a bug.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "aquafarm/base/rng.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

namespace fs = std::filesystem;

void Feed(const std::string& bytes) {
  LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
}

std::size_t Below(aquafarm::RandomStream& rng, std::size_t end) {
  return rng.Below(static_cast<std::uint32_t>(end));
}

// Applies one mutation: overwrites, removes, duplicates or cuts off bytes, or replaces bytes by a
// token with a meaning for parsers.
void Mutate(aquafarm::RandomStream& rng, std::string& bytes) {
  static const std::vector<std::string> kMinded{
      "",   "-1", "1e999",        "nan",   "99999999999", "null", "[",    "{",  "\"",
      "\n", "\r", "\xef\xbb\xbf", "66666", ",",           "#",    "\xff", "0x1"};
  if (bytes.empty()) bytes = " ";
  const std::size_t at = Below(rng, bytes.size());
  const std::size_t length = 1 + Below(rng, std::min<std::size_t>(bytes.size() - at, 24));
  switch (Below(rng, 6)) {
    case 0:
      bytes[at] = static_cast<char>(rng.Below(256));
      break;
    case 1:
      bytes.erase(at, length);
      break;
    case 2:
      bytes.insert(at, bytes.substr(at, length));
      break;
    case 3:
      bytes.resize(at);
      break;
    case 4:
      bytes[at] = static_cast<char>('0' + Below(rng, 10));
      break;
    default:
      bytes.replace(at, std::min<std::size_t>(length, 4), kMinded[Below(rng, kMinded.size())]);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::string option = argc > 1 ? argv[1] : "";
  const bool seeded = option.rfind("--seed=", 0) == 0;
  const std::uint64_t seed = seeded ? std::strtoull(option.c_str() + 7, nullptr, 10) : 1;
  const std::vector<std::string> words(argv + (seeded ? 2 : 1), argv + argc);
  if (words.size() < 2) {
    std::fprintf(stderr, "usage: %s [--seed=N] CHANGES FOLDER…\n", argv[0]);
    return 2;
  }
  std::vector<std::string> samples;
  for (std::size_t folder = 1; folder < words.size(); ++folder) {
    for (const auto& entry : fs::directory_iterator(words[folder])) {
      if (!entry.is_regular_file()) continue;
      std::ifstream file(entry.path(), std::ios::binary);
      samples.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
    }
  }
  std::sort(samples.begin(), samples.end());
  // Number of mutated copies of each sample. CHANGES applies to a set of six samples: with more
  // samples, each gets fewer copies, so that the duration of a run does not depend on their number.
  const auto changes =
      std::atoi(words[0].c_str()) * 6 / static_cast<int>(std::max<std::size_t>(samples.size(), 1));
  aquafarm::RandomStream rng({seed, 0, aquafarm::RngStream::kExploration, 0});
  for (const std::string& sample : samples) {
    Feed(sample);
    for (int i = 0; i < changes; ++i) {
      std::string changed = sample;
      for (std::size_t k = 1 + Below(rng, 3); k > 0; --k) Mutate(rng, changed);
      Feed(changed);
    }
  }
  std::printf("%zu samples, %d changes each; inputs: %zu\n", samples.size(), changes,
              samples.size() * (1 + static_cast<std::size_t>(changes)));
  return 0;
}
