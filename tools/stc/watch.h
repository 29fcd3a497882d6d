// stc build --watch, stc package --watch: stays, and builds again whenever a source is saved
// (workspace/).
#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "tools/common/options.h"
#include "tools/stc/build.h"

namespace stc {

// A build of what was saved.
struct Built {
  using Time = std::chrono::steady_clock::time_point;
  std::string what;  // "1 POU", "everything"
  Time saved;        // the last of the files
  Time seen;
  Time made;  // the image
  const std::vector<frontend::TestCase>* tests = nullptr;  // where the target is for them

  // "built 1 POU in 9 ms" on stderr.
  void print() const;
};

// Where images go.
class WatchTarget {
 public:
  virtual ~WatchTarget() = default;

  enum class Next : uint8_t {
    kWait,       // for the next save
    kBase,       // likewise; base() is this image now
    kOtherBase,  // base() is another one: build against it
    kAgain,      // look and build once more
    kEnd,
  };
  // What images are linked against; null: nothing. It stays until a take() has ended, and after
  // kBase as long as edits are followed.
  virtual std::shared_ptr<const ir::Image> base() const = 0;
  // What there is to say of an image beside what the compiler found; errors keep it from take().
  virtual void check(const ir::Image&, const Project&, base::Diagnostics&) {}
  virtual void check(const std::vector<ResourceVersion>&, const Project&, base::Diagnostics&) {}
  // One resource that was built incrementally.
  virtual base::Result<Next> take(const ir::Image& image, const Project& project,
                                  const Built& built) = 0;
  // Whatever was built from nothing.
  virtual base::Result<Next> take(std::vector<ResourceVersion>& versions, const Project& project,
                                  const Built& built) = 0;
  enum class Rest : uint8_t {
    kOver,   // the time
    kEvent,  // there is something to read from the descriptor
    kEnd,    // nobody wants images any more
  };
  // `descriptor`: -1 for none.
  virtual Rest rest(std::chrono::nanoseconds time, int descriptor);
  // Are the TEST blocks built, instead of what the project runs?
  virtual bool is_for_tests() const { return false; }
};

// Watches the project that the arguments name, until it is ended by a signal or by the target; an
// exit code only then, and when the project cannot be opened at first. Mistakes in sources and
// files that cannot be read are reported, and it goes on. A file that is away is waited for.
int watch(const tools::Options& options, bool move_all, base::DiagnosticFormat format,
          WatchTarget& target);

}  // namespace stc
