#include "vm/io/global_exchange.h"

#include <algorithm>
#include <cstring>
#include <thread>

#include "base/check.h"
#include "vm/io/triple_buffer.h"
#include "vm/runtime/shared_globals.h"

namespace vm {
namespace {

constexpr size_t kNumberBytes = sizeof(uint64_t);  // of the publication, in front of its block

std::string quoted(const std::string& name) { return "`" + name + "`"; }

}  // namespace

// One version of a resource.
struct GlobalExchange::Edition {
  uint32_t number = 0;
  base::Digest version{};
  SharedGlobals globals;
};

// What one version of a resource writes and one version of another reads. `buffer` has one thread
// on each side: the control threads of the two.
struct GlobalExchange::Link {
  Link(const Edition& writer, const Edition& reader);

  uint32_t writer = 0;  // numbers of the editions
  uint32_t reader = 0;
  std::vector<ir::PlainRun> from, to;
  uint32_t bytes = 0;
  struct Fault {
    std::string variable, written_type, read_type;
  };
  std::vector<Fault> faults;             // variables that are not exchanged, though they should
  std::unique_ptr<TripleBuffer> buffer;  // none where there is nothing to exchange
};

GlobalExchange::Link::Link(const Edition& writing, const Edition& reading)
    : writer(writing.number), reader(reading.number) {
  for (const SharedVariable& target : reading.globals.variables()) {
    const SharedVariable* source = writing.globals.find(target.name);
    if (target.written || source == nullptr || !source->written) continue;
    if (source->signature != target.signature) {
      faults.push_back({target.name, source->type, target.type});
      continue;
    }
    from.insert(from.end(), source->runs.begin(), source->runs.end());
    to.insert(to.end(), target.runs.begin(), target.runs.end());
    bytes += target.bytes;
  }
  if (bytes != 0) buffer = std::make_unique<TripleBuffer>(kNumberBytes + bytes);
}

// Immutable: a change of anything makes another one.
struct GlobalExchange::Network {
  using Editions = std::vector<std::shared_ptr<const Edition>>;
  using Links = std::vector<std::shared_ptr<Link>>;

  Link* find(size_t writer, uint32_t writes, size_t reader, uint32_t reads) const {
    for (const std::shared_ptr<Link>& link : links[writer * editions.size() + reader]) {
      if (link->writer == writes && link->reader == reads) return link.get();
    }
    return nullptr;
  }

  std::vector<Editions> editions;  // of each resource: the one that runs, and one beside it
  std::vector<Links> links;        // of each two of them
};

struct GlobalExchange::Member {
  std::string name;
  Network::Editions editions;
  std::atomic<uint32_t> running{0};  // number of its edition
  std::atomic<uint64_t> section{0};  // odd: its control thread uses the network
  // How many blocks its control thread has published.
  uint64_t published = 0;
  std::vector<uint64_t> newest;  // number of the block taken last, by writer
  // For status().
  std::vector<std::atomic<uint64_t>> blocks;
  std::vector<std::atomic<int64_t>> taken_ns;
};

// A control thread inside the network. connect() waits until nobody is inside who may have seen the
// network before: a few copies at most.
class GlobalExchange::Section {
 public:
  Section(Member& member, const std::atomic<const Network*>& network) : member_(member) {
    member_.section.fetch_add(1);
    network_ = network.load();
  }
  ~Section() { member_.section.fetch_add(1); }
  Section(const Section&) = delete;
  Section& operator=(const Section&) = delete;
  const Network& network() const { return *network_; }

 private:
  Member& member_;
  const Network* network_;
};

GlobalExchange::GlobalExchange() = default;
GlobalExchange::~GlobalExchange() = default;

base::Result<std::unique_ptr<GlobalExchange>> GlobalExchange::make(
    const std::vector<Resource>& resources) {
  auto exchange = std::make_unique<GlobalExchange>();
  for (const Resource& resource : resources) {
    auto member = std::make_unique<Member>();
    member->name = resource.name;
    member->newest.resize(resources.size());
    member->blocks = std::vector<std::atomic<uint64_t>>(resources.size());
    member->taken_ns = std::vector<std::atomic<int64_t>>(resources.size());
    exchange->members_.push_back(std::move(member));
  }
  for (size_t i = 0; i < resources.size(); ++i) {
    if (base::Status made = exchange->prepare(i, resources[i].image); !made.ok()) {
      return made.error();
    }
    exchange->members_[i]->running = exchange->members_[i]->editions.back()->number;
  }
  return exchange;
}

base::Status GlobalExchange::check_writers(size_t resource, const Edition& edition) const {
  for (size_t other = 0; other < members_.size(); ++other) {
    if (other == resource) continue;
    for (const auto& theirs : members_[other]->editions) {
      for (const SharedVariable& variable : edition.globals.variables()) {
        const SharedVariable* found = theirs->globals.find(variable.name);
        if (found == nullptr || !variable.written || !found->written) continue;
        return base::Error{base::Refusal::kTwoWriters,
                           quoted(variable.name) + " would be written by RESOURCE " +
                               quoted(members_[resource]->name) + ", but RESOURCE " +
                               quoted(members_[other]->name) + " writes it"};
      }
    }
  }
  return base::Ok{};
}

void GlobalExchange::forget_unused(size_t resource) {
  Member& member = *members_[resource];
  const uint32_t running = member.running;
  std::erase_if(member.editions, [&](const auto& edition) { return edition->number != running; });
}

base::Status GlobalExchange::prepare(size_t resource, const ir::VerifiedImage& version) {
  const std::lock_guard lock(mutex_);
  Member& member = *members_[resource];
  forget_unused(resource);
  const bool runs = !member.editions.empty() && member.editions[0]->version == version.digest();
  base::Status single = base::Ok{};
  if (!runs) {
    auto edition = std::make_shared<const Edition>(
        Edition{++last_number_, version.digest(), SharedGlobals(version.image())});
    single = check_writers(resource, *edition);
    if (single.ok()) member.editions.push_back(std::move(edition));
  }
  connect();
  return single;
}

void GlobalExchange::settle(size_t resource) {
  const std::lock_guard lock(mutex_);
  forget_unused(resource);
  connect();
}

// Links of versions that are still there stay, with what is in them.
void GlobalExchange::connect() {
  const size_t count = members_.size();
  auto next = std::make_unique<Network>();
  for (const auto& member : members_) next->editions.push_back(member->editions);
  next->links.resize(count * count);
  for (size_t writer = 0; writer < count; ++writer) {
    for (size_t reader = 0; reader < count; ++reader) {
      if (writer == reader) continue;
      const size_t at = writer * count + reader;
      for (const auto& writes : next->editions[writer]) {
        for (const auto& reads : next->editions[reader]) {
          std::shared_ptr<Link> link;
          for (const auto& old : owned_ ? owned_->links[at] : Network::Links()) {
            if (old->writer == writes->number && old->reader == reads->number) link = old;
          }
          if (!link) link = std::make_shared<Link>(*writes, *reads);
          next->links[at].push_back(std::move(link));
        }
      }
    }
  }
  network_.store(next.get());
  for (const auto& member : members_) {
    const uint64_t section = member->section.load();
    while (section % 2 != 0 && member->section.load() == section) std::this_thread::yield();
  }
  owned_ = std::move(next);
}

void GlobalExchange::use(size_t resource, const base::Digest& version) {
  Member& member = *members_[resource];
  const Section section(member, network_);
  for (const auto& edition : section.network().editions[resource]) {
    if (edition->version == version) return member.running.store(edition->number);
  }
  base::check(false, "globals of a version are used that were not prepared");
}

void GlobalExchange::take(size_t resource, uint8_t* memory, int64_t now_ns) {
  Member& member = *members_[resource];
  const uint32_t reads = member.running.load();
  const Section section(member, network_);
  for (size_t writer = 0; writer < members_.size(); ++writer) {
    if (writer == resource) continue;
    const uint32_t writes = members_[writer]->running.load();
    Link* link = section.network().find(writer, writes, resource, reads);
    if (link == nullptr || !link->buffer || !link->buffer->take()) continue;
    const uint8_t* block = link->buffer->newest().data();
    uint64_t number = 0;
    std::memcpy(&number, block, kNumberBytes);
    if (number <= member.newest[writer]) continue;  // of before a change that was undone
    member.newest[writer] = number;
    scatter(link->to, block + kNumberBytes, memory);
    member.blocks[writer].fetch_add(1, std::memory_order_relaxed);
    member.taken_ns[writer].store(now_ns, std::memory_order_relaxed);
  }
}

void GlobalExchange::publish(size_t resource, const uint8_t* memory) {
  Member& member = *members_[resource];
  const uint32_t writes = member.running.load();
  const Section section(member, network_);
  ++member.published;
  for (size_t reader = 0; reader < members_.size(); ++reader) {
    if (reader == resource) continue;
    const uint32_t reads = members_[reader]->running.load();
    Link* link = section.network().find(resource, writes, reader, reads);
    if (link == nullptr || !link->buffer) continue;
    uint8_t* block = link->buffer->work().data();
    std::memcpy(block, &member.published, kNumberBytes);
    gather(link->from, memory, block + kNumberBytes);
    link->buffer->publish();
  }
}

// What is wrong between two versions, as the one says that has the number `mine`.
std::vector<std::string> GlobalExchange::faults(size_t resource, uint32_t mine,
                                                size_t other) const {
  std::vector<std::string> texts;
  const uint32_t theirs = members_[other]->running;
  const auto add = [&](const Link* link, bool reads) {
    if (link == nullptr) return;
    for (const Link::Fault& fault : link->faults) {
      const std::string& here = reads ? fault.read_type : fault.written_type;
      const std::string& there = reads ? fault.written_type : fault.read_type;
      const std::string types = here == there
                                    ? " is another " + here + " in RESOURCE "
                                    : " is " + here + " here and " + there + " in RESOURCE ";
      texts.push_back(quoted(fault.variable) + types + quoted(members_[other]->name) +
                      (reads ? "" : ", which reads it") +
                      ": not exchanged until both are the same");
    }
  };
  add(owned_->find(other, theirs, resource, mine), true);
  add(owned_->find(resource, mine, other, theirs), false);
  return texts;
}

std::vector<DeviceStatus> GlobalExchange::status(size_t resource, int64_t now_ns) const {
  const std::lock_guard lock(mutex_);
  const Member& member = *members_[resource];
  const uint32_t running = member.running;
  std::vector<DeviceStatus> rows;
  for (size_t other = 0; other < members_.size(); ++other) {
    if (other == resource) continue;
    const Link* link = owned_->find(other, members_[other]->running, resource, running);
    const std::vector<std::string> now = faults(resource, running, other);
    DeviceStatus row{members_[other]->name, "resource", "online", 0, now.size(), -1, {}};
    if ((link != nullptr && link->buffer) || !now.empty()) {
      row.exchanges = member.blocks[other].load(std::memory_order_relaxed);
      const int64_t taken_ns = member.taken_ns[other].load(std::memory_order_relaxed);
      if (row.exchanges != 0) row.age_ns = now_ns - taken_ns;
      if (row.exchanges == 0) row.state = "waiting";
      if (!now.empty()) row.error = now.front();
      if (now.size() > 1) row.error += " (and " + std::to_string(now.size() - 1) + " more)";
      rows.push_back(row);
    }
    for (const auto& edition : member.editions) {
      if (edition->number <= running) continue;  // it runs, or undo would bring it back
      for (std::string& text : faults(resource, edition->number, other)) {
        if (std::find(now.begin(), now.end(), text) != now.end()) continue;
        rows.push_back({row.name, row.driver, kStagedState, 0, 1, -1, std::move(text)});
      }
    }
  }
  return rows;
}

base::Status ResourcePort::prepare(const ir::VerifiedImage& version) {
  base::Status prepared = exchange_.prepare(resource_, version);
  return prepared.ok() ? devices_.prepare(version) : prepared;
}

void ResourcePort::use(const base::Digest& version) {
  exchange_.use(resource_, version);
  devices_.use(version);
}

void ResourcePort::settle() {
  exchange_.settle(resource_);
  devices_.settle();
}

std::vector<DeviceStatus> ResourcePort::status() const {
  std::vector<DeviceStatus> rows = devices_.status();
  for (DeviceStatus& row : exchange_.status(resource_, clock_.now_ns())) {
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace vm
