// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/serialization.h>

#include <cstdint>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

namespace aquafarm_sim {

/// Returns the first difference between two printed messages, for example "ships[0].reward: got -1,
/// simulated -6". If the texts are equal, returns that the bits differ.
std::string FirstDifferentLine(const std::string& got, const std::string& simulated);

/// Returns the first difference between a message and a simulated one, in the format of
/// FirstDifferentLine. Returns an empty text if the messages are bit-identical.
template <typename Message>
std::string FirstDifference(const Message& got, const Message& simulated) {
  const auto bytes = [](const Message& message) {
    std::vector<std::uint8_t> data(ros::serialization::serializationLength(message));
    ros::serialization::OStream stream(data.data(), static_cast<std::uint32_t>(data.size()));
    ros::serialization::serialize(stream, message);
    return data;
  };
  if (bytes(got) == bytes(simulated)) return "";
  const auto text = [](const Message& message) {
    std::ostringstream stream;
    stream.precision(std::numeric_limits<double>::max_digits10);
    stream << message;
    return stream.str();
  };
  return FirstDifferentLine(text(got), text(simulated));
}

}  // namespace aquafarm_sim
