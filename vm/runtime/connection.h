// One peer of the control channel: its socket, what has come of a message, and what is still to be
// sent. Holds one message each way at most, and nothing while it is idle.
#pragma once

#include <poll.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/limits.h"
#include "vm/runtime/descriptor.h"
#include "vm/runtime/frames.h"
#include "vm/runtime/socket_server.h"

namespace vm {

using Instant = std::chrono::steady_clock::time_point;

inline constexpr size_t kMaxConnections = base::kMaxConnections;

struct Connection {
  Descriptor socket;
  uint64_t session = 0;  // another one for each connection
  std::string user;
  bool bridged = false;  // of another machine, by `stvm bridge`
  Instant since = {};    // when it got its place
  Instant active = {};   // when bytes came or went last
  FrameReader in = {};
  std::optional<base::Bytes> held = {};  // a message that waits for another one's answer
  base::Bytes out = {};
  size_t sent = 0;
  bool closing = false;
  bool silent = true;  // nothing has ever come
  bool only_looks = true;  // has asked for nothing that changes something

  bool sending() const { return sent < out.size(); }
  bool waiting_for_peer() const { return sending() || !in.empty() || held; }
  short wanted_events() const;
  // One round, with what poll() said; false ends it.
  bool attend(short events, Service& service, Instant now);
  // Attends in the middle of another one's answer: what is not urgent is held.
  void attend_urgent(Service& service, Instant now);

 private:
  bool receive(Instant now);
  bool send_rest(Instant now);
  bool answer_next(Service& service);
  void put_answer(base::ByteSpan answer, bool keep_open);
};

// All connections: decides who may stay and who gets a place. Bridges cannot take the last place,
// so that somebody on this machine always gets one. When no place is free, the connection that has
// been idle longest is ended. When none is idle, it is the newest one of this machine that only
// looks, so that watchers keep out nobody who wants to do something; a client that is open connects
// again by itself.
class Connections {
 public:
  // A peer that stops in the middle of a message, or does not read its answer, is ended after this.
  static constexpr auto kPatience = std::chrono::seconds(10);
  // A connection that has asked nothing for so long is ended. When its place is wanted, that is
  // sooner: after kSettled, and at once when it has never asked.
  static constexpr auto kIdle = std::chrono::minutes(15);
  static constexpr auto kSettled = std::chrono::seconds(1);

  explicit Connections(Service& service) : service_(service) {}
  ~Connections() { clear(); }
  Connections(const Connections&) = delete;
  Connections& operator=(const Connections&) = delete;

  size_t size() const { return rows_.size(); }
  bool holds_any() const;  // a message that came in the middle of another one's answer
  Connection& operator[](size_t i) { return *rows_[i]; }
  const Connection& operator[](size_t i) const { return *rows_[i]; }
  // False, and it is left where it is: there is no place for it.
  bool add(Connection& connection, Instant now);
  // Ends one, so that another one can come. False: none of them has to go.
  bool make_room(bool bridged, Instant now);
  // Serves each by what poll() said of it, in this order, and ends those that have not kept to
  // these times. `now` is when poll() returned, for all: no peer pays for the time that an answer
  // takes. False as soon as `ending` is set.
  bool attend(std::span<const pollfd> said, const std::atomic<bool>& ending, Instant now);
  // In the middle of an answer, with what poll() says of each now. Ends none.
  void attend_meanwhile(std::span<const pollfd> said, Instant now);
  void end_overdue(Instant now);
  void end(size_t i);
  void clear();

 private:
  size_t longest_idle(bool bridged, Instant now) const;
  size_t newest_looker(Instant now) const;

  Service& service_;
  const Connection* asking_ = nullptr;  // whose request is being answered
  uint64_t sessions_ = 0;
  std::vector<std::unique_ptr<Connection>> rows_;
};

}  // namespace vm
