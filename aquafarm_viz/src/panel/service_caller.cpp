// SPDX-License-Identifier: BSD-3-Clause
#include "service_caller.h"

#include <cstdio>

namespace aquafarm_viz {
namespace {

constexpr std::size_t kMaxWaiting = 8;  // max number of waiting calls

}  // namespace

ServiceCaller::ServiceCaller(const ros::NodeHandle& node, double limit_s, OnAnswer on_answer)
    : node_(node),
      limit_(limit_s),
      on_answer_(std::move(on_answer)),
      worker_([this] { Work(); }),
      watcher_([this] { Watch(); }) {}

ServiceCaller::~ServiceCaller() {
  {
    const aquafarm::MutexLock lock(mutex_);
    ending_ = true;
    if (armed_ != nullptr) armed_->shutdown();
  }
  changed_.notify_all();
  worker_.join();
  watcher_.join();
}

void ServiceCaller::Enqueue(const std::string& name, std::function<std::string()> job) {
  {
    const aquafarm::MutexLock lock(mutex_);
    if (jobs_.size() < kMaxWaiting) {
      jobs_.push_back(std::move(job));
      job = nullptr;
    }
  }
  changed_.notify_all();
  if (job == nullptr) return;
  on_answer_(node_.resolveName(name) + ": not called: " + std::to_string(kMaxWaiting) +
             " calls are already waiting");
}

std::string ServiceCaller::LimitInWords() const {
  char text[32];
  std::snprintf(text, sizeof(text), "%g s", limit_.count());
  return text;
}

bool ServiceCaller::Arm(ros::ServiceClient* client) {
  const aquafarm::MutexLock lock(mutex_);
  if (ending_) return false;
  armed_ = client;
  end_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(limit_);
  cut_off_ = false;
  changed_.notify_all();
  return true;
}

bool ServiceCaller::Disarm() {
  const aquafarm::MutexLock lock(mutex_);
  armed_ = nullptr;
  changed_.notify_all();
  return cut_off_;
}

void ServiceCaller::Work() {
  aquafarm::MutexLock lock(mutex_);
  while (true) {
    while (!ending_ && jobs_.empty()) lock.Wait(changed_);
    if (ending_) return;
    const auto job = std::move(jobs_.front());
    jobs_.pop_front();
    lock.Unlock();
    const std::string line = job();
    if (!line.empty()) on_answer_(line);
    lock.Lock();
  }
}

void ServiceCaller::Watch() {
  aquafarm::MutexLock lock(mutex_);
  while (!ending_) {
    if (armed_ == nullptr || cut_off_) {
      lock.Wait(changed_);
    } else if (Clock::now() < end_) {
      const Clock::time_point end = end_;
      lock.WaitUntil(changed_, end);  // returns early if this call ends or the next is armed
    } else {
      cut_off_ = true;
      armed_->shutdown();
    }
  }
}

}  // namespace aquafarm_viz
