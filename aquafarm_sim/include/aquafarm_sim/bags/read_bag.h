// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Opens bags and reads their messages. Damaged bags cause an InputError.

#include <ros/exception.h>
#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sys/resource.h>

#include <boost/make_shared.hpp>
#include <boost/shared_ptr.hpp>
#include <cstdint>
#include <initializer_list>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

#include "aquafarm/base/check.h"
#include "aquafarm_sim/bags/bag_structure.h"
#include "aquafarm_sim/bags/translate_message.h"

namespace aquafarm_sim {

/// Returns the error message for a bag without a FarmSpec. The caller appends it to the bag's path.
/// The message states whether the topic `spec` is missing or has another type.
std::string NoSpec(const rosbag::Bag& bag);

/// Returns "recorded by version X" or, if `version` is empty, "recorded by an unnamed version".
/// @param version FarmSpec.version of the bag
std::string RecordedBy(const std::string& version);

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

/// A message type as this version of aquafarm defines it.
struct MessageType {
  const char* name;
  const char* md5sum;
  const char* definition;
};

template <typename Message>
MessageType TypeOf() {
  namespace traits = ros::message_traits;
  return {traits::datatype<Message>(), traits::md5sum<Message>(), traits::definition<Message>()};
}

namespace internal {

/// Limits the memory of this process while the object exists, because a damaged array length can
/// request any amount of memory. Has no effect if the system refuses the limit.
class MemoryLimit {
 public:
  /// @param more max additional memory [bytes]
  explicit MemoryLimit(std::uintmax_t more);
  ~MemoryLimit();
  MemoryLimit(const MemoryLimit&) = delete;
  MemoryLimit& operator=(const MemoryLimit&) = delete;

 private:
  rlimit before_{};
  bool is_set_{};
};

/// Calls `work` and limits the memory that it can allocate to 2 GiB plus 4 times `size`. No valid
/// bag needs more.
/// @param size size of the bag [bytes]
/// @throws Damage if `work` needs more memory, or requests an impossible array length
template <typename Work>
auto Bounded(std::uintmax_t size, const Work& work) -> decltype(work()) {
  constexpr std::uintmax_t kSpareBytes = std::uintmax_t{2} << 30U;
  const MemoryLimit limit(kSpareBytes + 4 * size);
  try {
    return work();
  } catch (const std::bad_alloc&) {
    throw Damage("reading it needs more memory than a bag of its size may use");
  } catch (const std::length_error&) {
    throw Damage("a message of an impossible length");
  }
}

/// Opens a bag after checking its lengths and offsets.
/// @throws aquafarm::InputError if the bag cannot be read
void OpenChecked(rosbag::Bag& bag, const std::string& path);

/// Translates a serialized message from the definition of an earlier version to that of this
/// version, or in the opposite direction if `is_back`.
/// @param type the definition of this version
/// @param definition the definition of the earlier version
/// @throws Damage if `definition` cannot be parsed or a field has another type, or if the bytes do
///         not fit their definition
std::vector<std::uint8_t> Translated(const MessageType& type, const std::string& definition,
                                     bool is_back, const std::vector<std::uint8_t>& bytes);

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

/// A function that returns whether the text of a message definition in a bag is accepted.
using SameText = bool(const std::string& type, const std::string& in_bag,
                      const std::string& in_this_version);

/// Checks the bag's definitions of the given message types. Each must equal that of this version or
/// one of kOlderMessages (translate_message.h).
/// @param is_same_text compares the text of a definition, comments included, with this version's;
///        nullptr: only the md5 sums are compared
/// @throws aquafarm::InputError if a topic of one of these types has another definition
void CheckMessages(const rosbag::Bag& bag, const std::string& path,
                   std::initializer_list<MessageType> types, SameText* is_same_text = nullptr);

/// Opens a bag after checking its lengths and offsets. rosbag's reader may crash if they are wrong.
/// @tparam Messages message types to read; their definitions in the bag must be those of this
///         version, or of an earlier version that can be translated (translate_message.h)
/// @throws aquafarm::InputError if the bag cannot be read; the message is one line that contains
///         the bag's path
template <typename... Messages>
void OpenBag(rosbag::Bag& bag, const std::string& path) {
  internal::OpenChecked(bag, path);
  CheckMessages(bag, path, {TypeOf<Messages>()...});
}

/// Returns a message of a bag; null if it has another type or an unknown definition. A message of
/// an earlier version is translated. Fields that its definition lacks become zero.
/// @throws an exception that ReadingBag converts to InputError
template <typename Message>
boost::shared_ptr<Message> Instantiate(const rosbag::MessageInstance& message) {
  const MessageType type = TypeOf<Message>();
  if (message.getMD5Sum() == type.md5sum) {
    return internal::Bounded(0, [&] { return message.instantiate<Message>(); });
  }
  if (message.getDataType() != type.name ||
      !IsOlderMessage(message.getDataType(), message.getMD5Sum())) {
    return nullptr;
  }
  return internal::Bounded(0, [&] {
    std::vector<std::uint8_t> bytes(message.size());
    ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
    message.write(stream);
    bytes = internal::Translated(type, message.getMessageDefinition(), false, bytes);
    auto result = boost::make_shared<Message>();
    internal::Deserialize(bytes, *result);
    return result;
  });
}

/// Sets the fields that `definition` lacks to zero, as Instantiate does.
/// @param definition definition of the type in a bag. If it is empty or that of this version,
///        nothing changes.
/// @throws an exception that ReadingBag converts to InputError
template <typename Message>
void DropAddedFields(const std::string& definition, Message& message) {
  const MessageType type = TypeOf<Message>();
  if (definition.empty() || definition == type.definition) return;
  const auto old = internal::Translated(type, definition, true, internal::Serialized(message));
  auto bytes = internal::Translated(type, definition, false, old);
  internal::Deserialize(bytes, message);
}

/// Calls `work`, which opens and reads a bag with OpenBag and Instantiate.
/// @throws aquafarm::InputError if the bag is damaged; the message is one line that contains the
///         bag's path
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
