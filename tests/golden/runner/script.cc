#include "tests/golden/runner/script.h"

#include <map>
#include <sstream>

namespace golden {
namespace {

std::string folded(std::string name) {
  for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return name;
}

// "path=value" lines as a table; a name without program part need not be unique.
class StateTable {
 public:
  explicit StateTable(const std::string& state) {
    std::istringstream stream(state);
    for (std::string line; std::getline(stream, line);) {
      size_t equals = line.find('=');
      values_[folded(line.substr(0, equals))] = line.substr(equals + 1);
    }
  }
  std::string show(const std::string& name) const {
    auto found = values_.find(folded(name));
    return name + "=" + (found == values_.end() ? kNoSuchVariable : found->second);
  }

 private:
  std::map<std::string, std::string> values_;
};

std::string show_all(const std::string& state, const std::vector<std::string>& names) {
  StateTable table(state);
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "" : " ") + table.show(name);
  return out;
}

class Runner {
 public:
  Runner(const TestFile& test, const std::vector<Program>& versions, Engine& engine)
      : test_(test), versions_(versions), engine_(engine) {
    out_.outputs.resize(test.steps.size());
    out_.scans.resize(test.scans.size());
  }

  base::Result<Transcript> run() {
    run_scans(std::stoull(test_.option("--scans", "0")), out_.outputs[0]);
    for (size_t i = 1; i < test_.steps.size() && !failed_; ++i) command(i);
    if (failed_) return error_;
    return std::move(out_);
  }

 private:
  void fail(base::Error error) {
    failed_ = true;
    error_ = std::move(error);
  }

  void run_scans(uint64_t count, std::vector<std::string>& output) {
    for (uint64_t i = 0; i < count && !stopped_ && !failed_; ++i) {
      base::Result<std::string> trap = engine_.scan();
      if (!trap.ok()) return fail(trap.error());
      ++scan_;
      std::string state = engine_.state();
      note_scan(state);
      out_.states.push_back(std::move(state));
      if (trap->empty()) continue;
      output.push_back("TRAP scan " + std::to_string(scan_) + ": " + *trap);
      stopped_ = true;
    }
  }

  void note_scan(const std::string& state) {
    for (size_t i = 0; i < test_.scans.size(); ++i) {
      if (test_.scans[i].scan == scan_) out_.scans[i] = show_all(state, test_.scans[i].names);
    }
  }

  void command(size_t index) {
    std::istringstream stream(test_.steps[index].command);
    std::string verb;
    stream >> verb;
    std::vector<std::string> args;
    for (std::string arg; stream >> arg;) args.push_back(arg);
    std::vector<std::string>& output = out_.outputs[index];
    if (verb == "run" && args.size() == 1) {
      run_scans(std::stoull(args[0]), output);
    } else if (verb == "show") {
      output.push_back(show_all(engine_.state(), args));
    } else if (verb == "set" && args.size() == 2) {
      note(engine_.set(args[0], args[1]), output);
    } else if (verb == "force" && args.size() == 2) {
      note(engine_.force(args[0], args[1]), output);
    } else if (verb == "unforce" && args.size() == 1) {
      note(engine_.unforce(args[0]), output);
    } else if (verb == "forces") {
      output = engine_.forces();
    } else if (verb == "change" && !args.empty()) {
      change(args, output);
    } else if (verb == "undo") {
      undo(!args.empty() && args[0] == "--allow-loss", output);
    } else if (verb == "restart" && args.size() == 1) {
      restart(args[0], output);
    } else if (verb == "accept") {
      note(engine_.accept(), output);
    } else {
      fail({base::Refusal::kUsage, "script: `" + test_.steps[index].command + "`"});
    }
  }

  // All tasks run again, also after a trap.
  void restart(const std::string& kind, std::vector<std::string>& output) {
    constexpr const char* kKinds[] = {"cold", "warm", "hot"};
    for (size_t i = 0; i < std::size(kKinds); ++i) {
      if (kind != kKinds[i]) continue;
      stopped_ = false;
      return note(engine_.restart(static_cast<Engine::Restart>(i)), output);
    }
    fail({base::Refusal::kUsage, "script: restart cold, warm or hot"});
  }

  void note(const base::Status& status, std::vector<std::string>& output) {
    if (!status.ok()) output.push_back("refused " + base::to_string(status.error()));
  }

  void change(const std::vector<std::string>& args, std::vector<std::string>& output) {
    size_t version = std::stoull(args[0]);
    if (version < 1 || version > versions_.size()) {
      return fail({base::Refusal::kUsage, "script: no version " + args[0]});
    }
    bool allow_loss = args.size() > 1 && args[1] == "--allow-loss";
    auto lines = engine_.change(versions_[version - 1], allow_loss);
    if (lines.ok()) {
      output.insert(output.end(), lines->begin(), lines->end());
    } else {
      output.push_back("refused " + base::to_string(lines.error()));
    }
  }

  void undo(bool allow_loss, std::vector<std::string>& output) {
    auto lines = engine_.undo(allow_loss);
    if (!lines.ok()) return note(lines.error(), output);
    output.insert(output.end(), lines->begin(), lines->end());
  }

  const TestFile& test_;
  const std::vector<Program>& versions_;
  Engine& engine_;
  Transcript out_;
  uint64_t scan_ = 0;
  bool stopped_ = false;
  bool failed_ = false;
  base::Error error_{base::Refusal::kInternal, {}};
};

}  // namespace

base::Result<Transcript> run_script(const TestFile& test, const std::vector<Program>& versions,
                                    Engine& engine) {
  return Runner(test, versions, engine).run();
}

}  // namespace golden
