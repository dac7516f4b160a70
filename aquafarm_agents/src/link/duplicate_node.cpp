// SPDX-License-Identifier: BSD-3-Clause
#include "aquafarm_agents/link/duplicate_node.h"

#include <poll.h>
#include <ros/master.h>
#include <ros/network.h>
#include <ros/this_node.h>
#include <sys/socket.h>
#include <xmlrpcpp/XmlRpcSocket.h>

#include <cerrno>
#include <cstdint>
#include <string>

#include "aquafarm/base/check.h"

namespace aquafarm_agents {
namespace {

constexpr int kLimit_ms = 2000;  // max wait for a host that does not respond

/// Returns true if a pending connection is established within the limit.
bool Completes(int connection) {
  pollfd wanted{connection, POLLOUT, 0};
  int ready = 0;
  do {
    ready = poll(&wanted, 1, kLimit_ms);
  } while (ready < 0 && errno == EINTR);
  int fault = 0;
  socklen_t size = sizeof(fault);
  return ready == 1 && getsockopt(connection, SOL_SOCKET, SO_ERROR, &fault, &size) == 0 &&
         fault == 0;
}

/// Returns true if a process accepts connections on the port, false if none does within the limit.
/// The process need not respond: a node that is stopped or hangs still has its name.
bool IsListenedOn(const std::string& host, std::uint32_t port) {
  using XmlRpc::XmlRpcSocket;  // roscpp uses it, too, to connect to nodes
  const int connection = XmlRpcSocket::socket();
  if (connection < 0) return false;
  const bool connected = XmlRpcSocket::setNonBlocking(connection) &&
                         XmlRpcSocket::connect(connection, host, static_cast<int>(port)) &&
                         Completes(connection);
  XmlRpcSocket::close(connection);
  return connected;
}

}  // namespace

void RefuseTwin() {
  const std::string& name = ros::this_node::getName();
  XmlRpc::XmlRpcValue request;
  XmlRpc::XmlRpcValue response;
  XmlRpc::XmlRpcValue payload;
  request[0] = name;
  request[1] = name;
  // This call also fails if there is no master, which later calls report better.
  if (!ros::master::execute("lookupNode", request, response, payload, /*wait_for_master=*/false)) {
    return;
  }
  if (payload.getType() != XmlRpc::XmlRpcValue::TypeString) return;
  const std::string uri = payload;
  std::string host;
  std::uint32_t port = 0;
  if (!ros::network::splitURI(uri, host, port) || !IsListenedOn(host, port)) return;
  throw aquafarm::InputError("node " + name + " is already running at " + uri +
                             "; stop it or use another name");
}

}  // namespace aquafarm_agents
