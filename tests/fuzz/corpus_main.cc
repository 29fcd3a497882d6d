// Runs a fuzz target without libFuzzer: every file of a corpus as it is, then
// `count` mutations of them. The same seed gives the same inputs everywhere.
//   FUZZER CORPUS_DIR [COUNT] [SEED]
#include <algorithm>
#include <cctype>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);

namespace {

constexpr size_t kMaxInput = 8192;

// splitmix64: tiny, and the same on every machine.
class Random {
 public:
  explicit Random(uint64_t seed) : state_(seed) {}
  size_t below(size_t limit) { return limit == 0 ? 0 : next() % limit; }

 private:
  uint64_t next() {
    uint64_t z = state_ += 0x9E3779B97F4A7C15u;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
  }
  uint64_t state_;
};

std::vector<std::string> read_corpus(const std::string& folder) {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    bool code = entry.path().extension() == ".cc" || entry.path().extension() == ".h";
    if (entry.is_regular_file() && !code) paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  std::vector<std::string> out;
  for (const auto& path : paths) {
    std::ifstream in(path, std::ios::binary);
    out.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  }
  return out;
}

void flip(std::string& text, Random& random) {
  if (!text.empty()) text[random.below(text.size())] ^= static_cast<char>(1 << random.below(8));
}

void set_byte(std::string& text, Random& random) {
  if (!text.empty()) text[random.below(text.size())] = static_cast<char>(random.below(256));
}

void erase(std::string& text, Random& random) {
  size_t at = random.below(text.size() + 1);
  text.erase(at, 1 + random.below(16));
}

void repeat(std::string& text, Random& random) {
  size_t at = random.below(text.size() + 1);
  std::string piece = text.substr(at, 1 + random.below(24));
  for (size_t n = 1 + random.below(64); n != 0; --n) text.insert(at, piece);
}

void splice(std::string& text, const std::string& other, Random& random) {
  size_t from = random.below(other.size() + 1);
  text.insert(random.below(text.size() + 1), other, from, 1 + random.below(64));
}

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

// A word and where it begins; empty when there is none behind `at`.
std::pair<size_t, std::string> word_behind(const std::string& text, size_t at) {
  while (at < text.size() && is_word(text[at])) ++at;
  while (at < text.size() && !is_word(text[at])) ++at;
  size_t end = at;
  while (end < text.size() && is_word(text[end])) ++end;
  return {at, text.substr(at, end - at)};
}

// One word of the text in another's place: what stays a program reaches the later phases.
void replace_word(std::string& text, const std::string& other, Random& random) {
  auto [at, word] = word_behind(text, random.below(text.size() + 1));
  auto [from, by] = word_behind(other, random.below(other.size() + 1));
  if (!word.empty() && !by.empty()) text.replace(at, word.size(), by);
}

std::string mutated(const std::vector<std::string>& corpus, Random& random) {
  std::string text = corpus[random.below(corpus.size())];
  for (size_t steps = 1 + random.below(6); steps != 0; --steps) {
    switch (random.below(10)) {
      case 6:
      case 7:
      case 8:
        replace_word(text, text, random);
        break;
      case 9:
        replace_word(text, corpus[random.below(corpus.size())], random);
        break;
      case 0:
        flip(text, random);
        break;
      case 1:
        set_byte(text, random);
        break;
      case 2:
        erase(text, random);
        break;
      case 3:
        repeat(text, random);
        break;
      case 4:
        splice(text, corpus[random.below(corpus.size())], random);
        break;
      default:
        text.resize(random.below(text.size() + 1));
    }
    if (text.size() > kMaxInput) text.resize(kMaxInput);
  }
  return text;
}

const std::string* running = nullptr;
std::string failing;  // file for the input that ended the process; others may run beside it

// The input that ended the process goes where it can be looked at.
void keep_input(int signal) {
  if (std::FILE* file = std::fopen(failing.c_str(), "wb")) {
    std::fwrite(running->data(), 1, running->size(), file);
    std::fclose(file);
    std::fprintf(stderr, "the input is in %s\n", failing.c_str());
  }
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

void run(const std::string& text) {
  running = &text;
  LLVMFuzzerTestOneInput(reinterpret_cast<const uint8_t*>(text.data()), text.size());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: %s CORPUS_DIR [COUNT] [SEED]\n", argv[0]);
    return 2;
  }
  std::vector<std::string> corpus = read_corpus(argv[1]);
  size_t count = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1000;
  Random random(argc > 3 ? std::strtoull(argv[3], nullptr, 10) : 1);
  if (corpus.empty()) {
    std::fprintf(stderr, "%s: no files\n", argv[1]);
    return 2;
  }
  const std::string name = std::filesystem::path(argv[0]).filename();
  failing = name + ".failing_input";
  for (int signal : {SIGABRT, SIGSEGV, SIGFPE, SIGALRM}) std::signal(signal, keep_input);
  for (const std::string& text : corpus) run(text);
  for (size_t i = 0; i < count; ++i) run(mutated(corpus, random));
  std::printf("%s: %zu corpus files, %zu mutations, no failure\n", name.c_str(), corpus.size(),
              count);
  return 0;
}
