// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Opens bags and reports the errors of unreadable ones. Header-only, because agents and viewers
/// link only the core library of this package.

#include <aquafarm_msgs/FarmSpec.h>
#include <ros/exception.h>
#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <boost/make_shared.hpp>
#include <boost/shared_ptr.hpp>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <fstream>
#include <map>
#include <new>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "aquafarm/base/check.h"
#include "aquafarm_sim/bags/bag_structure.h"
#include "aquafarm_sim/bags/translate_message.h"
#include "aquafarm_sim/names.h"

namespace aquafarm_sim {

/// Returns the error message for a bag without a spec, to append to its path: there is no such
/// topic, or it has another type.
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

/// Describes the version that recorded a bag. `version` is FarmSpec.version; it may be empty.
inline std::string RecordedBy(const std::string& version) {
  return version.empty() ? "recorded by an unnamed version" : "recorded by version " + version;
}

/// Calls `work` and prepends the path of the bag to the message of an InputError.
/// @throws aquafarm::InputError "PATH: " and the message that `work` threw
template <typename Work>
auto NamingBag(const std::string& path, const Work& work) -> decltype(work()) {
  try {
    return work();
  } catch (const aquafarm::InputError& error) {
    throw aquafarm::InputError(path + ": " + error.what());
  }
}

namespace internal {

/// Limits the memory of this process during its lifetime, because a damaged array length can
/// request any amount of memory.
class MemoryLimit {
 public:
  /// @param more max additional memory [bytes]
  explicit MemoryLimit(std::uintmax_t more) {
    std::ifstream file("/proc/self/statm");
    rlim_t pages = 0;
    for (int field = 0; field < 6; ++field) file >> pages;  // the sixth field is data + stack
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

/// Calls `work`, which allocates memory as requested by a bag.
/// @param size size of the bag [bytes]
/// @throws Damage if `work` requests more memory than a valid bag of this size needs
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

/// Compares the definition of a message type in a bag with that of this version.
using SameText = bool(const std::string& type, const std::string& in_bag,
                      const std::string& in_this_version);

/// Checks that the bag's definitions of the given message types equal those of this version or of
/// an earlier one that it can read (translate_message.h).
/// @param is_same_text compares the text of a definition, comments included, with this version's;
///        nullptr: only the md5 sums are compared
/// @throws aquafarm::InputError if a topic of one of these types has another definition
template <typename... Messages>
void CheckMessages(const rosbag::Bag& bag, const std::string& path,
                   SameText* is_same_text = nullptr) {
  namespace traits = ros::message_traits;
  rosbag::View view(bag);
  for (const rosbag::ConnectionInfo* connection : view.getConnections()) {
    const auto is_other = [&](const char* type, const char* md5sum, const char* definition) {
      if (connection->datatype != type) return false;
      return (connection->md5sum != md5sum && !IsOlderMessage(type, connection->md5sum)) ||
             (is_same_text != nullptr && !is_same_text(type, connection->msg_def, definition));
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

/// Opens a bag after checking its lengths and offsets, on which rosbag's reader would crash.
/// @tparam Messages message types to read; their definitions must be those of this version or of
///         an earlier one that it can read
/// @throws aquafarm::InputError with a message of one line that contains the bag's path
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
    throw aquafarm::InputError(path + ": its recorder was killed; run 'rosbag reindex' first");
  } catch (const internal::Damage& damage) {
    throw aquafarm::InputError(path + ": damaged: " + damage.what() +
                               "; 'rosbag reindex' may repair its index");
  } catch (const std::exception& error) {  // from rosbag, its plugins, times and the file mapping
    throw aquafarm::InputError(path + ": damaged or not a bag: " + error.what());
  }
  CheckMessages<Messages...>(bag, path);
}

namespace internal {

/// Returns the translator from a definition of an earlier version to that of this one, or back.
/// @throws Damage if the definition is not one of an earlier version
template <typename Message>
const MessageTranslator& TranslatorOf(const std::string& definition, bool is_back) {
  namespace traits = ros::message_traits;
  thread_local std::map<std::pair<std::string, bool>, MessageTranslator> known;
  const std::pair<std::string, bool> key{definition, is_back};
  const auto found = known.find(key);
  if (found != known.end()) return found->second;
  const std::string now = traits::definition<Message>();
  constexpr std::size_t kMaxKept = 16;
  if (known.size() == kMaxKept) known.clear();
  try {
    return known
        .try_emplace(key, traits::datatype<Message>(), is_back ? now : definition,
                     is_back ? definition : now)
        .first->second;
  } catch (const TranslationError& error) {
    throw Damage(std::string(traits::datatype<Message>()) + ": " + error.what());
  }
}

/// Translates a serialized message. @throws Damage if the bytes do not fit its definition
inline std::vector<std::uint8_t> Translated(const MessageTranslator& translator,
                                            const std::vector<std::uint8_t>& bytes) {
  try {
    return translator.Translate(bytes);
  } catch (const TranslationError& error) {
    throw Damage(error.what());
  }
}

template <typename Message>
std::vector<std::uint8_t> Serialized(const Message& message) {
  std::vector<std::uint8_t> bytes(ros::serialization::serializationLength(message));
  ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(stream, message);
  return bytes;
}

template <typename Message>
void Deserialize(std::vector<std::uint8_t>& bytes, Message& message) {
  ros::serialization::IStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::deserialize(stream, message);
}

}  // namespace internal

/// Returns a message of a bag, of this version's definition or of an earlier one; null if it has
/// another type. Fields that the earlier definition lacks are zero.
/// @throws an exception that ReadingBag converts to InputError
template <typename Message>
boost::shared_ptr<Message> Instantiate(const rosbag::MessageInstance& message) {
  namespace traits = ros::message_traits;
  if (message.getMD5Sum() == traits::md5sum<Message>()) {
    return internal::Bounded(0, [&] { return message.instantiate<Message>(); });
  }
  if (message.getDataType() != traits::datatype<Message>() ||
      !IsOlderMessage(message.getDataType(), message.getMD5Sum())) {
    return nullptr;
  }
  const MessageTranslator& translator =
      internal::TranslatorOf<Message>(message.getMessageDefinition(), false);
  return internal::Bounded(0, [&] {
    std::vector<std::uint8_t> bytes(message.size());
    ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
    message.write(stream);
    std::vector<std::uint8_t> translated = internal::Translated(translator, bytes);
    auto result = boost::make_shared<Message>();
    internal::Deserialize(translated, *result);
    return result;
  });
}

/// Sets the fields that a definition of an earlier version lacks to zero, as Instantiate does.
/// @param definition of the type in a bag; empty: nothing changes
/// @throws an exception that ReadingBag converts to InputError
template <typename Message>
void DropAddedFields(const std::string& definition, Message& message) {
  if (definition.empty() || definition == ros::message_traits::definition<Message>()) return;
  const auto old = internal::Translated(internal::TranslatorOf<Message>(definition, true),
                                        internal::Serialized(message));
  auto bytes = internal::Translated(internal::TranslatorOf<Message>(definition, false), old);
  internal::Deserialize(bytes, message);
}

/// Calls `work`, which opens and reads a bag with OpenBag and Instantiate.
/// @throws aquafarm::InputError with a message of one line that contains the bag's path, if the bag
///         is damaged
template <typename Work>
auto ReadingBag(const std::string& path, const Work& work) -> decltype(work()) {
  try {
    return work();
  } catch (const internal::Damage& damage) {
    throw aquafarm::InputError(path + ": damaged: " + damage.what());
  } catch (const rosbag::BagException& error) {
    throw aquafarm::InputError(path + ": damaged or not a bag: " + error.what());
  } catch (const ros::Exception& error) {
    throw aquafarm::InputError(path + ": damaged: " + error.what());
  }
}

}  // namespace aquafarm_sim
