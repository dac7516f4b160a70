// SPDX-License-Identifier: BSD-3-Clause
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "aquafarm/base/check.h"
#include "aquafarm_sim/bags/bag_check.h"

int main(int argc, char** argv) {
  std::vector<std::string> bags;
  std::string ns;
  CLI::App app(
      "Simulates recorded episodes again from seed and actions and compares every step.\n"
      "Exit code 0: identical; 1: a bag differs; 2: a bag cannot be checked.",
      "verify_bag");
  app.add_option("bags", bags, "bags with the topic spec and every message of the topic state")
      ->required();
  app.add_option("--ns", ns, "namespace of the ranch (default: the only one in the bag)");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  int code = 0;
  for (const std::string& bag : bags) {
    try {
      const aquafarm_sim::BagCheck check = aquafarm_sim::CheckBag(bag, ns);
      for (const std::string& episode : check.episodes_in_words) {
        std::printf("%s: %s\n", bag.c_str(), episode.c_str());
      }
      if (check.difference.empty()) {
        const std::string unfinished = check.unfinished == 0 ? ""
                                                             : ", episodes without their end: " +
                                                                   std::to_string(check.unfinished);
        std::printf("%s: identical: %llu episode%s, %llu steps%s%s\n", bag.c_str(),
                    static_cast<unsigned long long>(check.episodes), check.episodes == 1 ? "" : "s",
                    static_cast<unsigned long long>(check.steps), unfinished.c_str(),
                    aquafarm_sim::ChangesInWords(check).c_str());
      } else {
        std::printf("%s: differs: %s\n", bag.c_str(), check.difference.c_str());
        if (code == 0) code = 1;
      }
    } catch (const aquafarm::InputError& error) {
      std::fprintf(stderr, "verify_bag: %s\n", error.what());
      code = 2;
    } catch (const std::exception& error) {
      std::fprintf(stderr, "verify_bag: %s: %s\n", bag.c_str(), error.what());
      code = 2;
    }
  }
  return code;
}
