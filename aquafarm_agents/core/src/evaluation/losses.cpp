// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm/agents/evaluation/losses.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numeric>
#include <utility>

#include "aquafarm/base/check.h"
#include "aquafarm/base/rng.h"

namespace aquafarm::agents {
namespace {

constexpr std::size_t kResamples = 2000;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
// Separates the draws of the bootstrap from those of learners with the same seed.
constexpr std::uint32_t kBootstrapStream = 0xB007;

struct Tail {
  double var{};
  double cvar{};
};

// A loss and the start of its episode.
struct Loss {
  double amount{};
  std::size_t start{};
};

// Returns VaR and CVaR of a sample in which each loss counts as often as its start was drawn.
// @param descending losses, the largest first
Tail TailOf(const std::vector<Loss>& descending, const std::vector<std::size_t>& drawn) {
  std::size_t total = 0;
  for (const Loss& loss : descending) total += drawn[loss.start];
  Tail tail;
  std::size_t above = 0;  // number of drawn losses before the present one
  double sum = 0.0;       // sum of these losses
  for (const Loss& loss : descending) {
    const std::size_t count = drawn[loss.start];
    tail.var = loss.amount;
    if ((above + count) * kTailInverse > total) break;
    above += count;
    sum += static_cast<double>(count) * loss.amount;
  }
  const double excess = sum - static_cast<double>(above) * tail.var;
  tail.cvar = tail.var + excess * static_cast<double>(kTailInverse) / static_cast<double>(total);
  return tail;
}

// Returns `value` with the interval from the 2.5th to the 97.5th percentile of `resampled`. The
// bounds of the interval are NaN if `resampled` is empty.
Estimate WithInterval(double value, std::vector<double> resampled) {
  if (resampled.empty()) return {value, kNan, kNan};
  std::sort(resampled.begin(), resampled.end());
  const std::size_t cut = resampled.size() / 40;
  return {value, resampled[cut], resampled[resampled.size() - 1 - cut]};
}

// Returns the cluster-robust standard error of the mean. It is computed from the sum of the
// deviations of each start, with the factor G / (G - 1) for G distinct starts.
double StandardError(const std::vector<Loss>& losses, double mean, std::size_t starts,
                     std::size_t distinct) {
  if (distinct < 2) return kNan;
  std::vector<double> deviation(starts);
  for (const Loss& loss : losses) deviation[loss.start] += loss.amount - mean;
  const double squares =
      std::inner_product(deviation.begin(), deviation.end(), deviation.begin(), 0.0);
  const auto groups = static_cast<double>(distinct);
  return std::sqrt(squares * groups / (groups - 1.0)) / static_cast<double>(losses.size());
}

std::vector<std::pair<double, double>> Exceedance(const std::vector<Loss>& descending) {
  std::vector<std::pair<double, double>> curve;
  const auto count = static_cast<double>(descending.size());
  for (std::size_t i = 0; i < descending.size(); ++i) {
    const double x = descending[i].amount;
    if (i > 0 && x == descending[i - 1].amount) continue;
    curve.emplace_back(x, static_cast<double>(i) / count);  // i losses are larger than x
  }
  std::reverse(curve.begin(), curve.end());
  return curve;
}

void AppendLedger(const Ledger& ledger, std::string& text) {
  for (const Cents amount : {ledger.insured, ledger.saved, ledger.damaged, ledger.lost}) {
    text += ',' + FormatCents(amount);
  }
}

}  // namespace

Ledger Losses::Total() const {
  Ledger total;
  for (const Ledger& ledger : by_kind) total += ledger;
  return total;
}

double Losses::Mean(Cents sum) const {
  return episodes == 0 ? 0.0 : static_cast<double>(sum) / 100.0 / static_cast<double>(episodes);
}

Losses SummariseLosses(std::vector<Accounts> accounts, std::vector<std::size_t> starts,
                       const std::string& currency, std::uint64_t seed) {
  AQUAFARM_CHECK_EQ(accounts.size(), starts.size());
  Losses losses;
  losses.currency = currency;
  losses.episodes = accounts.size();
  std::vector<Loss> sample;
  std::vector<std::size_t> once(accounts.size());
  for (std::size_t i = 0; i < accounts.size(); ++i) {
    for (std::size_t kind = 0; kind < losses.by_kind.size(); ++kind) {
      losses.by_kind[kind] += accounts[i].by_kind[kind];
    }
    losses.operating_cost += accounts[i].OperatingCost();
    sample.push_back({static_cast<double>(accounts[i].Total().Loss()) / 100.0, starts[i]});
    once[starts[i]] = 1;
  }
  losses.accounts = std::move(accounts);
  losses.starts = std::move(starts);
  if (sample.empty()) return losses;
  std::vector<std::size_t> distinct;
  for (std::size_t start = 0; start < once.size(); ++start) {
    if (once[start] != 0) distinct.push_back(start);
  }
  losses.distinct = distinct.size();
  losses.mean_loss = losses.Mean(losses.Total().Loss());
  losses.standard_error = StandardError(sample, losses.mean_loss, once.size(), losses.distinct);
  std::stable_sort(sample.begin(), sample.end(),
                   [](const Loss& a, const Loss& b) { return a.amount > b.amount; });
  losses.exceedance = Exceedance(sample);
  const Tail tail = TailOf(sample, once);
  std::vector<double> vars;
  std::vector<double> cvars;
  RandomStream rng({seed, 0, RngStream::kLearner, kBootstrapStream});
  std::vector<std::size_t> drawn(once.size());
  for (std::size_t k = 0; losses.distinct > 1 && k < kResamples; ++k) {
    std::fill(drawn.begin(), drawn.end(), 0);
    for (std::size_t i = 0; i < distinct.size(); ++i) {
      ++drawn[distinct[rng.Below(static_cast<std::uint32_t>(distinct.size()))]];
    }
    const Tail again = TailOf(sample, drawn);
    vars.push_back(again.var);
    cvars.push_back(again.cvar);
  }
  losses.var = WithInterval(tail.var, std::move(vars));
  losses.cvar = WithInterval(tail.cvar, std::move(cvars));
  return losses;
}

std::string AccountColumns() {
  std::string names = ",start,insured,saved,damaged,lost,operating_cost,energy_cost";
  for (int kind = 0; kind < kDeviceKindCount; ++kind) {
    const std::string name(ToString(static_cast<DeviceKind>(kind)));
    for (const char* part : {"insured", "saved", "damaged", "lost"}) {
      names += ',' + name + '_' + part;
    }
  }
  return names;
}

void AppendAccounts(std::size_t start, const Accounts& accounts, std::string& text) {
  text += ',' + std::to_string(start);
  AppendLedger(accounts.Total(), text);
  text += ',' + FormatCents(accounts.OperatingCost()) + ',' + FormatCents(accounts.energy_cost);
  for (const Ledger& ledger : accounts.by_kind) AppendLedger(ledger, text);
}

std::string FormatCents(Cents amount) {
  const Cents size = amount < 0 ? -amount : amount;
  const Cents cents = size % 100;
  return (amount < 0 ? "-" : "") + std::to_string(size / 100) + (cents < 10 ? ".0" : ".") +
         std::to_string(cents);
}

}  // namespace aquafarm::agents
