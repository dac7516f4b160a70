// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/networks/deep_options.h"

#include <array>

#include "learning/common_options.h"

namespace aquafarm::agents {
namespace {

constexpr std::array<std::string_view, kNetworkKindCount> kNetworks{"mlp", "cnn"};
constexpr std::array<std::string_view, kLossKindCount> kLosses{"huber", "mse"};

DeepOptions Tuned(bool recurrent) {
  DeepOptions options;
  if (!recurrent) return options;
  options.hidden_size = 128;
  options.batch_size = 32;
  options.target_update_interval = 100;
  return options;
}

// The discount factor that §2.3 of the paper (docs/model.md) calls usual.
constexpr double kPaperDiscount = 0.99;
// τ of Algorithm 2, line 22. The paper gives only the range [0, 1]; this is the value of Haarnoja
// et al. 2018.
constexpr double kPaperTargetRate = 0.005;

// Returns the values printed in Eq. 15 and Algorithm 2 of the paper, with the extensions disabled.
// The other options keep the tuned defaults. The line numbers are those of Algorithm 2.
DeepOptions Paper(bool recurrent) {
  DeepOptions options = Tuned(recurrent);
  options.gamma = kPaperDiscount;
  if (recurrent) {
    options.tau = kPaperTargetRate;                           // line 22
    options.train_interval = {ScheduleKind::kConstant, 1.0};  // lines 12 to 23
    options.skip_connection = false;                          // line 4
  }
  options.loss = LossKind::kMse;
  options.max_grad_norm = 0.0;
  options.double_dqn = false;
  options.n_step = 1;
  options.priority_exponent = 0.0;
  options.reward_scale = 1.0;
  options.mask_illegal = false;
  return options;
}

// Values of the option replayed. Algorithm 2 as printed replays single tuples with their stored
// recurrent states.
enum class Replayed : std::uint8_t { kSequences, kPaperTuple };
constexpr std::array<std::string_view, 2> kReplayed{"sequences", "paper_tuple"};

void ReadSequences(OptionReader& reader, bool is_paper, DeepOptions& options) {
  const Replayed replayed = ReadWord(
      reader, "replayed", is_paper ? Replayed::kPaperTuple : Replayed::kSequences, kReplayed);
  const bool is_tuple = replayed == Replayed::kPaperTuple;
  options.paper_tuple = is_tuple;
  ReadFlag(reader, "skip_connection", options.skip_connection);
  if (is_tuple) {
    options.sequence_length = 1;
    options.burn_in = 0;
  }
  ReadWhole(reader, "sequence_length", 1, 1000, options.sequence_length);
  ReadWhole(reader, "burn_in", 0, 1000, options.burn_in);
  if (is_tuple && (options.sequence_length != 1 || options.burn_in != 0)) {
    throw InputError("replayed: got paper_tuple with sequence_length=" +
                     std::to_string(options.sequence_length) + " burn_in=" +
                     std::to_string(options.burn_in) + ", expected 1 and 0, or replayed=sequences");
  }
  // An n-step return cannot extend beyond its sequence.
  if (options.n_step > options.sequence_length) {
    throw InputError("n_step: got " + std::to_string(options.n_step) +
                     ", expected at most sequence_length, which is " +
                     std::to_string(options.sequence_length));
  }
  // With a burn-in of at least sequence_length steps, the network would never be trained at some
  // steps near the beginning of an episode.
  if (options.burn_in > 0 && options.burn_in >= options.sequence_length) {
    throw InputError("burn_in: got " + std::to_string(options.burn_in) +
                     ", expected less than sequence_length, which is " +
                     std::to_string(options.sequence_length));
  }
}

}  // namespace

std::string_view ToString(NetworkKind value) { return kNetworks[static_cast<std::size_t>(value)]; }
std::string_view ToString(LossKind value) { return kLosses[static_cast<std::size_t>(value)]; }

DeepOptions DeepOptions::Parse(const std::string& text, bool recurrent, std::string& resolved) {
  OptionReader reader(text);
  constexpr std::array<std::string_view, 2> kPresets{"tuned", "paper"};
  enum class Preset : std::uint8_t { kTuned, kPaper };
  const Preset preset = ReadWord(reader, "preset", Preset::kTuned, kPresets);
  DeepOptions options = preset == Preset::kPaper ? Paper(recurrent) : Tuned(recurrent);
  if (!recurrent) options.network = ReadWord(reader, "network", options.network, kNetworks);
  ReadNetworkOptions(reader, options);
  ReadReplayOptions(reader, 2.0, options);
  ReadExploration(reader, options.exploration);
  ReadSchedule(reader, "learning_rate", 0.0, 1.0, options.learning_rate);
  ReadSchedule(reader, "train_interval", 0.01, 1e6, options.train_interval);
  ReadWhole(reader, "target_update_interval", 1, 1e9, options.target_update_interval);
  ReadNumber(reader, "tau", 0.0, 1.0, options.tau);
  options.loss = ReadWord(reader, "loss", options.loss, kLosses);
  ReadFlag(reader, "double_dqn", options.double_dqn);
  ReadFlag(reader, "dueling", options.dueling);
  ReadNumber(reader, "ema_rate", 0.0, 1.0, options.ema_rate);
  ReadNumber(reader, "action_gap", 0.0, 0.99, options.action_gap);
  ReadNumber(reader, "repetition_penalty", 0.0, 1e6, options.repetition_penalty);
  if (options.mask_blocked && options.network == NetworkKind::kCnn) {
    throw InputError(
        "mask_blocked: got true, expected false with network=cnn, which reads no features");
  }
  if (options.repetition_penalty > 0.0 && options.network == NetworkKind::kCnn) {
    throw InputError("repetition_penalty: got " + FormatNumber(options.repetition_penalty) +
                     ", expected 0 with network=cnn, which reads no features");
  }
  if (recurrent) ReadSequences(reader, preset == Preset::kPaper, options);
  reader.Finish();
  resolved = reader.Resolved();
  return options;
}

}  // namespace aquafarm::agents
