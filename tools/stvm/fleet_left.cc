#include "tools/stvm/fleet_left.h"

#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include "base/joined.h"
#include "tools/common/files.h"
#include "tools/common/toml.h"
#include "tools/stvm/fleet_broker.h"

namespace stvm {
namespace {

// "# change 9c4c..."; empty: it is not such a line.
std::string verb_in(const std::string& text, const base::Digest& digest) {
  const std::string_view line = std::string_view(text).substr(0, text.find('\n'));
  if (!line.starts_with("# ")) return {};
  const size_t blank = line.find(' ', 2);
  if (blank == std::string_view::npos || line.substr(blank + 1) != base::to_hex(digest)) return {};
  return std::string(line.substr(2, blank - 2));
}

// A folder is meant wherever the next run begins.
std::string place_text(const FleetMember& member) {
  if (is_at_agent(member)) return "agent = " + tools::toml_quoted(member.place);
  if (!is_at_folder(member)) return "host = " + tools::toml_quoted(member.place);
  std::error_code error;
  const std::filesystem::path whole = std::filesystem::absolute(member.place, error);
  return "dir = " + tools::toml_quoted(error ? member.place : whole.string());
}

}  // namespace

base::Result<std::string> FleetLeft::read(std::vector<FleetMember>& members) const {
  const auto nobody = [&](const char* why) {
    return base::Error{base::Refusal::kNothingToUndo,
                       base::joined({"there is no run to continue: ", path_, why})};
  };
  if (!tools::is_there(path_)) return nobody(" is not there");
  base::Result<std::string> text = tools::read_text(path_);
  if (!text.ok()) return text.error();
  const std::string verb = verb_in(*text, digest_);
  if (verb.empty()) return nobody(" is of another fleet file");
  base::Result<std::vector<FleetMember>> listed = read_fleet_list(path_);
  if (!listed.ok()) return listed.error();
  members = std::move(*listed);
  return verb;
}

void FleetLeft::begin(const std::string& verb, const std::vector<FleetMember>& members) {
  std::vector<FleetMember> before;
  const base::Result<std::string> earlier = read(before);
  verb_ = verb;
  left_ = members;
  if (broker_.empty() && earlier.ok()) {
    const base::Result<FleetBroker> kept = read_broker(path_);
    if (kept.ok()) broker_ = broker_text(*kept);
  }
  for (FleetMember& member : before) {
    const bool again = std::any_of(members.begin(), members.end(),
                                   [&](const FleetMember& one) { return one.name == member.name; });
    if (!again && earlier.ok() && *earlier == verb) left_.push_back(std::move(member));
  }
  write();
}

void FleetLeft::visited(const FleetMember& member, bool good) {
  if (!good) return;
  std::erase_if(left_, [&](const FleetMember& one) { return one.name == member.name; });
  write();
}

void FleetLeft::write() {
  if (left_.empty()) {
    (void)::unlink(path_.c_str());
    return;
  }
  std::string text = base::joined({"# ", verb_, " ", base::to_hex(digest_), "\n", broker_});
  size_t number = 0;
  for (const FleetMember& member : left_) {
    text += base::joined({"[controllers.", std::to_string(++number), "]\nname = ",
                          tools::toml_quoted(member.name), "\n", place_text(member), "\n"});
    if (member.allow_loss) text += "allow_loss = true\n";
  }
  base::Status written = tools::write_file(
      path_, base::ByteSpan(reinterpret_cast<const uint8_t*>(text.data()), text.size()));
  complaint_ = written.ok() ? "" : written.error().text;
}

}  // namespace stvm
