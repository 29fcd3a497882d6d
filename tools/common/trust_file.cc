#include "tools/common/trust_file.h"

#include <algorithm>
#include <optional>

#include "tools/common/files.h"
#include "tools/common/toml.h"
#include "tools/common/utc_time.h"

namespace tools {
namespace {

// One reading of one file.
class Reader {
 public:
  explicit Reader(std::string_view file) : file_(file) {}

  base::Result<TrustFile> read(const TomlTable& table) {
    for (const auto& [key, value] : table) {
      if (!error_) read_row(key, value);
    }
    if (!error_) check_keys();
    if (error_) return *error_;
    return std::move(out_);
  }

 private:
  void fail(const TomlValue& at, const std::string& what) {
    error_ = toml_error(file_, at.line, at.column, what);
    error_->refusal = base::Refusal::kBadKeys;
  }

  std::string text(const TomlValue& value) {
    if (const auto* const found = std::get_if<std::string>(&value.data)) return *found;
    fail(value, "a text in quotes is needed");
    return {};
  }

  void read_row(const std::string& key, const TomlValue& value) {
    constexpr std::string_view kTable = "keys.";
    if (key == "name") return read_name(value);
    if (key == "unsigned") return read_policy(value);
    const size_t dot = key.rfind('.');
    const bool of_key = key.starts_with(kTable) && dot >= kTable.size();
    if (!of_key)
      return fail(value, "unknown key `" + key + "`; there are name, unsigned, [keys.NAME]");
    read_key(row(key.substr(kTable.size(), dot - kTable.size())), key.substr(dot + 1), value);
  }

  void read_name(const TomlValue& value) {
    out_.name = text(value);
    if (!error_ && !online_change::is_signed_name(out_.name)) {
      fail(value, "a name has 1 to 64 letters, digits and . _ - : /");
    }
  }

  void read_policy(const TomlValue& value) {
    const std::string word = text(value);
    out_.local_unsigned = word == "local";
    if (!error_ && word != "local" && word != "never") {
      fail(value, "unsigned is \"never\" or \"local\"");
    }
  }

  TrustedKey& row(const std::string& name) {
    const auto found = std::ranges::find(out_.keys, name, &TrustedKey::name);
    if (found != out_.keys.end()) return *found;
    out_.keys.push_back({});
    out_.keys.back().name = name;
    return out_.keys.back();
  }

  void read_key(TrustedKey& key, const std::string& what, const TomlValue& value) {
    if (what == "revokes") {
      const bool* const revokes = std::get_if<bool>(&value.data);
      if (revokes == nullptr) return fail(value, "revokes is true or false");
      key.revokes = *revokes;
      return;
    }
    const std::string written = text(value);
    if (error_) return;
    if (what == "public") return read_public(key, written, value);
    if (what != "from" && what != "until") {
      return fail(value, "unknown key `" + what + "`; a key has public, from, until, revokes");
    }
    const std::optional<int64_t> time = parse_utc(written);
    if (!time) return fail(value, "a time is \"2026-03-01\" or \"2026-03-01T08:00:00Z\"");
    (what == "from" ? key.from_s : key.until_s) = *time;
  }

  void read_public(TrustedKey& key, const std::string& hex, const TomlValue& value) {
    base::Digest bytes{};
    if (!base::digest_from_hex(hex, bytes)) return fail(value, "a public key is 64 hex digits");
    key.key = bytes;
    key.id = online_change::key_id(key.key);
  }

  void check_keys() {
    const auto bad = [&](const std::string& what) {
      error_ = base::Error{base::Refusal::kBadKeys, std::string(file_) + ": " + what};
    };
    if (out_.keys.empty()) return bad("it has no key; `stc key new NAME` prints the lines of one");
    if (out_.keys.size() > kMostTrustedKeys) return bad("more than 256 keys");
    for (const TrustedKey& key : out_.keys) {
      if (key.id == base::Digest{}) return bad("key " + key.name + " has no `public`");
      if (out_.find(key.id) != &key) return bad("key " + key.name + " is there under two names");
      if (key.from_s >= key.until_s) return bad("key " + key.name + " ends before it begins");
    }
  }

  std::string_view file_;
  TrustFile out_;
  std::optional<base::Error> error_;
};

}  // namespace

const TrustedKey* TrustFile::find(const base::Digest& id) const {
  const auto found = std::ranges::find(keys, id, &TrustedKey::id);
  return found == keys.end() ? nullptr : &*found;
}

base::Result<TrustFile> parse_trust_file(std::string_view file, std::string_view text) {
  base::Result<TomlTable> table = parse_toml(file, text);
  if (!table.ok()) return base::Error{base::Refusal::kBadKeys, table.error().text};
  return Reader(file).read(*table);
}

base::Result<TrustFile> read_trust_file(const std::string& path) {
  base::Result<std::string> text = read_text(path, kMostTrustBytes);
  if (!text.ok()) return text.error();
  return parse_trust_file(path, *text);
}

base::Status check_key(const TrustedKey& key, int64_t now_s) {
  if (now_s >= key.from_s && now_s < key.until_s) return base::Ok{};
  const bool early = now_s < key.from_s;
  return base::Error{base::Refusal::kKeyEnded, "key " + key.name +
                                                   (early ? " begins at " : " ended at ") +
                                                   utc_text(early ? key.from_s : key.until_s) +
                                                   ", and it is " + utc_text(now_s)};
}

base::Result<const TrustedKey*> check_signature(const TrustFile& trust,
                                                const online_change::SignedFile& file,
                                                online_change::VerifySignature verify,
                                                int64_t now_s) {
  const online_change::Statement& statement = file.statement;
  const TrustedKey* const key = trust.find(statement.key);
  if (key == nullptr) {
    return base::Error{
        base::Refusal::kUnknownKey,
        "signed by key " + base::short_hex(statement.key) + ", which the trust file does not have"};
  }
  if (!verify(key->key, file.message, file.signature)) {
    return base::Error{base::Refusal::kBadSignature,
                       "it says that key " + key->name + " has signed it, and it has not"};
  }
  if (base::Status in_time = check_key(*key, now_s); !in_time.ok()) return in_time.error();
  if ((statement.kind == online_change::SignedKind::kRevoked) != key->revokes) {
    return base::Error{
        base::Refusal::kOtherTarget,
        "key " + key->name +
            (key->revokes ? " is for lists of revoked keys only" : " may not revoke keys")};
  }
  if (now_s < statement.expires_s) return key;
  return base::Error{base::Refusal::kSignatureExpired, "signed by " + key->name + " until " +
                                                           utc_text(statement.expires_s) +
                                                           ", and it is " + utc_text(now_s)};
}

std::string trust_lines(const TrustedKey& key) {
  std::string out = "[keys." + key.name + "]\npublic = \"" + base::to_hex(key.key) + "\"\n";
  if (key.from_s != 0) out += "from = \"" + utc_text(key.from_s) + "\"\n";
  if (key.until_s != INT64_MAX) out += "until = \"" + utc_text(key.until_s) + "\"\n";
  if (key.revokes) out += "revokes = true\n";
  return out;
}

}  // namespace tools
