// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Writes a bag of format 2.0 (http://wiki.ros.org/Bags/Format/2.0) with lz4 compression. Each
/// chunk is assembled in memory and written when it is complete. docs/decisions/chunked_bag.md
/// explains why rosbag::Bag is not used.

#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <ros/time.h>

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace aquafarm_sim {

/// A bag that is being written. Close must be the last call and must be called only once.
class ChunkedBag {
 public:
  /// @throws std::system_error if the file cannot be written
  explicit ChunkedBag(const std::string& path);

  /// Adds a message to the current chunk. Once the chunk has at least 256 KiB, it is compressed and
  /// written.
  /// @param time must not be earlier than the time of the previous message
  /// @throws std::invalid_argument if `time` is earlier
  /// @throws std::length_error if the chunk would exceed 256 MiB
  /// @throws std::system_error if the chunk cannot be compressed or the file cannot be written
  template <typename Message>
  void Write(const std::string& topic, const ros::Time& time, const Message& message) {
    namespace traits = ros::message_traits;
    namespace serialization = ros::serialization;
    const auto known = connections_.find(topic);
    Connection& connection = known != connections_.end()
                                 ? known->second
                                 : Connect(topic, traits::datatype(message),
                                           traits::md5sum(message), traits::definition(message));
    const std::uint32_t length = serialization::serializationLength(message);
    serialization::OStream stream(AddMessage(connection, time, length), length);
    serialization::serialize(stream, message);
    if (chunk_.size() >= kChunkBytes) EndChunk();
  }

  /// Writes the last chunk and the index. If Close was not called, `rosbag reindex` can recover the
  /// chunks that were written.
  /// @throws std::system_error if the chunk cannot be compressed or the file cannot be written
  void Close();

 private:
  using Bytes = std::vector<std::uint8_t>;

  static constexpr std::size_t kChunkBytes = 256 * 1024;  // min size of all chunks but the last

  struct Connection {
    std::uint32_t number{};
    Bytes record;           // the connection record; the index repeats it
    std::uint32_t count{};  // number of messages in the current chunk
    Bytes index;            // time and offset of each message in the current chunk
  };

  Connection& Connect(const std::string& topic, const std::string& type, const std::string& md5sum,
                      const std::string& definition);
  /// Adds a message without its content. @returns pointer to the `length` bytes of the content
  std::uint8_t* AddMessage(Connection& connection, const ros::Time& time, std::uint32_t length);
  void EndChunk();
  void WriteBagHeader(std::uint64_t index_position);
  void WriteFile(const Bytes& bytes);

  std::ofstream file_;
  std::map<std::string, Connection> connections_;  // by topic
  Bytes chunk_;
  std::optional<ros::Time> chunk_start_;  // time of the current chunk's first message
  ros::Time latest_;                      // time of the last message
  Bytes compressed_;                      // scratch
  Bytes chunk_infos_;                     // chunk-info records of the written chunks
  std::uint32_t chunks_{};
};

}  // namespace aquafarm_sim
