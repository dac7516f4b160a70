// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_sim/bags/bag_structure.h"

#include <rosbag/bag.h>
#include <rosbag/chunked_file.h>
#include <rosbag/exceptions.h>
#include <rosbag/stream.h>

#include <algorithm>
#include <boost/interprocess/file_mapping.hpp>
#include <boost/interprocess/mapped_region.hpp>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <string_view>
#include <system_error>
#include <tuple>
#include <utility>
#include <vector>

#include "aquafarm/base/check.h"
#include "aquafarm_sim/bags/bag_op.h"

namespace aquafarm_sim::internal {
namespace {

// Iterates over the records of a bag or of a chunk (format 2.0, wiki.ros.org/Bags/Format).
class BagRecords {
 public:
  // @param whole text after each position in error messages if the bytes are only a part of the
  //        bag, for example " of the chunk at byte 4117"
  explicit BagRecords(std::string_view bytes, std::size_t position = 0, std::string whole = "")
      : bytes_(bytes), position_(position), whole_(std::move(whole)) {}

  std::size_t position() const { return position_; }  // offset of the next record
  std::size_t begin() const { return begin_; }        // offset of the current record
  std::string_view data() const { return data_; }
  bool AtEnd() const { return position_ == bytes_.size(); }

  // Advances to the next record. @throws Damage if the bytes end before the record does
  void Next() {
    begin_ = position_;
    fields_ = Fields(Take());
    data_ = Take();
  }

  using FieldMap = std::map<std::string_view, std::string_view>;

  // Parses bytes of the current record into named fields.
  FieldMap Fields(std::string_view bytes) const {
    FieldMap fields;
    while (!bytes.empty()) {
      const std::string_view field = TakeFrom(bytes);
      const std::size_t end = field.find('=');
      if (end == std::string_view::npos) throw Damage("a field without a name" + Where());
      fields[field.substr(0, end)] = field.substr(end + 1);
    }
    return fields;
  }

  bool Has(std::string_view name) const { return fields_.count(name) != 0; }

  std::string_view Text(std::string_view name) const {
    const auto found = fields_.find(name);
    if (found == fields_.end())
      throw Damage("a record without field " + std::string(name) + Where());
    return found->second;
  }

  template <typename Number>
  Number Get(std::string_view name) const {
    const std::string_view text = Text(name);
    if (text.size() != sizeof(Number))
      throw Damage("a wrong length of field " + std::string(name) + Where());
    return Read<Number>(text, 0);
  }

  bool Is(BagOp op) const { return Get<std::uint8_t>("op") == static_cast<std::uint8_t>(op); }

  void Expect(BagOp op) const {
    if (!Is(op)) throw Damage("an unexpected kind of record" + Where());
  }

  // Reads the number at offset `place`. Does not check that `bytes` contains the whole number.
  template <typename Number>
  static Number Read(std::string_view bytes, std::size_t place) {
    Number number;
    std::memcpy(&number, bytes.data() + place, sizeof(Number));
    return number;
  }

  std::string Where() const { return " at byte " + std::to_string(begin_) + whole_; }

 private:
  std::string_view TakeFrom(std::string_view& bytes) const {
    constexpr std::size_t kLength = sizeof(std::uint32_t);
    if (bytes.size() < kLength) throw Damage("a length that is cut off" + Where());
    const std::size_t length = Read<std::uint32_t>(bytes, 0);
    if (length > bytes.size() - kLength) throw Damage("a length beyond its end" + Where());
    const std::string_view taken = bytes.substr(kLength, length);
    bytes.remove_prefix(kLength + length);
    return taken;
  }

  std::string_view Take() {
    std::string_view rest = bytes_.substr(position_);
    const std::string_view taken = TakeFrom(rest);
    position_ = bytes_.size() - rest.size();
    return taken;
  }

  std::string_view bytes_;
  std::size_t position_;
  std::string whole_;
  std::size_t begin_{};
  FieldMap fields_;
  std::string_view data_;
};

// The messages of a chunk, read from its content or from its index.
struct ChunkMessages {
  using Entry = std::tuple<std::uint32_t, std::uint64_t, std::uint32_t>;  // connection, time, begin
  std::vector<Entry> entries;

  bool operator==(const ChunkMessages& other) const { return entries == other.entries; }

  void Sort() { std::sort(entries.begin(), entries.end()); }

  // Number of messages of each connection.
  std::map<std::uint32_t, std::uint32_t> Counts() const {
    std::map<std::uint32_t, std::uint32_t> counts;
    for (const Entry& entry : entries) ++counts[std::get<0>(entry)];
    return counts;
  }
};

// Connections by number. Each is a map from names to texts: from "/topic" to the topic, and from
// the name of each field of the connection header to its value.
using Connections = std::map<std::uint32_t, std::map<std::string, std::string>>;

// Adds a connection. A bag contains two records of each connection, one in a chunk and one in the
// index. Both must be equal.
// @throws Damage if a connection with the same number differs
void TakeConnection(const BagRecords& record, Connections& connections) {
  std::map<std::string, std::string> fields{{"/topic", std::string(record.Text("topic"))}};
  for (const auto& [name, value] : record.Fields(record.data())) {
    fields[std::string(name)] = std::string(value);
  }
  const auto [known, is_new] = connections.insert({record.Get<std::uint32_t>("conn"), fields});
  if (!is_new && known->second != fields)
    throw Damage("two different records of one connection" + record.Where());
}

// Reads the messages of a chunk.
// @param connections receives the connections of the chunk
// @throws Damage if the chunk is damaged
// @throws rosbag::BagException if the chunk cannot be decompressed
ChunkMessages ReadChunk(const BagRecords& chunk, Connections& connections) {
  constexpr std::size_t kMax = std::size_t{256} << 20U;  // rosbag allocates up to twice as much
  const std::size_t size = chunk.Get<std::uint32_t>("size");
  const std::string_view kind = chunk.Text("compression");
  if (size > kMax) throw Damage("a chunk of more than 256 MiB" + chunk.Where());
  std::vector<std::uint8_t> room;
  std::string_view content = chunk.data();
  if (kind == "none") {
    if (content.size() != size) throw Damage("a chunk of another size than stated" + chunk.Where());
  } else {
    if (kind != "lz4" && kind != "bz2")
      throw Damage("a chunk of unknown compression" + chunk.Where());
    room.resize(size);
    std::vector<std::uint8_t> source(content.begin(), content.end());
    rosbag::ChunkedFile no_file;
    rosbag::StreamFactory(&no_file)
        .getStream(kind == "lz4" ? rosbag::compression::LZ4 : rosbag::compression::BZ2)
        ->decompress(room.data(), static_cast<unsigned>(size), source.data(),
                     static_cast<unsigned>(source.size()));
    content = {reinterpret_cast<const char*>(room.data()), size};
  }
  ChunkMessages messages;
  for (BagRecords records(content, 0, " of the chunk" + chunk.Where()); !records.AtEnd();) {
    records.Next();
    if (records.Is(BagOp::kConnection)) {
      TakeConnection(records, connections);
      continue;
    }
    records.Expect(BagOp::kMessage);
    messages.entries.emplace_back(records.Get<std::uint32_t>("conn"),
                                  records.Get<std::uint64_t>("time"),
                                  static_cast<std::uint32_t>(records.begin()));
  }
  messages.Sort();
  return messages;
}

// Adds the entries of one index record of a chunk.
void ReadIndex(const BagRecords& index, ChunkMessages& messages) {
  constexpr std::size_t kBytes = 12;  // per entry: time and offset
  const std::size_t count = index.Get<std::uint32_t>("count");
  if (index.Get<std::uint32_t>("ver") != 1 || index.data().size() != count * kBytes) {
    throw Damage("an invalid index record" + index.Where());
  }
  for (std::size_t i = 0; i < count; ++i) {
    messages.entries.emplace_back(
        index.Get<std::uint32_t>("conn"), BagRecords::Read<std::uint64_t>(index.data(), kBytes * i),
        BagRecords::Read<std::uint32_t>(index.data(), kBytes * i + sizeof(std::uint64_t)));
  }
}

// Compares a chunk-info record with its chunk, and removes the chunk from `chunks`.
// @param chunks chunks that no chunk-info record has described so far
// @throws Damage if the chunk-info record disagrees with the chunk
void CheckChunkInfo(const BagRecords& info, const Connections& connections,
                    std::map<std::uint64_t, ChunkMessages>& chunks) {
  constexpr std::size_t kBytes = 8;  // per entry: connection and count
  const auto chunk = chunks.find(info.Get<std::uint64_t>("chunk_pos"));
  const std::size_t count = info.Get<std::uint32_t>("count");
  if (chunk == chunks.end() || info.Get<std::uint32_t>("ver") != 1 ||
      info.data().size() != count * kBytes) {
    throw Damage("wrong chunk info" + info.Where());
  }
  std::map<std::uint32_t, std::uint32_t> counts;
  for (std::size_t i = 0; i < count; ++i) {
    counts[BagRecords::Read<std::uint32_t>(info.data(), kBytes * i)] =
        BagRecords::Read<std::uint32_t>(info.data(), kBytes * i + sizeof(std::uint32_t));
  }
  // A time is stored as seconds, then nanoseconds. With its halves swapped, it can be compared as
  // an integer.
  const auto ordered = [](std::uint64_t time) { return (time << 32U) | (time >> 32U); };
  std::uint64_t first = UINT64_MAX;
  std::uint64_t last = 0;
  for (const auto& [connection, time, place] : chunk->second.entries) {
    first = std::min(first, ordered(time));
    last = std::max(last, ordered(time));
  }
  if (counts != chunk->second.Counts() || ordered(info.Get<std::uint64_t>("start_time")) != first ||
      ordered(info.Get<std::uint64_t>("end_time")) != last) {
    throw Damage("wrong chunk info" + info.Where());
  }
  for (const auto& [connection, messages] : counts) {
    if (connections.count(connection) == 0)
      throw Damage("a message without a topic" + info.Where());
  }
  chunks.erase(chunk);
}

// Compares the index of the bag with the content of its chunks.
// @param records records of the bag; the bag header is the current record
// @param bytes size of the bag
// @throws Damage if they disagree
void CheckIndex(BagRecords& records, std::size_t bytes) {
  const std::uint64_t index = records.Get<std::uint64_t>("index_pos");
  const std::uint32_t chunk_count = records.Get<std::uint32_t>("chunk_count");
  const std::uint32_t connection_count = records.Get<std::uint32_t>("conn_count");
  if (index == 0) return;  // the recorder was killed before it wrote the index
  // Limits the uncompressed size, because reading a larger bag can take hours. Recordings of
  // ranches are compressed by a factor much smaller than 4,000.
  const std::uint64_t max_bytes = (std::uint64_t{1} << 30U) + 4'000 * std::uint64_t{bytes};
  std::uint64_t all_bytes = 0;
  std::map<std::uint64_t, ChunkMessages> chunks;
  Connections connections;
  while (records.position() < index) {
    records.Next();
    // If a recorder was killed while it wrote the index, 'rosbag reindex' leaves the incomplete
    // index in front of the new one.
    if (records.Is(BagOp::kConnection)) TakeConnection(records, connections);
    if (records.Is(BagOp::kConnection) || records.Is(BagOp::kChunkInfo)) continue;
    records.Expect(BagOp::kChunk);
    const std::string where = records.Where();
    all_bytes += records.Get<std::uint32_t>("size");
    if (all_bytes > max_bytes) throw Damage("chunks that are too large for the bag's size" + where);
    ChunkMessages& messages = chunks[records.begin()] = ReadChunk(records, connections);
    ChunkMessages indexed;
    for (std::size_t left = messages.Counts().size(); left > 0; --left) {
      records.Next();
      records.Expect(BagOp::kIndex);
      ReadIndex(records, indexed);
    }
    indexed.Sort();
    if (!(indexed == messages)) throw Damage("an index that does not match its chunk" + where);
  }
  if (records.position() != index || chunks.size() != chunk_count)
    throw Damage("its header disagrees with its chunks");
  for (std::uint32_t i = 0; i < connection_count; ++i) {
    records.Next();
    records.Expect(BagOp::kConnection);
    TakeConnection(records, connections);
  }
  if (connections.size() != connection_count)
    throw Damage("its header disagrees with its connections");
  for (std::uint32_t i = 0; i < chunk_count; ++i) {
    records.Next();
    records.Expect(BagOp::kChunkInfo);
    CheckChunkInfo(records, connections, chunks);
  }
  if (!records.AtEnd()) throw Damage("records after its index");
}

}  // namespace

void CheckStructure(const std::string& path) {
  static constexpr std::string_view kBegin{"#ROSBAG V2.0\n"};
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(path, ignored);
  if (status.type() == std::filesystem::file_type::not_found) {
    throw aquafarm::InputError(path + ": no such file");
  }
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    throw rosbag::BagIOException("not a regular file");  // opening a pipe may wait forever
  }
  std::ifstream readable(path, std::ios::binary | std::ios::ate);
  if (!readable || readable.tellg() <= static_cast<std::streamoff>(kBegin.size())) return;
  namespace interprocess = boost::interprocess;
  const interprocess::file_mapping file(path.c_str(), interprocess::read_only);
  const interprocess::mapped_region region(file, interprocess::read_only);
  const std::string_view bytes(static_cast<const char*>(region.get_address()), region.get_size());
  if (bytes.substr(0, kBegin.size()) != kBegin)
    throw rosbag::BagFormatException("not a bag of version 2.0");
  BagRecords records(bytes, kBegin.size());
  records.Next();
  records.Expect(BagOp::kBag);
  if (records.Has("encryptor") && !records.Text("encryptor").empty()) {
    throw aquafarm::InputError(path + ": encrypted; run 'rosbag decrypt' first");
  }
  CheckIndex(records, bytes.size());
}

}  // namespace aquafarm_sim::internal
