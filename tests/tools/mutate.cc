// Makes the mistakes of tests/mutate/mutations.txt, one at a time, in a copy of the sources, builds
// what its tests need and runs them: a mistake that they leave green survives, and that is a hole
// in the tests. What the list looks like stands at its head.
//
// usage: mutate LIST SOURCE_DIR                    only checks that the list follows the code
//        mutate LIST SOURCE_DIR WORK_DIR [PART...] makes those whose name or file has a PART in it
#include <fnmatch.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

namespace {

namespace fs = std::filesystem;

// A mutation may make a test run for ever: it gets these seconds, and some times what it takes
// without one on this machine, however busy that is.
constexpr double kTestSeconds = 300;
constexpr double kUsualTimes = 3;
constexpr double kUnchangedSeconds = 7200;

struct Seen {  // by these tests, each of which must fail
  std::string ctest;
  std::string filter;  // GTEST_FILTER; "": the whole program
};

struct Mutation {
  int line = 0;  // in the list
  std::string name;
  std::string file;
  std::vector<Seen> seen;
  std::string before;
  std::string after;
  std::string equivalent;  // why no test can see it; "": one must
};

[[noreturn]] void end(const std::string& text) {
  std::fprintf(stderr, "mutate: %s\n", text.c_str());
  std::exit(2);
}

std::string read_file(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) end("cannot read " + path.string());
  return {std::istreambuf_iterator<char>(in), {}};
}

void write_file(const fs::path& path, const std::string& text) {
  std::ofstream out(path, std::ios::binary | std::ios::trunc);
  out << text;
  if (!out.flush()) end("cannot write " + path.string());
}

// --- the list ---------------------------------------------------------------------

void add_line(std::string& text, bool& begun, const std::string& line) {
  if (begun) text += '\n';
  begun = true;
  text += line;
}

std::vector<Mutation> read_list(const std::string& path) {
  std::vector<Mutation> all;
  std::istringstream in(read_file(path));
  bool before = false;
  bool after = false;
  int number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    if (line.empty() || line[0] == '#') continue;
    const bool detail = line.starts_with("  ");
    if (!detail && line[0] != '-' && line[0] != '+') {
      all.push_back({number, line, {}, {}, {}, {}, {}});
      before = after = false;
      continue;
    }
    if (all.empty()) end("the list begins without a name");
    Mutation& one = all.back();
    std::istringstream words(line);
    std::string key;
    if (line[0] == '-') {
      add_line(one.before, before, line.substr(1));
    } else if (line[0] == '+') {
      add_line(one.after, after, line.substr(1));
    } else if (words >> key; key == "in") {
      words >> one.file;
    } else if (key == "seen-by") {
      Seen seen;
      words >> seen.ctest >> seen.filter;
      one.seen.push_back(seen);
    } else if (key == "equivalent") {
      std::getline(words >> std::ws, one.equivalent);
    } else {
      end("line " + std::to_string(number) + " of the list: `" + key + "` is not known");
    }
  }
  return all;
}

// What is built for it: a target, or several with blanks between them.
std::string target_of(const std::string& ctest) {
  if (ctest.starts_with("unit_")) {
    const std::string name = ctest.substr(5);
    return "test_" + (name.ends_with("_standby") ? name.substr(0, name.size() - 8) : name);
  }
  if (ctest.starts_with("cli_"))
    return "stc stvm golden shared_memory_client";  // what its script runs
  return ctest.substr(0, ctest.find('_'));          // golden_change: golden
}

// Suite.Name of the tests in the folder that the program is made of.
std::vector<std::string> tests_of(const fs::path& root, const std::string& ctest) {
  static const std::regex kTest(R"(\nTEST(?:_F|_P)?\(\s*(\w+),\s*(\w+)\))");
  std::vector<std::string> names;
  const fs::path folder = root / "tests/unit" / target_of(ctest).substr(5);
  if (!fs::is_directory(folder)) return names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".cc") continue;
    const std::string text = read_file(entry.path());
    for (std::sregex_iterator at(text.begin(), text.end(), kTest), last; at != last; ++at) {
      names.push_back((*at)[1].str() + "." + (*at)[2].str());
    }
  }
  return names;
}

bool matches_any(const std::string& filter, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    if (fnmatch(filter.c_str(), name.c_str(), 0) == 0) return true;
  }
  return false;
}

size_t occurrences(const std::string& text, const std::string& part) {
  size_t count = 0;
  for (size_t at = 0; (at = text.find(part, at)) != std::string::npos; ++at) ++count;
  return count;
}

// "" or what is wrong.
std::string complaint(const Mutation& one, const fs::path& root) {
  if (one.file.empty() || one.seen.empty()) return "it needs `in` and `seen-by`";
  if (one.before.empty() || one.before == one.after) return "it changes nothing";
  if (!fs::is_regular_file(root / one.file)) return "there is no " + one.file;
  const size_t count = occurrences(read_file(root / one.file), one.before);
  if (count != 1) {
    return "its text occurs " + std::to_string(count) + " times in " + one.file + ", not once";
  }
  static const std::regex kRequirement("([A-EVX][0-9]+|case[0-9]+) .*");
  std::smatch requirement;
  bool named = !std::regex_match(one.name, requirement, kRequirement);
  for (const Seen& seen : one.seen) {
    static const std::regex kPlain("[A-Za-z0-9_.*]*");
    if (!std::regex_match(seen.filter, kPlain)) return "a filter is one name with `*`";
    if (!named) named = seen.filter.find(requirement[1].str()) != std::string::npos;
    if (!seen.ctest.starts_with("unit_") || seen.filter.empty()) continue;
    if (!matches_any(seen.filter, tests_of(root, seen.ctest))) {
      return "no test of " + seen.ctest + " is called " + seen.filter;
    }
  }
  return named ? "" : "no test that it names has its requirement in the name";
}

bool check(const std::vector<Mutation>& all, const fs::path& root) {
  bool good = !all.empty();
  std::set<std::string> names;
  for (const Mutation& one : all) {
    std::string why = complaint(one, root);
    if (!names.insert(one.name).second) why = "there are two of that name";
    if (why.empty()) continue;
    std::printf("line %d: `%s`: %s\n", one.line, one.name.c_str(), why.c_str());
    good = false;
  }
  std::printf("%zu mutations, the list %s the code\n", all.size(),
              good ? "follows" : "does not follow");
  return good;
}

// --- the copy ---------------------------------------------------------------------

bool is_left_out(const fs::path& relative) {
  const std::string first = relative.begin()->string();
  return first == "build" || first == ".git";
}

// What is the same already keeps its time, so that nothing is built again for it.
void copy_tree(const fs::path& from, const fs::path& to) {
  std::set<fs::path> there;
  for (auto at = fs::recursive_directory_iterator(from); at != fs::recursive_directory_iterator();
       ++at) {
    const fs::path relative = fs::relative(at->path(), from);
    if (is_left_out(relative)) {
      at.disable_recursion_pending();
      continue;
    }
    there.insert(relative);
    const fs::path copy = to / relative;
    if (at->is_directory()) {
      fs::create_directories(copy);
    } else if (!fs::exists(copy) || read_file(copy) != read_file(at->path())) {
      fs::create_directories(copy.parent_path());
      fs::copy_file(at->path(), copy, fs::copy_options::overwrite_existing);
    }
  }
  std::vector<fs::path> gone;
  for (auto at = fs::recursive_directory_iterator(to); at != fs::recursive_directory_iterator();
       ++at) {
    const fs::path relative = fs::relative(at->path(), to);
    if (is_left_out(relative)) {
      at.disable_recursion_pending();
    } else if (!there.contains(relative)) {
      gone.push_back(at->path());
    }
  }
  for (const fs::path& path : gone) fs::remove_all(path);
}

// --- build and run ----------------------------------------------------------------

enum class Outcome { kKilled, kHangs, kSurvived, kDoesNotCompile };

const char* text_of(Outcome outcome) {
  constexpr const char* kTexts[] = {"killed", "killed (it hangs)", "SURVIVED", "DOES NOT COMPILE"};
  return kTexts[static_cast<size_t>(outcome)];
}

double seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

class Workshop {
 public:
  Workshop(const fs::path& source, const fs::path& work)
      : copy_(work), build_(work / "build/release"), log_(work / "build/log.txt") {
    fs::create_directories(build_);
    copy_tree(source, copy_);
    if (!run("cd " + quoted(copy_) + " && cmake --preset release")) {
      end("the copy cannot be configured: " + log_.string());
    }
  }

  // Tests that fail without any mutation, or that are skipped, see nothing.
  void check_unchanged(const std::vector<Mutation>& all) {
    std::set<std::string> targets;
    std::set<std::pair<std::string, std::string>> tests;
    for (const Mutation& one : all) {
      for (const Seen& seen : one.seen) {
        targets.insert(target_of(seen.ctest));
        tests.insert({seen.ctest, seen.filter});
      }
    }
    if (!build(targets)) end("the copy cannot be built: " + log_.string());
    std::printf("unchanged: %zu tests of %zu targets\n", tests.size(), targets.size());
    std::fflush(stdout);
    static const std::regex kPassed(R"(\[  PASSED  \] [1-9])");
    for (const auto& [ctest, filter] : tests) {
      const std::string name = ctest + " " + filter;
      const double from = seconds();
      const bool green = test({ctest, filter}, kUnchangedSeconds);
      usual_[ctest + filter] = seconds() - from;
      if (!green) end(name + " fails without any mutation: " + log_.string());
      if (!ctest.starts_with("unit_")) continue;
      if (!std::regex_search(read_file(log_), kPassed)) end(name + " runs no test here");
    }
  }

  Outcome make(const Mutation& one) {
    if (mutated_ != one.file) {
      if (!mutated_.empty()) restore();
      mutated_ = one.file;
      original_ = read_file(copy_ / one.file);
    }
    std::string text = original_;
    const size_t at = text.find(one.before);
    if (at == std::string::npos) end(one.file + " was changed while it was copied: start again");
    text.replace(at, one.before.size(), one.after);
    write_file(copy_ / one.file, text);
    std::set<std::string> targets;
    for (const Seen& seen : one.seen) targets.insert(target_of(seen.ctest));
    if (!build(targets)) return Outcome::kDoesNotCompile;
    bool hangs = false;
    for (const Seen& seen : one.seen) {
      const double patience = kTestSeconds + kUsualTimes * usual_[seen.ctest + seen.filter];
      if (test(seen, patience)) return Outcome::kSurvived;
      hangs = hangs || read_file(log_).find("***Timeout") != std::string::npos;
    }
    return hangs ? Outcome::kHangs : Outcome::kKilled;
  }

  void restore() { write_file(copy_ / mutated_, original_); }

 private:
  static std::string quoted(const fs::path& path) { return "'" + path.string() + "'"; }

  bool run(const std::string& command) const {
    return std::system((command + " >" + quoted(log_) + " 2>&1").c_str()) == 0;
  }

  bool build(const std::set<std::string>& targets) const {
    std::string command = "cmake --build " + quoted(build_) + " -j " +
                          std::to_string(std::thread::hardware_concurrency()) + " --target";
    for (const std::string& target : targets) command += " " + target;
    return run(command);
  }

  bool test(const Seen& seen, double patience) const {
    return run("GTEST_FILTER='" + (seen.filter.empty() ? "*" : seen.filter) +
               "' ctest --test-dir " + quoted(build_) + " -V --no-tests=error --timeout " +
               std::to_string(patience) + " -R '^" + seen.ctest + "$'");
  }

  const fs::path copy_;
  const fs::path build_;
  const fs::path log_;
  std::string mutated_;
  std::string original_;                 // as copied: the sources may change meanwhile
  std::map<std::string, double> usual_;  // seconds of each test without any mutation
};

bool is_chosen(const Mutation& one, const std::vector<std::string>& parts) {
  for (const std::string& part : parts) {
    if ((one.name + "\n" + one.file).find(part) != std::string::npos) return true;
  }
  return parts.empty();
}

int make_all(const std::vector<Mutation>& all, const fs::path& source, const fs::path& work) {
  const double begin = seconds();
  Workshop workshop(source, work);
  workshop.check_unchanged(all);
  std::printf("unchanged: all green, %.0f s\n", seconds() - begin);
  std::fflush(stdout);
  size_t killed = 0;
  size_t bad = 0;
  for (const Mutation& one : all) {
    const double from = seconds();
    const Outcome outcome = workshop.make(one);
    const bool dead = outcome == Outcome::kKilled || outcome == Outcome::kHangs;
    const bool right = one.equivalent.empty() ? dead : outcome == Outcome::kSurvived;
    killed += dead;
    bad += !right;
    const std::string note = one.equivalent.empty() ? "" : " (listed as equivalent)";
    std::printf("%-17s %4.0f s  %s: %s%s\n", text_of(outcome), seconds() - from, one.file.c_str(),
                one.name.c_str(), note.c_str());
    std::fflush(stdout);
  }
  if (!all.empty()) workshop.restore();
  std::printf("%zu of %zu mutations killed, %zu not as they should be, %.0f s\n", killed,
              all.size(), bad, seconds() - begin);
  return bad == 0 ? 0 : 1;
}

}  // namespace

int main(int count, char** words) {
  if (count < 3) end("usage: mutate LIST SOURCE_DIR [WORK_DIR [PART...]]");
  const std::vector<Mutation> all = read_list(words[1]);
  const fs::path source = fs::absolute(words[2]);
  if (!check(all, source)) return 1;
  if (count == 3) return 0;
  const std::vector<std::string> parts(words + 4, words + count);
  std::vector<Mutation> chosen;
  for (const Mutation& one : all) {
    if (is_chosen(one, parts)) chosen.push_back(one);
  }
  if (chosen.empty()) end("no mutation has such a name");
  return make_all(chosen, source, fs::absolute(words[3]));
}
