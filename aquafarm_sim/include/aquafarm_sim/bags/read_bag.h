// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// How bags are opened, and what is said of those that cannot be read; in a header alone, for
/// agents and viewers link no library of this package but the core.

#include <aquafarm_msgs/FarmSpec.h>
#include <ros/exception.h>
#include <ros/message_traits.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <boost/shared_ptr.hpp>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <fstream>
#include <new>
#include <stdexcept>
#include <string>
#include <system_error>

#include "aquafarm/base/check.h"
#include "aquafarm_sim/bags/bag_structure.h"
#include "aquafarm_sim/names.h"

namespace aquafarm_sim {

/// What is said of a bag without a spec, behind its name: that there is none, or of what type.
inline std::string NoSpec(const rosbag::Bag& bag) {
  const std::string type = ros::message_traits::datatype<aquafarm_msgs::FarmSpec>();
  const std::string name = std::string("/") + names::kSpec;
  const std::string way_out = "; record spec and state, as record.launch does";
  rosbag::View view(bag);
  for (const rosbag::ConnectionInfo* connection : view.getConnections()) {
    const std::string topic = "/" + connection->topic;  // bags also hold names without a slash
    if (connection->datatype == type || topic.size() < name.size()) continue;
    if (topic.compare(topic.size() - name.size(), name.size(), name) != 0) continue;
    return ": topic " + connection->topic + ": got type " + connection->datatype + ", expected " +
           type + way_out;
  }
  return ": no topic spec, so nothing says what was played" + way_out;
}

/// Who recorded a bag, by the version that its spec has.
inline std::string RecordedBy(const std::string& version) {
  return version.empty() ? "recorded by an unnamed version" : "recorded by version " + version;
}

/// Does what a bag's content may be at fault for.
/// @throws aquafarm::InputError with the bag's path before what the work threw
template <typename Work>
auto NamingBag(const std::string& path, const Work& work) -> decltype(work()) {
  try {
    return work();
  } catch (const aquafarm::InputError& error) {
    throw aquafarm::InputError(path + ": " + error.what());
  }
}

namespace internal {

/// Bounds this process's memory while it lives: a damaged length of a list asks for any.
class MemoryLimit {
 public:
  /// @param more bytes than there are in use now
  explicit MemoryLimit(std::uintmax_t more) {
    std::ifstream file("/proc/self/statm");
    rlim_t pages = 0;
    for (int field = 0; field < 6; ++field) file >> pages;  // the sixth: data and stack
    if (!file || getrlimit(RLIMIT_DATA, &before_) != 0) return;
    rlimit limit = before_;
    limit.rlim_cur = std::min<rlim_t>(before_.rlim_cur,
                                      pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE)) + more);
    is_set_ = setrlimit(RLIMIT_DATA, &limit) == 0;
  }
  ~MemoryLimit() {
    if (is_set_) setrlimit(RLIMIT_DATA, &before_);
  }
  MemoryLimit(const MemoryLimit&) = delete;
  MemoryLimit& operator=(const MemoryLimit&) = delete;

 private:
  rlimit before_{};
  bool is_set_{};
};

/// Does what allocates as a bag says.
/// @param size of the bag, bytes
/// @throws Damage where it asks for more than a sound one would
template <typename Work>
auto Bounded(std::uintmax_t size, const Work& work) -> decltype(work()) {
  constexpr std::uintmax_t kSpareBytes = std::uintmax_t{2} << 30U;
  const MemoryLimit limit(kSpareBytes + 4 * size);
  try {
    return work();
  } catch (const std::bad_alloc&) {
    throw Damage("it asks for more memory than a bag of its size needs");
  } catch (const std::length_error&) {
    throw Damage("a message of no possible length");
  }
}

}  // namespace internal

/// @param to_the_letter whether comments and layout of the definitions count as well
/// @throws aquafarm::InputError when a topic of one of these types has another than this version
template <typename... Messages>
void CheckMessages(const rosbag::Bag& bag, const std::string& path, bool to_the_letter = false) {
  namespace traits = ros::message_traits;
  rosbag::View view(bag);
  for (const rosbag::ConnectionInfo* connection : view.getConnections()) {
    const auto is_other = [&](const char* type, const char* md5sum, const char* definition) {
      return connection->datatype == type &&
             (connection->md5sum != md5sum || (to_the_letter && connection->msg_def != definition));
    };
    if (!(is_other(traits::datatype<Messages>(), traits::md5sum<Messages>(),
                   traits::definition<Messages>()) ||
          ...)) {
      continue;
    }
    throw aquafarm::InputError(path + ": topic " + connection->topic + " has another " +
                               connection->datatype +
                               " than this version; use the version that it was recorded by");
  }
}

/// Opens a bag that rosbag's reader does not crash of: it trusts lengths and places.
/// @tparam Messages that will be read, of this version
/// @throws aquafarm::InputError of one line with the bag's path
template <typename... Messages>
void OpenBag(rosbag::Bag& bag, const std::string& path) {
  std::error_code ignored;
  const std::uintmax_t size = std::filesystem::file_size(path, ignored);
  try {
    internal::Bounded(ignored ? 0 : size, [&] {
      internal::CheckStructure(path);
      bag.open(path, rosbag::bagmode::Read);
    });
  } catch (const aquafarm::InputError&) {
    throw;
  } catch (const rosbag::BagUnindexedException&) {
    throw aquafarm::InputError(path + ": its recording was killed; 'rosbag reindex' it first");
  } catch (const internal::Damage& damage) {
    throw aquafarm::InputError(path + ": damaged: " + damage.what() +
                               "; 'rosbag reindex' may mend its index");
  } catch (const std::exception& error) {  // of rosbag, its plugins, times and the mapping
    throw aquafarm::InputError(path + ": damaged or no bag: " + error.what());
  }
  CheckMessages<Messages...>(bag, path);
}

/// A message of a bag; nothing when it is of another type.
/// @throws what ReadingBag makes an InputError of
template <typename Message>
boost::shared_ptr<Message> Instantiate(const rosbag::MessageInstance& message) {
  if (message.getMD5Sum() != ros::message_traits::md5sum<Message>()) return nullptr;
  return internal::Bounded(0, [&] { return message.instantiate<Message>(); });
}

/// Does what opens and reads a bag, by OpenBag and Instantiate.
/// @throws aquafarm::InputError of one line with the bag's path when the bag is at fault
template <typename Work>
auto ReadingBag(const std::string& path, const Work& work) -> decltype(work()) {
  try {
    return work();
  } catch (const internal::Damage& damage) {
    throw aquafarm::InputError(path + ": damaged: " + damage.what());
  } catch (const rosbag::BagException& error) {
    throw aquafarm::InputError(path + ": damaged or no bag: " + error.what());
  } catch (const ros::Exception& error) {
    throw aquafarm::InputError(path + ": damaged: " + error.what());
  }
}

}  // namespace aquafarm_sim
