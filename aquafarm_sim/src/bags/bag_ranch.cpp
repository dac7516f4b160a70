// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_sim/bags/bag_ranch.h"

#include <aquafarm_msgs/FarmSpec.h>
#include <rosbag/view.h>

#include <set>

#include "aquafarm/base/check.h"
#include "aquafarm_sim/bags/read_bag.h"
#include "aquafarm_sim/names.h"

namespace aquafarm_sim {

std::string FindRanch(const rosbag::Bag& bag, const std::string& path, const std::string& ns) {
  std::set<std::string> found;
  rosbag::View specs(bag,
                     rosbag::TypeQuery(ros::message_traits::datatype<aquafarm_msgs::FarmSpec>()));
  const std::string name = names::kSpec;
  for (const auto* connection : specs.getConnections()) {
    const std::string& topic = connection->topic;
    const std::size_t end = topic.size() < name.size() ? 0 : topic.size() - name.size();
    if (topic.substr(end) == name) found.insert(topic.substr(0, end));
  }
  const std::string wanted = ns.empty() || ns.back() == '/' ? ns : ns + "/";
  if (!wanted.empty() && found.count(wanted) != 0) return wanted;
  if (wanted.empty() && found.size() == 1) return *found.begin();
  std::string all;
  for (const std::string& one : found) all += (all.empty() ? "" : ", ") + one;
  throw aquafarm::InputError(path + (found.empty() ? NoSpec(bag)
                                     : wanted.empty()
                                         ? ": several ranches, select one with --ns: " + all
                                         : ": no ranch " + wanted + ", there is: " + all));
}

}  // namespace aquafarm_sim
