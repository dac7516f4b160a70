// SPDX-License-Identifier: BSD-3-Clause
// Fuzz target for service requests. The first byte of an input selects the service. The other bytes
// are a serialized request, changes to a saved state that is then loaded, or a ship and its action.
// The server starts with two farms. It executes the request and must not crash. After every
// hundredth input, the server's state must be saved and loaded without an error. This check takes
// most of the time.
#include <ros/serialization.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <vector>

#include "aquafarm/base/check.h"
#include "aquafarm/scenario/scenario_yaml.h"
#include "aquafarm_sim/checked_stream.h"
#include "aquafarm_sim/server/farm_server.h"

namespace {

using aquafarm_sim::FarmServer;

constexpr std::int32_t kMaxFarms = 64;  // more farms take too long

std::unique_ptr<FarmServer> MakeServer() {
  aquafarm_sim::ServerOptions options;
  options.farms = 2;
  options.barrier_timeout_s = 0.01;
  return std::make_unique<FarmServer>(
      std::make_shared<const aquafarm::Scenario>(
          aquafarm::LoadScenario(AQUAFARM_SCENARIO_DIR "/zhoushan_infa_2021.yaml")),
      options);
}

template <typename Request>
Request Read(const std::vector<std::uint8_t>& bytes) {
  Request request;
  // The stream only reads the bytes, but its interface takes a mutable pointer.
  aquafarm_sim::CheckedStream stream(const_cast<std::uint8_t*>(bytes.data()),
                                     static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::deserialize(stream, request);
  return request;
}

void Must(bool holds) {
  if (!holds) std::abort();
}

/// Saves the state and changes it: every four bytes are an offset (three bytes) and a value. If one
/// byte is left over, the saved state is cut off.
aquafarm_msgs::LoadState::Request Damaged(FarmServer& server,
                                          const std::vector<std::uint8_t>& bytes) {
  aquafarm_msgs::SaveState saved;
  server.SaveState(saved.response);
  aquafarm_msgs::LoadState::Request request;
  request.data = saved.response.data;
  for (std::size_t i = 0; i + 3 < bytes.size() && !request.data.empty(); i += 4) {
    std::uint32_t place = 0;
    std::memcpy(&place, bytes.data() + i, 3);
    request.data[place % request.data.size()] = bytes[i + 3];
  }
  if (bytes.size() % 4 == 1) request.data.resize(request.data.size() * bytes.back() / 256);
  return request;
}

void Execute(FarmServer& server, std::uint8_t service, const std::vector<std::uint8_t>& bytes) {
  using namespace aquafarm_msgs;
  switch (service % 8) {
    case 0:
      return static_cast<void>(server.Step(Read<Step::Request>(bytes)));
    case 1: {
      Reset call;
      call.request = Read<Reset::Request>(bytes);
      if (call.request.farms > kMaxFarms) return;
      return server.Reset(call.request, call.response);
    }
    case 2: {
      GetState call;
      return server.GetState(Read<GetState::Request>(bytes), call.response);
    }
    case 3: {
      SetDisaster call;
      return server.SetDisaster(Read<SetDisaster::Request>(bytes), call.response);
    }
    case 4: {
      LoadState call;
      return server.LoadState(Read<LoadState::Request>(bytes), call.response);
    }
    case 5: {
      LoadState call;
      return server.LoadState(Damaged(server, bytes), call.response);
    }
    case 6: {
      SetPace call;
      return server.SetPace(Read<SetPace::Request>(bytes), call.response);
    }
    default:
      if (bytes.size() < 5) return;
      aquafarm_sim::ShipCommand command;
      std::memcpy(&command.ship, bytes.data(), sizeof(command.ship));
      command.action = bytes[4];
      server.Command(command);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static std::unique_ptr<FarmServer> server = MakeServer();
  static std::uint64_t inputs = 0;
  if (++inputs % 1000 == 0) server = MakeServer();  // so that a finding depends on few inputs
  if (size == 0) return 0;
  try {
    std::vector<std::uint8_t> bytes(data + 1, data + size);
    bytes.reserve(1);  // roscpp adds to the address of the bytes even if there are none
    Execute(*server, data[0], bytes);
  } catch (const ros::serialization::StreamOverrunException&) {  // roscpp rejects the request
    return 0;
  }
  if (inputs % 100 != 99) return 0;
  aquafarm_msgs::SaveState saved;
  server->SaveState(saved.response);
  Must(saved.response.ok);
  aquafarm_msgs::LoadState loaded;
  loaded.request.data = saved.response.data;
  server->LoadState(loaded.request, loaded.response);
  Must(loaded.response.ok);
  return 0;
}
