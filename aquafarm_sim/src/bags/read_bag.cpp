// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_sim/bags/read_bag.h"

#include <aquafarm_msgs/FarmSpec.h>
#include <unistd.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <fstream>
#include <map>
#include <system_error>
#include <tuple>
#include <utility>

#include "aquafarm_sim/names.h"

namespace aquafarm_sim {
namespace internal {
namespace {

// Returns the translator from the definition of an earlier version to that of this version, or in
// the opposite direction if `is_back`.
// @throws TranslationError if the definition cannot be parsed or a field has another type
const MessageTranslator& TranslatorOf(const MessageType& type, const std::string& definition,
                                      bool is_back) {
  struct Key {
    std::string type;
    std::string definition;
    bool is_back;
    bool operator<(const Key& other) const {
      return std::tie(type, definition, is_back) <
             std::tie(other.type, other.definition, other.is_back);
    }
  };
  thread_local std::map<Key, MessageTranslator> known;
  const Key key{type.name, definition, is_back};
  const auto found = known.find(key);
  if (found != known.end()) return found->second;
  const std::string now = type.definition;
  constexpr std::size_t kMaxKept = 48;
  if (known.size() == kMaxKept) known.clear();
  return known.try_emplace(key, type.name, is_back ? now : definition, is_back ? definition : now)
      .first->second;
}

}  // namespace

MemoryLimit::MemoryLimit(std::uintmax_t more) {
  std::ifstream file("/proc/self/statm");
  rlim_t pages = 0;
  for (int field = 0; field < 6; ++field) file >> pages;  // the sixth field is data + stack
  if (!file || getrlimit(RLIMIT_DATA, &before_) != 0) return;
  rlimit limit = before_;
  limit.rlim_cur =
      std::min<rlim_t>(before_.rlim_cur, pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE)) + more);
  is_set_ = setrlimit(RLIMIT_DATA, &limit) == 0;
}

MemoryLimit::~MemoryLimit() {
  if (is_set_) setrlimit(RLIMIT_DATA, &before_);
}

void OpenChecked(rosbag::Bag& bag, const std::string& path) {
  std::error_code ignored;
  const std::uintmax_t size = std::filesystem::file_size(path, ignored);
  try {
    Bounded(ignored ? 0 : size, [&] {
      CheckStructure(path);
      bag.open(path, rosbag::bagmode::Read);
    });
  } catch (const aquafarm::InputError&) {
    throw;
  } catch (const rosbag::BagUnindexedException&) {
    throw aquafarm::InputError(path + ": its recorder was killed; run 'rosbag reindex' first");
  } catch (const Damage& damage) {
    throw aquafarm::InputError(path + ": damaged: " + damage.what() +
                               "; 'rosbag reindex' may repair its index");
  } catch (const std::exception& error) {  // from rosbag, its plugins, ros::Time or boost
    throw aquafarm::InputError(path + ": damaged or not a bag: " + error.what());
  }
}

std::vector<std::uint8_t> Translated(const MessageType& type, const std::string& definition,
                                     bool is_back, const std::vector<std::uint8_t>& bytes) {
  try {
    return TranslatorOf(type, definition, is_back).Translate(bytes);
  } catch (const TranslationError& error) {
    throw Damage(std::string(type.name) + ": " + error.what());
  }
}

}  // namespace internal

std::string NoSpec(const rosbag::Bag& bag) {
  const std::string type = ros::message_traits::datatype<aquafarm_msgs::FarmSpec>();
  const std::string name = std::string("/") + names::kSpec;
  const std::string way_out = "; record spec and state, as record.launch does";
  rosbag::View view(bag);
  for (const rosbag::ConnectionInfo* connection : view.getConnections()) {
    const std::string topic = "/" + connection->topic;  // bags also contain names without a slash
    if (connection->datatype == type || topic.size() < name.size()) continue;
    if (topic.compare(topic.size() - name.size(), name.size(), name) != 0) continue;
    return ": topic " + connection->topic + ": got type " + connection->datatype + ", expected " +
           type + way_out;
  }
  return ": no topic spec, so it is unknown what was played" + way_out;
}

std::string RecordedBy(const std::string& version) {
  return version.empty() ? "recorded by an unnamed version" : "recorded by version " + version;
}

void CheckMessages(const rosbag::Bag& bag, const std::string& path,
                   std::initializer_list<MessageType> types, SameText* is_same_text) {
  rosbag::View view(bag);
  for (const rosbag::ConnectionInfo* connection : view.getConnections()) {
    const auto is_other = [&](const MessageType& type) {
      if (connection->datatype != type.name) return false;
      return (connection->md5sum != type.md5sum &&
              !IsOlderMessage(type.name, connection->md5sum)) ||
             (is_same_text != nullptr &&
              !is_same_text(type.name, connection->msg_def, type.definition));
    };
    if (std::none_of(types.begin(), types.end(), is_other)) continue;
    throw aquafarm::InputError(path + ": topic " + connection->topic + " has another " +
                               connection->datatype +
                               " than this version; use the version that recorded the bag");
  }
}

}  // namespace aquafarm_sim
