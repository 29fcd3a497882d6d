// One resource that is served: state folder, stored program, controller, control channel, and its
// control loop. Opened and started by one thread, run by another, its control thread.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "tools/stvm/controller_service.h"
#include "tools/stvm/event_log.h"
#include "tools/stvm/resource_controller.h"
#include "tools/stvm/state_folder.h"
#include "vm/runtime/file_storage.h"
#include "vm/runtime/mailbox.h"
#include "vm/runtime/realtime.h"

namespace stvm {

// What `stvm serve --trust` brings along.
struct StartTrust {
  std::string path;                                               // of the trust file; "": no keys
  std::map<base::Digest, online_change::SignedFile> images = {};  // signed ones, by their content
};

class ServedResource {
 public:
  // Locks the folder and decides what runs: `given`, or what is stored there; with `create`,
  // nothing where nothing ever was. Notes what is wrong. kFileNotFound: nothing was ever stored.
  // With keys, another image than the one that boots must be signed: what Trust says.
  static base::Result<std::unique_ptr<ServedResource>> open(
      const std::string& directory, const std::string& name,
      const std::optional<ir::VerifiedImage>& given, bool create,
      const std::shared_ptr<LogOutput>& output, const StartTrust& trust);
  ServedResource(const std::string& directory, const std::string& name, StateFolder folder,
                 const std::shared_ptr<LogOutput>& output);
  ~ServedResource();

  const ir::VerifiedImage& program() const { return boot_->image; }
  const std::string& directory() const { return directory_; }
  const std::string& name() const { return name_; }  // "": there is no other

  // The controller with its first scan's state, its service and its socket.
  // `real_clock` is `clock`, or null in virtual time.
  base::Status start(const ResourceController::Settings& settings, vm::Clock& clock,
                     const vm::RealClock* real_clock);
  // Nothing can refuse the start any more: what boots is stored, and the trial goes on or is over.
  // Before run().
  base::Status begin();
  // Makes the calling thread real-time, after start(): it will be the control thread.
  base::Status make_real_time(const vm::RealTimeOptions& options);
  // Until `stop` says so, or somebody asks this resource to; `alive` in each cycle and while it
  // waits. Then instances leave and outputs are safe.
  void run(const std::function<bool()>& stop, const std::function<void()>& alive);
  // After run(), or instead of it: retained values, journal, recording.
  base::Status end();
  // Nobody is served any more, and run() was never called.
  void give_up();

  vm::Controller& controller() { return running_->controller(); }

 private:
  void note(online_change::Event event, std::string text);
  // Who has signed it; empty: nobody has to.
  base::Result<std::string> admit(const std::optional<ir::VerifiedImage>& given,
                                  const StartTrust& trust);
  void idle(const std::function<bool()>& stop, const std::function<void()>& alive);

  std::string directory_;
  std::string name_;
  StateFolder folder_;
  vm::FileStorage storage_;
  online_change::Store store_;
  std::shared_ptr<EventLog> events_;  // threads of devices that hang may outlive this
  std::unique_ptr<Trust> trust_;      // null: without keys
  std::optional<online_change::Boot> boot_;
  bool begun_ = false;  // until then a folder that open() has made goes again
  vm::Clock* clock_ = nullptr;
  const vm::RealClock* real_clock_ = nullptr;  // null: in virtual time
  std::unique_ptr<ResourceController> running_;
  vm::Mailbox mailbox_;
  std::unique_ptr<ControllerService> service_;
  std::unique_ptr<vm::SocketServer> server_;
};

}  // namespace stvm
