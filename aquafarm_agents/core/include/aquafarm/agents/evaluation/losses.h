// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Statistics of the losses of evaluated episodes, with intervals. The loss of an episode is the
/// insured value minus the saved value, see farm/accounts.h.
///
/// - VaR, value at risk: the smallest x with P(loss > x) <= 5 %.
/// - CVaR, conditional value at risk: the mean loss of the worst 5 % of the episodes. It is
///   VaR + E[max(0, loss - VaR)] / 5 % (Rockafellar and Uryasev, "Conditional value-at-risk for
///   general loss distributions", Journal of Banking & Finance 26, 2002).
///
/// Episodes with equal starts are not independent. The standard error is therefore cluster-robust,
/// and the intervals come from a cluster bootstrap. The bootstrap draws from the set of distinct
/// starts, with replacement. Each drawn start counts with all its episodes. The interval reaches
/// from the 2.5th to the 97.5th percentile (Davison and Hinkley, "Bootstrap Methods and their
/// Application", 1997, sections 3.8 and 5.3). If all starts are distinct, these are the ordinary
/// standard error and bootstrap. The intervals of CVaR are somewhat too short if few episodes are
/// in the tail. Equal episodes with an equal seed of the bootstrap give equal intervals.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "aquafarm/farm/accounts.h"

namespace aquafarm::agents {

/// VaR and CVaR describe the worst 1 / kTailInverse of the episodes.
inline constexpr std::size_t kTailInverse = 20;

/// An estimate with its 95 % interval, which is NaN for fewer than two distinct starts.
struct Estimate {
  double value{};
  double low{};
  double high{};
};

/// Losses of evaluated episodes. Amounts of type double are in the scenario's currency.
struct Losses {
  std::string currency;
  std::size_t episodes{};
  std::vector<Accounts> accounts;   ///< [episodes]
  std::vector<std::size_t> starts;  ///< [episodes] index of the start of each episode
  std::size_t distinct{};           ///< number of different starts
  std::array<Ledger, kDeviceKindCount> by_kind{};  ///< sums over all episodes
  Cents operating_cost{};                          ///< sum over all episodes
  double mean_loss{};                              ///< per episode
  double standard_error{};  ///< of mean_loss; NaN for fewer than two distinct starts
  Estimate var;
  Estimate cvar;
  /// Points (x, P(loss > x)) at which the probability changes, in the order of x. Below the first x
  /// the probability is 1.
  std::vector<std::pair<double, double>> exceedance;

  /// Returns the sums over all kinds and episodes.
  Ledger Total() const;
  /// Converts a sum over all episodes to the mean per episode, in the scenario's currency.
  double Mean(Cents sum) const;
};

/// Returns the statistics of the accounts of episodes.
/// @param starts [episodes] index of the start of each episode, in [0, episodes)
/// @param seed seed of the bootstrap
Losses SummariseLosses(std::vector<Accounts> accounts, std::vector<std::size_t> starts,
                       const std::string& currency, std::uint64_t seed);

/// Returns the names of the columns of AppendAccounts, each after a comma:
/// ",start,insured,saved,damaged,lost,operating_cost,energy_cost,temporary_breeding_insured,…"
std::string AccountColumns();
/// Appends the value of each column, after a comma. Amounts have two decimals.
/// @param start index of the episode's start; see Losses::starts
void AppendAccounts(std::size_t start, const Accounts& accounts, std::string& text);

/// Returns an amount with two decimals, exactly: "-0.05", "1234.00".
std::string FormatCents(Cents amount);

}  // namespace aquafarm::agents
