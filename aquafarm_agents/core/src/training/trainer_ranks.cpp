// SPDX-License-Identifier: BSD-3-Clause
// The parts of a training in which the ranks of a process group check, count and save together.
#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>
#include <utility>

#include "aquafarm/agents/environment/local_environment.h"
#include "aquafarm/agents/training/algorithms.h"
#include "aquafarm/agents/training/run.h"
#include "aquafarm/agents/training/trainer.h"
#include "aquafarm/base/cbor.h"
#include "aquafarm/base/check.h"
#include "training/pending_steps.h"

namespace aquafarm::agents {
namespace {

constexpr const char* kEnvironment = "environment";  // section of all farms

/// Totals and decisions of rank 0, which the other ranks adopt.
struct Decision {
  std::uint64_t steps{};
  std::uint64_t episodes{};
  std::uint8_t stops{};
  std::uint8_t saves{};
};

std::string ToBytes(const Decision& decision) {
  return {reinterpret_cast<const char*>(&decision), sizeof(decision)};
}

}  // namespace

bool CanUseRanks(const std::string& algorithm) {
  return algorithm != kAutoAlgorithm && FindAlgorithm(algorithm).make_rank != nullptr;
}

void CheckRanks(const std::string& algorithm, int ranks, const std::string& source) {
  if (CanUseRanks(algorithm)) return;
  std::string able;
  for (const Algorithm& one : Algorithms()) {
    if (one.make_rank != nullptr) able += (able.empty() ? "" : ", ") + std::string(one.name);
  }
  throw InputError(source + ": got " + std::to_string(ranks) + " with algorithm " + algorithm +
                   ", which learns in one process; expected 1, or algorithm " + able);
}

EnvironmentSpec WholeSpec(const EnvironmentSpec& spec, const ProcessGroup* group) {
  EnvironmentSpec whole = spec;
  if (group != nullptr) whole.farms *= group->size();
  return whole;
}

// Counts the pending steps of all ranks in the order in which one process would count them: by
// call, then by farm.
void Trainer::CountPending(const std::vector<PendingSteps>& parts) {
  for (std::size_t call = 0; call < parts.front().calls(); ++call) {
    for (const PendingSteps& part : parts) progress_.steps += part.steps(call);
    for (const PendingSteps& part : parts) {
      part.VisitFinished(call, [&](const EpisodeSummary& episode) { CountEpisode(episode); });
    }
  }
}

// Counts the pending steps and saves if it is time. Returns whether the training stops here. Rank 0
// decides both, so that all ranks stop and save at the same step.
bool Trainer::Synchronize(const std::atomic<bool>* stop) {
  Decision decision;
  decision.stops = stop != nullptr && *stop ? 1 : 0;
  std::vector<PendingSteps> parts;
  if (options_.group == nullptr) {
    parts.push_back(*pending_);
  } else {
    std::string own(1, static_cast<char>(decision.stops));
    for (const std::string& bytes : options_.group->Gather(own + pending_->ToBytes())) {
      if (!bytes.empty() && bytes.front() != 0) decision.stops = 1;
      parts.push_back(PendingSteps::FromBytes(bytes.substr(1)));
    }
  }
  pending_->Clear();
  if (!parts.empty()) CountPending(parts);
  CountRestarts();
  decision.saves = IsDue(saved_, options_.checkpoint_period_s) ? 1 : 0;
  decision.steps = progress_.steps;
  decision.episodes = progress_.episodes;
  if (options_.group != nullptr) {
    const std::string bytes = options_.group->Broadcast(ToBytes(decision));
    std::memcpy(&decision, bytes.data(), std::min(bytes.size(), sizeof(decision)));
    progress_.steps = decision.steps;
    progress_.episodes = decision.episodes;
  }
  if (decision.saves != 0) Save(true);
  return decision.stops != 0;
}

// On rank 0, adds the sections of the other ranks to the checkpoint and returns true. Returns false
// on the other ranks, which write nothing.
bool Trainer::CollectSections(Checkpoint& checkpoint) const {
  if (options_.group == nullptr) return true;
  nlohmann::json own = nlohmann::json::object();
  for (auto& [name, bytes] : checkpoint.sections) {
    own[name] = nlohmann::json::binary({bytes.begin(), bytes.end()});
  }
  std::string sent;
  nlohmann::json::to_cbor(own, sent);
  const std::vector<std::string> parts = options_.group->Gather(sent);
  if (parts.empty()) return false;
  std::vector<std::string> farms;
  for (const std::string& part : parts) {
    const nlohmann::json sections = ParseCbor(part, "rank");
    for (const auto& [name, value] : sections.items()) {
      const auto& binary = value.get_binary();
      std::string bytes(binary.begin(), binary.end());
      if (name == kEnvironment) {
        farms.push_back(std::move(bytes));
      } else {
        checkpoint.sections.emplace(name, std::move(bytes));  // keeps those of rank 0
      }
    }
  }
  if (!farms.empty()) checkpoint.sections[kEnvironment] = JoinSavedFarms(farms);
  return true;
}

}  // namespace aquafarm::agents
