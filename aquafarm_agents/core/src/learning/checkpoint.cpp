// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/learning/checkpoint.h"

#include <array>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string_view>

#include "aquafarm/agents/base/options.h"
#include "aquafarm/base/cbor.h"
#include "aquafarm/base/check.h"
#include "aquafarm/base/hash.h"
#include "aquafarm/base/version.h"
#include "learning/parse_checkpoint.h"

namespace aquafarm::agents {
namespace {

constexpr char kMagic[8] = {'a', 'q', 'u', 'a', 'C', 'K', 'P', 'T'};

struct Header {
  char magic[8];
  std::uint32_t format;
  std::uint32_t zero;
  std::uint64_t index_bytes;
  std::uint64_t section_bytes;
  std::uint64_t checksum;
};
static_assert(sizeof(Header) == 40);

std::string Hex(std::uint64_t hash) {
  char text[17];
  std::snprintf(text, sizeof(text), "%016llx", static_cast<unsigned long long>(hash));
  return text;
}

// Returns all sections by name.
std::map<std::string, std::string_view> SectionsOf(const Checkpoint& checkpoint) {
  std::map<std::string, std::string_view> all = checkpoint.lent;
  for (const auto& [name, bytes] : checkpoint.sections) all[name] = bytes;
  return all;
}

nlohmann::json ToIndex(const Checkpoint& c) {
  nlohmann::json sections = nlohmann::json::array();
  for (const auto& [name, bytes] : SectionsOf(c)) sections.push_back({name, bytes.size()});
  return {{"kind", c.kind},
          {"algorithm", c.algorithm},
          {"options", c.options},
          {"version", c.version},
          {"seed", c.seed},
          {"steps", c.steps},
          {"episodes", c.episodes},
          {"scenario_name", c.spec.scenario_name},
          {"scenario_hash", c.spec.scenario_hash},
          {"farms", c.spec.farms},
          {"agents", c.spec.agents},
          {"team_reward", c.spec.team_reward},
          {"state_count", c.spec.state_count},
          {"feature_count", c.spec.feature_count},
          {"feature_names", c.spec.feature_names},
          {"plane_count", c.spec.plane_count},
          {"height", c.spec.height},
          {"width", c.spec.width},
          {"step_limit", c.spec.step_limit},
          {"sections", sections}};
}

// Returns recorded options as this version would record them. Old names are replaced by the current
// ones. Options that are newer than the checkpoint are added, with the value that keeps the earlier
// behaviour.
std::string CompleteOptions(const std::string& algorithm, const std::string& recorded) {
  struct Added {
    std::string_view algorithm;  // part of the algorithm's name
    std::string_view key;
    std::string_view value;
  };
  constexpr std::array<Added, 10> kAdded{{{"lstm_dqn", "skip_connection=", "true"},
                                          {"ppo", "shards=", "1"},
                                          {"ppo", "teacher=", "0"},
                                          {"ppo", "teacher_policy=", "rule"},
                                          {"ppo", "teacher_interval=", "1"},
                                          {"ppo", "team_share=", "0"},
                                          {"ppo", "augment=", "false"},
                                          {"ppo", "max_visits=", "0"},
                                          {"ppo", "symmetric=", "false"},
                                          {"ppo", "repetition_penalty=", "0"}}};
  std::string complete = recorded;
  for (const Added& added : kAdded) {
    const bool lacks = algorithm.find(added.algorithm) != std::string::npos && !recorded.empty() &&
                       recorded.find(added.key) == std::string::npos;
    if (lacks) complete.append(" ").append(added.key).append(added.value);
  }
  return CanonicalOptions(complete);
}

Checkpoint FromIndex(const nlohmann::json& index) {
  Checkpoint c;
  index.at("kind").get_to(c.kind);
  index.at("algorithm").get_to(c.algorithm);
  c.options = CompleteOptions(c.algorithm, index.at("options").get<std::string>());
  index.at("version").get_to(c.version);
  index.at("seed").get_to(c.seed);
  index.at("steps").get_to(c.steps);
  index.at("episodes").get_to(c.episodes);
  index.at("scenario_name").get_to(c.spec.scenario_name);
  index.at("scenario_hash").get_to(c.spec.scenario_hash);
  index.at("farms").get_to(c.spec.farms);
  index.at("agents").get_to(c.spec.agents);
  index.at("team_reward").get_to(c.spec.team_reward);
  index.at("state_count").get_to(c.spec.state_count);
  index.at("feature_count").get_to(c.spec.feature_count);
  index.at("feature_names").get_to(c.spec.feature_names);
  index.at("plane_count").get_to(c.spec.plane_count);
  index.at("height").get_to(c.spec.height);
  index.at("width").get_to(c.spec.width);
  index.at("step_limit").get_to(c.spec.step_limit);
  c.spec.version = c.version;
  return c;
}

void ReadSections(const nlohmann::json& index, std::string_view bytes, Checkpoint& checkpoint) {
  for (const nlohmann::json& section : index.at("sections")) {
    const auto size = section.at(1).get<std::size_t>();
    if (size > bytes.size()) throw InputError("damaged: sections are longer than the file");
    checkpoint.sections[section.at(0).get<std::string>()] = bytes.substr(0, size);
    bytes.remove_prefix(size);
  }
}

Checkpoint Parse(std::string_view bytes) {
  Header header{};
  if (bytes.size() < sizeof(header)) {
    throw InputError("not a checkpoint, or truncated: got " + std::to_string(bytes.size()) +
                     " bytes, expected at least " + std::to_string(sizeof(header)));
  }
  std::memcpy(&header, bytes.data(), sizeof(header));
  if (std::memcmp(header.magic, kMagic, sizeof(kMagic)) != 0) {
    throw InputError("not a checkpoint: does not start with 'aquaCKPT'");
  }
  if (header.format != kCheckpointFormat) {
    throw InputError("got a checkpoint of format " + std::to_string(header.format) + ", expected " +
                     std::to_string(kCheckpointFormat));
  }
  bytes.remove_prefix(sizeof(header));
  const bool fits = header.index_bytes <= bytes.size() &&
                    header.section_bytes == bytes.size() - header.index_bytes;
  if (!fits) {
    throw InputError("truncated or too long: got " + std::to_string(bytes.size()) +
                     " bytes after the header, expected " +
                     std::to_string(header.index_bytes + header.section_bytes));
  }
  if (header.zero != 0) {
    throw InputError("damaged: byte 12 and the next ones are " + std::to_string(header.zero) +
                     ", expected 0");
  }
  if (HashBytes(bytes) != header.checksum) {
    throw InputError("damaged: the checksum is " + Hex(HashBytes(bytes)) + ", expected " +
                     Hex(header.checksum));
  }
  const auto index = ParseCbor(bytes.substr(0, header.index_bytes), "index");
  Checkpoint checkpoint = FromIndex(index);
  ReadSections(index, bytes.substr(header.index_bytes), checkpoint);
  return checkpoint;
}

}  // namespace

std::string_view Checkpoint::Section(const std::string& name) const {
  if (const auto found = sections.find(name); found != sections.end()) return found->second;
  if (const auto found = lent.find(name); found != lent.end()) return found->second;
  throw InputError("checkpoint: has no section '" + name + "' (it is of kind " + kind + ")");
}

void Checkpoint::SetNumbers(const std::string& name, const std::map<std::string, Number>& numbers) {
  nlohmann::json fields = nlohmann::json::object();
  for (const auto& [field, number] : numbers) {
    std::visit([&, &key = field](auto value) { fields[key] = value; }, number);
  }
  sections[name].clear();
  nlohmann::json::to_cbor(fields, sections[name]);
}

std::map<std::string, Checkpoint::Number> Checkpoint::GetNumbers(const std::string& name) const {
  const std::string_view section = Section(name);
  nlohmann::json fields;
  try {
    fields = ParseCbor(section);
  } catch (const InputError&) {  // `fields` stays null, which is not an object
  }
  std::map<std::string, Number> numbers;
  bool is_valid = fields.is_object();
  for (auto field = fields.begin(); is_valid && field != fields.end(); ++field) {
    is_valid = field->is_number();
    if (field->is_number_unsigned()) {
      numbers[field.key()] = field->get<std::uint64_t>();
    } else if (is_valid) {
      numbers[field.key()] = field->get<double>();
    }
  }
  if (!is_valid) {
    throw InputError("checkpoint: section '" + name +
                     "': is damaged, expected named numbers; use another checkpoint");
  }
  return numbers;
}

void Checkpoint::AddPart(const std::string& prefix, Checkpoint&& part) {
  for (auto& [name, bytes] : part.sections) sections[prefix + name] = std::move(bytes);
  for (const auto& [name, bytes] : part.lent) lent[prefix + name] = bytes;
}

Checkpoint Checkpoint::Part(const std::string& prefix) const {
  Checkpoint part;
  static_cast<CheckpointInfo&>(part) = *this;
  for (const auto& [name, bytes] : SectionsOf(*this)) {
    if (name.compare(0, prefix.size(), prefix) != 0) continue;
    part.sections[name.substr(prefix.size())] = bytes;
  }
  return part;
}

void Checkpoint::CheckSize(const std::string& name, std::size_t got, std::size_t expected) {
  if (got == expected) return;
  throw InputError("checkpoint: section '" + name + "': got " + std::to_string(got) +
                   " bytes, expected " + std::to_string(expected));
}

void WriteCheckpoint(const std::string& path, const Checkpoint& checkpoint) {
  std::string index;
  nlohmann::json::to_cbor(ToIndex(checkpoint), index);
  Header header{};
  std::memcpy(header.magic, kMagic, sizeof(kMagic));
  header.format = kCheckpointFormat;
  header.index_bytes = index.size();
  std::vector<std::string_view> parts{index};  // the sections are not copied: a table may be large
  for (const auto& [name, bytes] : SectionsOf(checkpoint)) {
    parts.emplace_back(bytes);
    header.section_bytes += bytes.size();
  }
  header.checksum = HashBytes(parts);
  parts.insert(parts.begin(), {reinterpret_cast<const char*>(&header), sizeof(header)});
  WriteFileAtomically(path, parts);
}

Checkpoint ReadCheckpoint(const std::string& path) { return ParseCheckpoint(ReadFile(path), path); }

Checkpoint ParseCheckpoint(const std::string& bytes, const std::string& path) {
  try {
    return Parse(bytes);
  } catch (const InputError& error) {
    throw InputError(path + ": " + error.what());
  } catch (const nlohmann::json::exception& error) {
    throw InputError(path + ": damaged: " + error.what());
  }
}

void CheckContinues(const Checkpoint& checkpoint, const std::string& path,
                    const std::string& algorithm, const std::string& options, std::uint64_t seed,
                    const EnvironmentSpec& spec) {
  const auto refuse = [&](const std::string& what, const std::string& got,
                          const std::string& expected) {
    throw InputError(path + ": cannot be resumed: " + what + ": the checkpoint has " + got +
                     ", this run has " + expected);
  };
  const auto compare = [&](const std::string& what, const auto& got, const auto& expected) {
    if (got != expected) refuse(what, std::to_string(got), std::to_string(expected));
  };
  if (checkpoint.kind != Checkpoint::kTraining) {
    refuse("kind", checkpoint.kind, Checkpoint::kTraining);
  }
  if (checkpoint.version != spec.version) refuse("version", checkpoint.version, spec.version);
  if (checkpoint.algorithm != algorithm) refuse("algorithm", checkpoint.algorithm, algorithm);
  if (checkpoint.spec.scenario_hash != spec.scenario_hash) {
    refuse("scenario",
           checkpoint.spec.scenario_name + " (hash " + Hex(checkpoint.spec.scenario_hash) + ")",
           spec.scenario_name + " (hash " + Hex(spec.scenario_hash) + ")");
  }
  if (checkpoint.options != options) refuse("options", checkpoint.options, options);
  compare("seed", checkpoint.seed, seed);
  compare("farms", checkpoint.spec.farms, spec.farms);
  compare("agents", checkpoint.spec.agents, spec.agents);
  const auto credit = [](bool team) { return team ? "shared" : "own"; };
  if (checkpoint.spec.team_reward != spec.team_reward) {
    refuse("credit", credit(checkpoint.spec.team_reward), credit(spec.team_reward));
  }
}

void CheckFit(const Checkpoint& policy, const EnvironmentSpec& spec, const std::string& what,
              const std::string& got, const std::string& expected) {
  if (got == expected) return;
  throw InputError(
      "policy: " + policy.algorithm + " of scenario " + policy.spec.scenario_name +
      " does not fit scenario " + spec.scenario_name + ": " + what + ": the policy has " + got +
      ", the farm has " + expected +
      (what == "agents" ? "; give policy:=planner, or policy:=none to hold the ships" : ""));
}

void CheckFit(const Checkpoint& policy, const EnvironmentSpec& spec, const std::string& what,
              std::int64_t got, std::int64_t expected) {
  CheckFit(policy, spec, what, std::to_string(got), std::to_string(expected));
}

}  // namespace aquafarm::agents
