// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Statistics of the losses of evaluated episodes, with intervals. loss = insured - saved, as in
/// farm/accounts.h.
///
/// - VaR, value at risk: the smallest x with P(loss > x) <= 5 %.
/// - CVaR, conditional value at risk: the mean loss of the worst 5 % of the episodes. It is
///   VaR + E[max(0, loss - VaR)] / 5 % (Rockafellar and Uryasev, "Conditional value-at-risk for
///   general loss distributions", Journal of Banking & Finance 26, 2002).
///
/// Episodes with equal starts are not independent, so the standard error is the cluster-robust one
/// and the intervals are those of a cluster bootstrap: distinct starts are drawn with replacement,
/// each with all its episodes, and the interval is from the 2.5 % to the 97.5 % percentile (Davison
/// and Hinkley, "Bootstrap Methods and their Application", 1997, sections 3.8 and 5.3). If all
/// starts are distinct, these are the ordinary ones. The intervals of CVaR are somewhat short if
/// few episodes are in the tail. The random numbers are fixed: equal episodes give equal intervals.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "aquafarm/farm/accounts.h"

namespace aquafarm::agents {

/// VaR and CVaR are of the worst 1 / kTailInverse of the episodes.
inline constexpr std::size_t kTailInverse = 20;

/// An estimate with its 95 % interval, which is NaN for fewer than two distinct episodes.
struct Estimate {
  double value{};
  double low{};
  double high{};
};

/// Money of evaluated episodes; amounts in the scenario's currency, means per episode.
struct Losses {
  std::string currency;
  std::size_t episodes{};
  std::vector<Accounts> accounts;   ///< [episodes]
  std::vector<std::size_t> starts;  ///< [episodes] index of the start of each episode
  std::size_t distinct{};           ///< number of different starts
  std::array<Ledger, kDeviceKindCount> by_kind{};  ///< sums over all episodes
  Cents operating_cost{};                          ///< sum over all episodes
  double mean_loss{};
  double standard_error{};  ///< of mean_loss; NaN for fewer than two distinct episodes
  Estimate var;
  Estimate cvar;
  /// Points (x, P(loss > x)) where the probability changes, x ascending. Before the first x the
  /// probability is 1.
  std::vector<std::pair<double, double>> exceedance;

  /// Returns the sum over all kinds and episodes.
  Ledger Total() const;
  /// Converts a sum over all episodes to a mean per episode in the currency.
  double Mean(Cents sum) const;
};

/// Returns the statistics of the accounts of episodes.
/// @param starts [episodes] index of the start of each episode, in [0, episodes)
/// @param seed of the bootstrap
Losses SummariseLosses(std::vector<Accounts> accounts, std::vector<std::size_t> starts,
                       const std::string& currency, std::uint64_t seed);

/// Names of the columns of AppendAccounts, after a comma each:
/// ",start,insured,saved,damaged,lost,operating_cost,energy_cost,monitoring_insured,…"
std::string AccountColumns();
/// Appends a comma and the value of each column; amounts have two decimals.
/// @param start index of the episode's start
void AppendAccounts(std::size_t start, const Accounts& accounts, std::string& text);

/// Returns an amount with two decimals, exactly: "-0.05", "1234.00".
std::string FormatCents(Cents amount);

}  // namespace aquafarm::agents
