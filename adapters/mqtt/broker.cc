// libmosquitto behind broker.h. Its thread calls back; what comes is put into a queue.
#include "adapters/mqtt/broker.h"

#include <mosquitto.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <deque>
#include <map>
#include <mutex>
#include <set>

namespace mqtt {
namespace {

using base::Refusal;

// The library counts its users by itself, but not safely between threads.
void begin_library() {
  static std::once_flag once;
  std::call_once(once, [] { mosquitto_lib_init(); });
}

base::Status status_of(int code, const std::string& what) {
  if (code == MOSQ_ERR_SUCCESS) return base::Ok{};
  const bool gone = code == MOSQ_ERR_NO_CONN || code == MOSQ_ERR_CONN_LOST;
  return base::Error{gone ? Refusal::kNotRunning : Refusal::kDeviceFailed,
                     what + ": " + mosquitto_strerror(code)};
}

// Whoever has a password or a private key is this side. A group may share one.
base::Status check_secret(const std::string& path) {
  struct stat about {};
  const bool known = ::stat(path.c_str(), &about) == 0 && S_ISREG(about.st_mode);
  if (!known || (about.st_mode & 07) == 0) return base::Ok{};
  return base::Error{Refusal::kBadKeys,
                     path +
                         ": everybody on this machine can read or write this secret; chmod 640 "
                         "or 600 it, or make another one if somebody may have done so"};
}

base::Result<std::string> first_line(const std::string& path) {
  std::FILE* const file = std::fopen(path.c_str(), "r");
  if (file == nullptr) return base::Error{Refusal::kFileNotFound, path + ": cannot be read"};
  std::string line;
  for (int c = std::fgetc(file); c != EOF && c != '\n' && line.size() < 1024;
       c = std::fgetc(file)) {
    line += static_cast<char>(c);
  }
  std::fclose(file);
  return line;
}

const char* text_or_null(const std::string& text) { return text.empty() ? nullptr : text.c_str(); }

class Mosquitto : public Broker {
 public:
  Mosquitto() { begin_library(); }
  ~Mosquitto() override {
    if (client_ == nullptr) return;
    mosquitto_disconnect(client_);
    mosquitto_loop_stop(client_, false);
    mosquitto_destroy(client_);
  }
  Mosquitto(const Mosquitto&) = delete;
  Mosquitto& operator=(const Mosquitto&) = delete;

  base::Status begin(const Settings& settings) {
    base::Result<Address> address = parse_url(settings.url);
    if (!address.ok()) return address.error();
    client_ = mosquitto_new(settings.client.c_str(), true, this);
    if (client_ == nullptr) return base::Error{Refusal::kDeviceFailed, "no client can be made"};
    mosquitto_connect_callback_set(client_, on_connect);
    mosquitto_disconnect_callback_set(client_, on_disconnect);
    mosquitto_message_callback_set(client_, on_message);
    mosquitto_publish_callback_set(client_, on_published);
    mosquitto_reconnect_delay_set(client_, 1, 30, true);
    mosquitto_max_inflight_messages_set(client_, 100);
    base::Status set = identify(settings, *address);
    if (set.ok() && settings.will) set = leave_will(*settings.will);
    if (!set.ok()) return set;
    // Where nobody answers yet, the thread tries again.
    mosquitto_connect_async(client_, address->host.c_str(), address->port, settings.keep_alive_s);
    return status_of(mosquitto_loop_start(client_), settings.url);
  }

  base::Status publish(const std::string& topic, base::ByteSpan payload, bool retained) override {
    if (payload.size() > kMostPayload) return base::Error{Refusal::kTooMany, topic + ": too long"};
    {
      const std::lock_guard<std::mutex> one(mutex_);
      if (leaving_ >= kMostLeaving || leaving_bytes_ + payload.size() > kMostLeavingBytes) {
        return base::Error{Refusal::kTooMany,
                           topic + ": the broker does not take what was published before"};
      }
      ++leaving_;
      leaving_bytes_ += payload.size();
    }
    int number = 0;
    const int code =
        mosquitto_publish(client_, &number, topic.c_str(), static_cast<int>(payload.size()),
                          payload.data(), 1, retained);
    const std::lock_guard<std::mutex> one(mutex_);
    // Without a connection it is kept, and goes out with the next one.
    if (code != MOSQ_ERR_SUCCESS && code != MOSQ_ERR_NO_CONN) {
      has_left(payload.size());
      return status_of(code, topic);
    }
    if (left_early_.erase(number) != 0) {
      has_left(payload.size());
    } else {
      sizes_[number] = payload.size();
    }
    return base::Ok{};
  }

  base::Status subscribe(const std::string& filter) override {
    return status_of(mosquitto_subscribe(client_, nullptr, filter.c_str(), 1), filter);
  }
  base::Status unsubscribe(const std::string& filter) override {
    return status_of(mosquitto_unsubscribe(client_, nullptr, filter.c_str()), filter);
  }

  std::optional<Event> wait(int64_t ms) override {
    std::unique_lock<std::mutex> held(mutex_);
    came_.wait_for(held, std::chrono::milliseconds(ms), [this] { return !events_.empty(); });
    if (events_.empty()) return std::nullopt;
    Event event = std::move(events_.front());
    events_.pop_front();
    waiting_bytes_ -= event.message.payload.size();
    return event;
  }

  bool flush(int64_t ms) override {
    std::unique_lock<std::mutex> held(mutex_);
    return left_.wait_for(held, std::chrono::milliseconds(ms), [this] { return leaving_ == 0; });
  }

 private:
  base::Status identify(const Settings& settings, const Address& address) {
    if (!settings.user.empty()) {
      std::string password;
      if (!settings.password_file.empty()) {
        base::Status own = check_secret(settings.password_file);
        if (!own.ok()) return own;
        base::Result<std::string> line = first_line(settings.password_file);
        if (!line.ok()) return line.error();
        password = *line;
      }
      base::Status named =
          status_of(mosquitto_username_pw_set(client_, settings.user.c_str(), password.c_str()),
                    "user " + settings.user);
      if (!named.ok()) return named;
    }
    if (!address.tls) return base::Ok{};
    for (const std::string* file : {&settings.ca, &settings.certificate, &settings.key}) {
      if (file->empty() || ::access(file->c_str(), R_OK) == 0) continue;
      return base::Error{Refusal::kFileNotFound, *file + ": cannot be read"};
    }
    if (base::Status own = check_secret(settings.key); !own.ok()) return own;
    base::Status trusted = status_of(
        mosquitto_tls_set(client_, text_or_null(settings.ca),
                          settings.ca.empty() ? "/etc/ssl/certs" : nullptr,
                          text_or_null(settings.certificate), text_or_null(settings.key), nullptr),
        "certificates");
    if (!trusted.ok()) return trusted;
    // The name in the broker's certificate counts; there is no way around it.
    return status_of(mosquitto_tls_opts_set(client_, 1, "tlsv1.2", nullptr), "TLS");
  }

  base::Status leave_will(const Message& will) {
    return status_of(
        mosquitto_will_set(client_, will.topic.c_str(), static_cast<int>(will.payload.size()),
                           will.payload.data(), 1, true),
        "will");
  }

  void add(Event event) {
    {
      const std::lock_guard<std::mutex> one(mutex_);
      const size_t bytes = waiting_bytes_ + event.message.payload.size();
      const bool full = events_.size() >= kMostWaiting || bytes > kMostWaitingBytes;
      // A message that is dropped was lost, as any may be; what the connection does is not.
      if (event.kind == Event::Kind::kMessage && full) return;
      waiting_bytes_ = bytes;
      events_.push_back(std::move(event));
    }
    came_.notify_one();
  }

  static void on_connect(mosquitto*, void* self, int code) {
    const bool taken = code == 0;
    static_cast<Mosquitto*>(self)->add({taken ? Event::Kind::kConnected : Event::Kind::kLost,
                                        {},
                                        taken ? "" : mosquitto_connack_string(code)});
  }
  static void on_disconnect(mosquitto*, void* self, int code) {
    static_cast<Mosquitto*>(self)->add({Event::Kind::kLost, {}, mosquitto_strerror(code)});
  }
  static void on_message(mosquitto*, void* self, const mosquitto_message* message) {
    if (message->payloadlen < 0 || static_cast<size_t>(message->payloadlen) > kMostPayload) return;
    const auto* const bytes = static_cast<const uint8_t*>(message->payload);
    Event event;
    event.message.topic = message->topic;
    event.message.payload.assign(bytes, bytes + message->payloadlen);
    event.message.retained = message->retain;
    static_cast<Mosquitto*>(self)->add(std::move(event));
  }
  // It may come before publish() knows the number.
  static void on_published(mosquitto*, void* self, int number) {
    auto* const link = static_cast<Mosquitto*>(self);
    const std::lock_guard<std::mutex> one(link->mutex_);
    const auto size = link->sizes_.extract(number);
    if (size.empty()) {
      link->left_early_.insert(number);
    } else {
      link->has_left(size.mapped());
    }
  }

  // With mutex_.
  void has_left(size_t bytes) {
    --leaving_;
    leaving_bytes_ -= bytes;
    left_.notify_all();
  }

  mosquitto* client_ = nullptr;
  std::mutex mutex_;
  std::condition_variable came_;
  std::condition_variable left_;
  std::deque<Event> events_;
  size_t waiting_bytes_ = 0;  // of their payloads
  // Published, and not yet with the broker.
  size_t leaving_ = 0;
  size_t leaving_bytes_ = 0;
  std::map<int, size_t> sizes_;  // by the library's numbers
  std::set<int> left_early_;
};

base::Error no_url(std::string_view url, const char* why) {
  return {Refusal::kUsage, "broker `" + std::string(url) + "`: " + why};
}

bool is_this_machine(const std::string& host) {
  return host == "localhost" || host == "127.0.0.1" || host == "::1";
}

}  // namespace

base::Result<Address> parse_url(std::string_view url) {
  Address out;
  std::string_view rest = url;
  if (rest.starts_with("mqtts://")) {
    rest.remove_prefix(8);
  } else if (rest.starts_with("mqtt://")) {
    rest.remove_prefix(7);
    out.tls = false;
  } else {
    return no_url(url, "write mqtts://HOST or mqtts://HOST:PORT");
  }
  size_t end = rest.find(':');
  if (rest.starts_with('[')) {  // an address of IPv6
    const size_t closed = rest.find(']');
    if (closed == std::string_view::npos) return no_url(url, "`]` is missing");
    out.host = rest.substr(1, closed - 1);
    end = closed + 1 < rest.size() ? closed + 1 : std::string_view::npos;
  } else {
    out.host = rest.substr(0, end);
  }
  if (out.host.empty()) return no_url(url, "it names no host");
  out.port = out.tls ? 8883 : 1883;
  if (end != std::string_view::npos) {
    const std::string_view digits = rest.substr(std::min(end + 1, rest.size()));
    const char* const last = digits.data() + digits.size();
    const auto read = std::from_chars(digits.data(), last, out.port);
    if (rest[end] != ':' || read.ec != std::errc() || read.ptr != last || out.port == 0) {
      return no_url(url, "a port is a number from 1 to 65535");
    }
  }
  if (out.tls || is_this_machine(out.host)) return out;
  return no_url(url, "without TLS only a broker of this machine is talked to; write mqtts://");
}

base::Result<std::unique_ptr<Broker>> connect(const Settings& settings) {
  auto link = std::make_unique<Mosquitto>();
  base::Status begun = link->begin(settings);
  if (!begun.ok()) return begun.error();
  return std::unique_ptr<Broker>(std::move(link));
}

}  // namespace mqtt
