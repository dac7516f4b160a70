// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_sim/bags/chunked_bag.h"

#include <roslz4/lz4s.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include "aquafarm_sim/bags/bag_op.h"

namespace aquafarm_sim {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::string_view kBegin{"#ROSBAG V2.0\n"};
// Length of the first record's fields and padding. Tools that append or reindex overwrite this
// record in place, so it must be as long as the one that rosbag writes.
constexpr std::size_t kHeaderBytes = 4096;
constexpr std::size_t kMaxChunkBytes = std::size_t{256} << 20U;  // lz4 and readers use int sizes
constexpr int kLz4Block = 6;                                     // 1 MiB, as in rosbag

// The format requires little-endian byte order. All machines that ROS supports are little-endian.
template <typename Number>
void Put(Number number, Bytes& bytes) {
  const auto* const first = reinterpret_cast<const std::uint8_t*>(&number);
  bytes.insert(bytes.end(), first, first + sizeof(Number));
}

void Put(std::string_view text, Bytes& bytes) {
  bytes.insert(bytes.end(), text.begin(), text.end());
}

void Put(const Bytes& more, Bytes& bytes) { bytes.insert(bytes.end(), more.begin(), more.end()); }

void Put(const ros::Time& time, Bytes& bytes) {
  Put(time.sec, bytes);
  Put(time.nsec, bytes);
}

/// Serializes fields. Each field is preceded by its length, and all of them by the total length.
class Fields {
 public:
  explicit Fields(Bytes& bytes) : bytes_(bytes), begin_(bytes.size()) {
    Put(std::uint32_t{0}, bytes_);
  }
  template <typename Value>
  Fields& Add(std::string_view name, const Value& value) {
    const std::size_t begin = bytes_.size();
    Put(std::uint32_t{0}, bytes_);
    Put(name, bytes_);
    Put(std::uint8_t{'='}, bytes_);
    Put(value, bytes_);
    SetLength(begin);
    return *this;
  }
  void End() { SetLength(begin_); }

 private:
  void SetLength(std::size_t begin) {
    const auto length = static_cast<std::uint32_t>(bytes_.size() - begin - sizeof(std::uint32_t));
    std::memcpy(bytes_.data() + begin, &length, sizeof(length));
  }

  Bytes& bytes_;
  const std::size_t begin_;
};

void PutData(const Bytes& data, Bytes& bytes) {
  Put(static_cast<std::uint32_t>(data.size()), bytes);
  Put(data, bytes);
}

[[noreturn]] void ThrowErrno() {
  throw std::system_error(errno != 0 ? errno : EIO, std::generic_category());
}

void Compress(Bytes& source, Bytes& compressed) {
  // Incompressible data is stored uncompressed, with a few bytes of overhead per block and frame.
  compressed.resize(source.size() + source.size() / 1024 + 64);
  auto size = static_cast<unsigned>(compressed.size());
  const int result = roslz4_buffToBuffCompress(
      reinterpret_cast<char*>(source.data()), static_cast<unsigned>(source.size()),
      reinterpret_cast<char*>(compressed.data()), &size, kLz4Block);
  if (result != ROSLZ4_OK) {
    throw std::system_error(std::make_error_code(std::errc::io_error),
                            "lz4 failed with " + std::to_string(result));
  }
  compressed.resize(size);
}

}  // namespace

ChunkedBag::ChunkedBag(const std::string& path)
    : file_(path, std::ios::binary | std::ios::out | std::ios::trunc) {
  if (!file_) ThrowErrno();
  Bytes begin;
  Put(kBegin, begin);
  WriteFile(begin);
  WriteBagHeader(0);
}

ChunkedBag::Connection& ChunkedBag::Connect(const std::string& topic, const std::string& type,
                                            const std::string& md5sum,
                                            const std::string& definition) {
  Connection connection;
  connection.number = static_cast<std::uint32_t>(connections_.size());
  Bytes& record = connection.record;
  Fields(record)
      .Add("conn", connection.number)
      .Add("op", BagOp::kConnection)
      .Add("topic", std::string_view(topic))
      .End();
  Fields(record)
      .Add("md5sum", std::string_view(md5sum))
      .Add("message_definition", std::string_view(definition))
      .Add("topic", std::string_view(topic))
      .Add("type", std::string_view(type))
      .End();
  Put(record, chunk_);
  return connections_.emplace(topic, std::move(connection)).first->second;
}

std::uint8_t* ChunkedBag::AddMessage(Connection& connection, const ros::Time& time,
                                     std::uint32_t length) {
  if (time < latest_) throw std::invalid_argument("a message before the one written last");
  if (chunk_.size() + length > kMaxChunkBytes)
    throw std::length_error("a chunk of more than 256 MiB");
  latest_ = time;
  if (!chunk_start_) chunk_start_ = time;
  ++connection.count;
  Put(time, connection.index);
  Put(static_cast<std::uint32_t>(chunk_.size()), connection.index);
  Fields(chunk_).Add("conn", connection.number).Add("op", BagOp::kMessage).Add("time", time).End();
  Put(length, chunk_);
  chunk_.resize(chunk_.size() + length);
  return chunk_.data() + chunk_.size() - length;
}

void ChunkedBag::EndChunk() {
  const auto position = static_cast<std::uint64_t>(file_.tellp());
  Compress(chunk_, compressed_);
  Bytes header;
  Fields(header)
      .Add("compression", std::string_view("lz4"))
      .Add("op", BagOp::kChunk)
      .Add("size", static_cast<std::uint32_t>(chunk_.size()))
      .End();
  Put(static_cast<std::uint32_t>(compressed_.size()), header);
  WriteFile(header);
  WriteFile(compressed_);
  Bytes indexes;
  Bytes counts;
  std::uint32_t connections = 0;
  for (auto& [topic, connection] : connections_) {
    if (connection.count == 0) continue;
    ++connections;
    Fields(indexes)
        .Add("conn", connection.number)
        .Add("count", connection.count)
        .Add("op", BagOp::kIndex)
        .Add("ver", std::uint32_t{1})
        .End();
    PutData(connection.index, indexes);
    Put(connection.number, counts);
    Put(connection.count, counts);
    connection.index.clear();
    connection.count = 0;
  }
  WriteFile(indexes);
  Fields(chunk_infos_)
      .Add("chunk_pos", position)
      .Add("count", connections)
      .Add("end_time", latest_)
      .Add("op", BagOp::kChunkInfo)
      .Add("start_time", *chunk_start_)
      .Add("ver", std::uint32_t{1})
      .End();
  PutData(counts, chunk_infos_);
  ++chunks_;
  chunk_.clear();
  chunk_start_.reset();
}

void ChunkedBag::Close() {
  if (!chunk_.empty()) EndChunk();
  const auto position = static_cast<std::uint64_t>(file_.tellp());
  // Writes all records of the index in one call. If the file contained only some of them, 'rosbag
  // reindex' would lose every chunk.
  Bytes index;
  for (const auto& [topic, connection] : connections_) Put(connection.record, index);
  Put(chunk_infos_, index);
  WriteFile(index);
  file_.seekp(static_cast<std::streamoff>(kBegin.size()));
  WriteBagHeader(position);
  errno = 0;
  file_.close();
  if (!file_) ThrowErrno();
}

void ChunkedBag::WriteBagHeader(std::uint64_t index_position) {
  Bytes header;
  Fields(header)
      .Add("chunk_count", chunks_)
      .Add("conn_count", static_cast<std::uint32_t>(connections_.size()))
      .Add("index_pos", index_position)
      .Add("op", BagOp::kBag)
      .End();
  const std::size_t fields = header.size() - sizeof(std::uint32_t);  // without the total length
  PutData(Bytes(kHeaderBytes - fields, ' '), header);
  WriteFile(header);
}

void ChunkedBag::WriteFile(const Bytes& bytes) {
  errno = 0;
  file_.write(reinterpret_cast<const char*>(bytes.data()),
              static_cast<std::streamsize>(bytes.size()));
  if (!file_) ThrowErrno();
}

}  // namespace aquafarm_sim
