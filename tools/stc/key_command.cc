// stc key: keys are made, files are signed, and signatures are checked (F-03).
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>

#include "base/nearest_name.h"
#include "ir/bytecode/image.h"
#include "online_change/package/fleet_file.h"
#include "online_change/package/package.h"
#include "tools/common/descriptor.h"
#include "tools/common/files.h"
#include "tools/common/json.h"
#include "tools/common/trust_file.h"
#include "tools/common/utc_time.h"
#include "tools/stc/commands.h"
#ifdef STC_HAS_KEYS
#include "adapters/keys/keys.h"
#endif

namespace stc {
namespace {

using online_change::SignedKind;
using online_change::Statement;

constexpr int64_t kDaySeconds = 86400;
constexpr uint64_t kMostDays = 36525;
constexpr uint64_t kMostKeyBytes = 1 << 16;
constexpr const char* kRevokedPlan = "revoked";

constexpr tools::OptionRow kKeyOptions[] = {
    {"--output|-o", "FILE", "new: the private key; sign, revoke: the signed file (required)"},
    {"--key", "FILE", "sign, revoke: the private key to sign with"},
    {"--trust", "KEYS", "verify, revoke: the trust file"},
    {"--until", "TIME", "UTC: 2026-03-01 or 2026-03-01T08:00:00Z", "", "--days"},
    {"--days", "N", "the same in days from now (default: 7 for signatures; keys have no end)"},
    {"--plan", "NAME", "sign: the plan that it belongs to (default: one of the key's own)"},
    {"--sequence", "N", "sign: its place in the plan (default: the time in ns)"},
    {"--target", "NAME", "sign: the only controller that takes it (default: any)"},
    {"--revokes", nullptr, "new: the key is for lists of revoked keys"},
    tools::kFormatOption,
};
constexpr tools::Command kKeyCommand{
    "key", "new NAME | sign FILE | verify FILE | revoke KEY...",
    "Makes keys, signs images, packages and fleet files, checks signatures, revokes keys.",
    kKeyOptions, 2};

#ifdef STC_HAS_KEYS

base::Error usage(const std::string& text) { return {base::Refusal::kUsage, "key: " + text}; }

bool wants_json(const tools::Options& options) { return options.text("--format") == "json"; }

void time_field(tools::JsonWriter& json, const char* name, int64_t time_s) {
  json.key(name);
  time_s == INT64_MAX ? json.null() : json.value(tools::utc_text(time_s));
}

// What `new` has made, for those who do not take the lines of a trust file.
std::string json_of(const tools::TrustedKey& key, const std::string& file,
                    const std::string& lines) {
  tools::JsonWriter json;
  json.begin_object().field("file", file).field("name", key.name);
  json.field("key", base::to_hex(key.key)).field("revokes", key.revokes);
  time_field(json, "until", key.until_s);
  json.field("trust", lines).end_object();
  return json.finish();
}

// What a signed file says. `signer`: "" when nobody was asked for a name.
std::string json_of(const Statement& statement, const std::string& file,
                    const std::string& signer) {
  tools::JsonWriter json;
  json.begin_object().field("file", file);
  json.field("kind", online_change::signed_kind_name(statement.kind));
  json.field("bytes", statement.size).field("content", base::to_hex(statement.content));
  json.field("key", base::to_hex(statement.key)).key("signer");
  signer.empty() ? json.null() : json.value(signer);
  json.field("plan", statement.plan).field("sequence", statement.sequence);
  time_field(json, "until", statement.expires_s);
  json.key("target");
  statement.target.empty() ? json.null() : json.value(statement.target);
  json.end_object();
  return json.finish();
}

int64_t now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}
int64_t now_s() { return now_ns() / 1'000'000'000; }

// By --until, or --days, or `otherwise` days.
base::Result<int64_t> end_time(const tools::Options& options, uint64_t otherwise) {
  if (options.has("--until")) {
    const std::optional<int64_t> time = tools::parse_utc(options.text("--until"));
    if (time) return *time;
    return usage("--until is a time such as 2026-03-01 or 2026-03-01T08:00:00Z");
  }
  base::Result<uint64_t> days = options.number("--days", otherwise);
  if (!days.ok()) return days.error();
  if (*days == 0 || *days > kMostDays) return usage("--days is 1 to 36525");
  return now_s() + static_cast<int64_t>(*days) * kDaySeconds;
}

base::Status require(const tools::Options& options, const char* option) {
  if (options.has(option)) return base::Ok{};
  return usage("`" + options.arguments()[0] + "` needs " + option);
}

// A new file that only its owner can read.
base::Status write_private(const std::string& path, std::string_view text) {
  constexpr int kNew = O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC;
  const tools::Descriptor file(::open(path.c_str(), kNew, 0600));
  if (file.fd >= 0) return tools::write_all(file.fd, path, base::as_bytes(text));
  const bool is_there = errno == EEXIST;
  return base::Error{base::Refusal::kFileUnwritable,
                     path + ": " +
                         (is_there ? "is there already, and may be a key that is used; "
                                     "name another file"
                                   : std::strerror(errno))};
}

// Whoever can read it can sign.
base::Result<std::string> read_private(const std::string& path) {
  struct stat about {};
  const bool known = ::stat(path.c_str(), &about) == 0;
  if (known && S_ISREG(about.st_mode) && (about.st_mode & 077) != 0) {
    return base::Error{base::Refusal::kBadKeys,
                       path +
                           ": others can read or write this private key; chmod 600 it, or make "
                           "another key if they may have done so"};
  }
  return tools::read_text(path, kMostKeyBytes);
}

base::Status make_new(const tools::Options& options) {
  const std::string& name = options.arguments()[1];
  tools::TrustedKey made;
  made.name = name;
  made.revokes = options.has("--revokes");
  if (options.has("--until") || options.has("--days")) {
    base::Result<int64_t> until = end_time(options, 0);
    if (!until.ok()) return until.error();
    made.until_s = *until;
  }
  base::Result<keys::NewKey> key = keys::make_key();
  if (!key.ok()) return key.error();
  made.key = key->public_key;
  const std::string lines = tools::trust_lines(made);
  // Before there is a file: the name and the times are such as a trust file has.
  base::Result<tools::TrustFile> readable = tools::parse_trust_file("key", lines);
  if (!readable.ok()) return usage("a name has letters, digits, - and _: " + readable.error().text);
  base::Status written = write_private(options.text("--output"), key->pem);
  if (!written.ok()) return written;
  const std::string& answer =
      wants_json(options) ? json_of(made, options.text("--output"), lines) : lines;
  std::fputs(answer.c_str(), stdout);
  return base::Ok{};
}

base::Result<SignedKind> kind_of(base::ByteSpan content) {
  if (ir::has_image_magic(content)) return SignedKind::kImage;
  if (online_change::has_fleet_magic(content)) return SignedKind::kFleet;
  if (online_change::decode_revoked(content).ok()) return SignedKind::kRevoked;
  if (online_change::has_order_magic(content)) return SignedKind::kOrder;
  if (online_change::has_package_magic(content)) return SignedKind::kPackage;
  return base::Error{base::Refusal::kBadFormat,
                     "neither an image nor a package nor a fleet file: it cannot be signed"};
}

base::Status sign_content(const tools::Options& options, base::ByteSpan content, SignedKind kind,
                          std::string plan) {
  base::Result<std::string> pem = read_private(options.text("--key"));
  if (!pem.ok()) return pem.error();
  base::Result<online_change::PublicKey> own = keys::public_key_of(*pem);
  if (!own.ok())
    return base::Error{own.error().refusal, options.text("--key") + ": " + own.error().text};
  Statement statement;
  statement.kind = kind;
  statement.key = online_change::key_id(*own);
  statement.plan = plan.empty() ? "key-" + base::short_hex(statement.key) : std::move(plan);
  base::Result<uint64_t> sequence = options.number("--sequence", static_cast<uint64_t>(now_ns()));
  if (!sequence.ok()) return sequence.error();
  statement.sequence = *sequence;
  base::Result<int64_t> expires = end_time(options, kind == SignedKind::kRevoked ? kMostDays : 7);
  if (!expires.ok()) return expires.error();
  statement.made_s = now_s();
  statement.expires_s = *expires;
  statement.target = options.text("--target");
  const bool named = online_change::is_signed_name(statement.plan) &&
                     (statement.target.empty() || online_change::is_signed_name(statement.target));
  if (!named) return usage("--plan and --target have 1 to 64 letters, digits and . _ - : /");
  statement.size = content.size();
  statement.content = base::sha256(content);
  base::Result<online_change::Signature> signature =
      keys::sign(*pem, online_change::message_of(statement));
  if (!signature.ok()) return signature.error();
  const std::string& file = options.text("--output");
  base::Status written =
      tools::write_file(file, online_change::encode(statement, *signature, content));
  if (written.ok() && wants_json(options)) {
    std::fputs(json_of(statement, file, {}).c_str(), stdout);
  }
  return written;
}

// What is signed already is signed anew.
base::Status sign(const tools::Options& options) {
  base::Result<base::Bytes> content = tools::read_bytes(options.arguments()[1]);
  if (!content.ok()) return content.error();
  base::Status stripped = online_change::strip_signature(*content);
  if (!stripped.ok()) return stripped;
  base::Result<SignedKind> kind = kind_of(*content);
  if (!kind.ok()) {
    return base::Error{kind.error().refusal, options.arguments()[1] + ": " + kind.error().text};
  }
  return sign_content(options, *content, *kind, options.text("--plan"));
}

// Names of a trust file, or public keys. A list has all that are revoked, not the newest ones only.
base::Status revoke(const tools::Options& options) {
  tools::TrustFile trust;
  if (options.has("--trust")) {
    base::Result<tools::TrustFile> read = tools::read_trust_file(options.text("--trust"));
    if (!read.ok()) return read.error();
    trust = std::move(*read);
  }
  std::vector<base::Digest> revoked;
  for (size_t i = 1; i < options.arguments().size(); ++i) {
    const std::string& word = options.arguments()[i];
    online_change::PublicKey key{};
    const auto named = std::ranges::find(trust.keys, word, &tools::TrustedKey::name);
    if (named != trust.keys.end()) {
      key = named->key;
    } else if (!base::digest_from_hex(word, key)) {
      return usage("`" + word + "` is no public key, and no name of a key of --trust");
    }
    revoked.push_back(online_change::key_id(key));
  }
  if (revoked.size() > online_change::kMostRevoked) return usage("a list has 256 keys at most");
  return sign_content(options, online_change::encode_revoked(revoked), SignedKind::kRevoked,
                      kRevokedPlan);
}

void print_statement(const Statement& statement, const tools::TrustedKey& key) {
  std::printf("%s of %llu bytes, signed by %s, plan %s, sequence %llu, until %s, for %s\n",
              online_change::signed_kind_name(statement.kind),
              static_cast<unsigned long long>(statement.size), key.name.c_str(),
              statement.plan.c_str(), static_cast<unsigned long long>(statement.sequence),
              tools::utc_text(statement.expires_s).c_str(),
              statement.target.empty() ? "any controller" : statement.target.c_str());
}

base::Status verify(const tools::Options& options) {
  const std::string& path = options.arguments()[1];
  base::Result<tools::TrustFile> trust = tools::read_trust_file(options.text("--trust"));
  if (!trust.ok()) return trust.error();
  base::Result<base::Bytes> bytes = tools::read_bytes(path);
  if (!bytes.ok()) return bytes.error();
  if (!online_change::has_signed_magic(*bytes)) {
    return base::Error{base::Refusal::kUnsigned, path + " is not signed"};
  }
  base::Result<online_change::SignedFile> file = online_change::open_signed(*bytes);
  if (!file.ok()) return base::Error{file.error().refusal, path + ": " + file.error().text};
  base::Result<const tools::TrustedKey*> key =
      tools::check_signature(*trust, *file, keys::verify, now_s());
  if (!key.ok()) return base::Error{key.error().refusal, path + ": " + key.error().text};
  if (wants_json(options)) {
    std::fputs(json_of(file->statement, path, (*key)->name).c_str(), stdout);
  } else {
    print_statement(file->statement, **key);
  }
  return base::Ok{};
}

base::Status carry_out(const tools::Options& options) {
  const std::string& verb = options.arguments()[0];
  base::NearestName nearest(verb);
  bool known = false;
  for (const char* one : {"new", "sign", "verify", "revoke"}) {
    nearest.offer(one);
    known = known || verb == one;
  }
  if (!known) {
    return usage("`" + verb + "` is none of new, sign, verify, revoke" + nearest.question());
  }
  const bool many = verb == "revoke";
  if (!many && options.arguments().size() != 2) return usage("`" + verb + "` takes one argument");
  base::Status complete = base::Ok{};
  if (verb != "verify") complete = require(options, "--output");
  if (complete.ok() && (many || verb == "sign")) complete = require(options, "--key");
  if (complete.ok() && verb == "verify") complete = require(options, "--trust");
  if (!complete.ok()) return complete;
  if (verb == "new") return make_new(options);
  if (verb == "sign") return sign(options);
  if (verb == "verify") return verify(options);
  return revoke(options);
}

#else

base::Status carry_out(const tools::Options&) {
  return base::Error{base::Refusal::kNoKeys,
                     "keys are not part of this stc: it was built without OpenSSL (package "
                     "libssl-dev)"};
}

#endif

int run_key(const tools::Options& options) {
  base::Status done = carry_out(options);
  return done.ok() ? tools::kOk : tools::refuse("stc", done.error());
}

}  // namespace

const Entry kKey{&kKeyCommand, run_key};

}  // namespace stc
