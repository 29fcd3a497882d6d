#include "vm/runtime/connection.h"

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <utility>

namespace vm {

short Connection::wanted_events() const { return sending() ? POLLOUT : POLLIN; }

// False when the peer is gone.
bool Connection::receive(Instant now) {
  uint8_t buffer[16384];
  const size_t room = std::min(sizeof buffer, in.room());
  const ssize_t n = ::recv(socket.get(), buffer, room, MSG_DONTWAIT);
  if (n < 0) return errno == EAGAIN || errno == EINTR;
  if (n == 0) return false;
  in.add({buffer, static_cast<size_t>(n)});
  silent = false;
  active = now;
  return true;
}

bool Connection::send_rest(Instant now) {
  const ssize_t n =
      ::send(socket.get(), out.data() + sent, out.size() - sent, MSG_DONTWAIT | MSG_NOSIGNAL);
  if (n < 0) return errno == EAGAIN || errno == EINTR;
  sent += static_cast<size_t>(n);
  active = now;
  if (sending()) return true;
  out = base::Bytes();
  sent = 0;
  return true;
}

void Connection::put_answer(base::ByteSpan answer, bool keep_open) {
  out = frame(answer);
  sent = 0;
  closing = !keep_open;
}

// Answers the next complete message; false when there is none.
bool Connection::answer_next(Service& service) {
  if (sending() || closing) return false;
  std::optional<base::Bytes> request = std::exchange(held, std::nullopt);
  if (!request) request = in.next();
  if (request) {
    bool keep_open = true;
    only_looks = only_looks && !changes_state(*request);
    service.asked_by(user, session, bridged);
    const base::Bytes answer = service.answer(*request, keep_open);
    put_answer(answer, keep_open);
    return true;
  }
  if (!in.broken()) return false;
  put_answer(encode_answer({base::Refusal::kProtocol, "message not understood: too long"}), false);
  return true;
}

bool Connection::attend(short events, Service& service, Instant now) {
  if ((events & (POLLERR | POLLNVAL)) != 0) return false;
  if ((events & (POLLIN | POLLHUP)) != 0 && !sending() && !receive(now)) return false;
  do {
    if (sending() && !send_rest(now)) return false;
  } while (answer_next(service));
  return sending() || !closing;
}

void Connection::attend_urgent(Service& service, Instant now) {
  if (sending() || closing || held || !receive(now)) return;  // who has gone is seen later
  held = in.next();
  if (!held) return;
  const std::optional<base::Bytes> answer = service.answer_urgent(user, *held);
  if (!answer) return;
  held.reset();
  put_answer(*answer, true);
  (void)send_rest(now);  // and what is left is sent later
}

bool Connections::add(Connection& connection, Instant now) {
  const size_t places = connection.bridged ? kMaxConnections - 1 : kMaxConnections;
  if (rows_.size() >= places && !make_room(connection.bridged, now)) return false;
  connection.session = ++sessions_;
  connection.since = connection.active = now;
  rows_.push_back(std::make_unique<Connection>(std::move(connection)));
  return true;
}

bool Connections::make_room(bool bridged, Instant now) {
  if (asking_ != nullptr) return false;
  size_t leaves = longest_idle(bridged, now);
  if (leaves == rows_.size() && !bridged) leaves = newest_looker(now);
  if (leaves == rows_.size()) return false;
  end(leaves);
  return true;
}

// A bridge takes the place of another one only. How many there are: none.
size_t Connections::longest_idle(bool bridged, Instant now) const {
  size_t oldest = rows_.size();
  for (size_t i = 0; i < rows_.size(); ++i) {
    const Connection& row = *rows_[i];
    const bool idle = !row.waiting_for_peer() && (row.silent || now - row.active >= kSettled);
    if (!idle || (bridged && !row.bridged)) continue;
    if (oldest == rows_.size() || row.active < rows_[oldest]->active) oldest = i;
  }
  return oldest;
}

// Likewise.
size_t Connections::newest_looker(Instant now) const {
  for (size_t i = rows_.size(); i-- > 0;) {
    const Connection& row = *rows_[i];
    const bool settled = !row.waiting_for_peer() && now - row.since >= kSettled;
    if (settled && row.only_looks && !row.bridged) return i;
  }
  return rows_.size();
}

bool Connections::attend(std::span<const pollfd> said, const std::atomic<bool>& ending,
                         Instant now) {
  for (size_t i = rows_.size(); i-- > 0;) {
    if (ending.load()) return false;
    asking_ = rows_[i].get();
    const bool stays = rows_[i]->attend(said[i].revents, service_, now);
    asking_ = nullptr;
    if (!stays) end(i);
  }
  end_overdue(now);
  return true;
}

void Connections::attend_meanwhile(std::span<const pollfd> said, Instant now) {
  for (size_t i = 0; i < said.size(); ++i) {
    if (said[i].revents == 0) continue;
    if (rows_[i].get() != asking_) {
      rows_[i]->attend_urgent(service_, now);
    } else if ((said[i].revents & (POLLHUP | POLLERR | POLLRDHUP)) != 0) {
      service_.asker_left();
    }
  }
}

bool Connections::holds_any() const {
  return std::any_of(rows_.begin(), rows_.end(),
                     [](const auto& row) { return row->held.has_value(); });
}

void Connections::end_overdue(Instant now) {
  for (size_t i = rows_.size(); i-- > 0;) {
    const Connection& row = *rows_[i];
    const auto silent = now - row.active;
    if (silent > (row.waiting_for_peer() ? kPatience : std::chrono::seconds(kIdle))) end(i);
  }
}

void Connections::end(size_t i) {
  service_.ended(rows_[i]->session);
  rows_.erase(rows_.begin() + static_cast<std::ptrdiff_t>(i));
}

void Connections::clear() {
  while (!rows_.empty()) end(rows_.size() - 1);
}

}  // namespace vm
