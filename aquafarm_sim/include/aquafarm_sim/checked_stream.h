// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/serialization.h>
#include <ros/serialized_message.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

namespace aquafarm_sim {

/// Reads messages of other nodes. A message contains the number of entries of each array of
/// variable length. roscpp allocates the array before it reads the entries, so a message of a few
/// bytes could exhaust the memory. This stream first checks that the message is long enough for the
/// entries.
struct CheckedStream : ros::serialization::IStream {
  using IStream::IStream;

  template <typename T>
  void next(T& value) {
    ros::serialization::deserialize(*this, value);
  }

  /// @throws ros::serialization::StreamOverrunException if the message is too short for the entries
  template <typename T, typename Allocator>
  void next(std::vector<T, Allocator>& values) {
    std::uint32_t count = 0;
    if (getLength() < sizeof(count)) ros::serialization::throwStreamOverrun();
    std::memcpy(&count, getData(), sizeof(count));
    const std::uint64_t smallest = ros::serialization::serializationLength(T());
    if (count * smallest > getLength() - sizeof(count)) ros::serialization::throwStreamOverrun();
    ros::serialization::deserialize(*this, values);
  }
};

/// Reads a request or response.
/// @throws ros::serialization::StreamOverrunException if the message is too short
template <typename Content>
void ReadMessage(const ros::SerializedMessage& message, Content& content) {
  const auto header = static_cast<std::size_t>(message.message_start - message.buf.get());
  CheckedStream stream(message.message_start,
                       static_cast<std::uint32_t>(message.num_bytes - header));
  ros::serialization::deserialize(stream, content);
}

}  // namespace aquafarm_sim
