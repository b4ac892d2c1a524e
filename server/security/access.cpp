#include "server/security/access.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "core/base/error.h"
#include "core/base/hash.h"
#include "core/base/shorten.h"
#include "core/params/suggest.h"

namespace orrery {
namespace {

constexpr std::size_t kMinKeyBytes = 32;
constexpr std::size_t kMaxFileBytes = 1 << 20;

// Returns the bytes of a regular file. Throws InputError if the file is larger than kMaxFileBytes or is a
// pipe, which might never end.
std::string read_file(const std::string& path) {
  std::error_code problem;
  if (!std::filesystem::is_regular_file(path, problem))
    throw InputError(path, "must be a readable regular file");
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError(path, "cannot be read");
  std::string bytes(kMaxFileBytes + 1, '\0');
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(file.gcount()));
  if (bytes.size() > kMaxFileBytes)
    throw InputError(path, "file must have at most " + grouped(kMaxFileBytes) + " bytes");
  return bytes;
}

constexpr Scope scope_number(std::size_t i) { return static_cast<Scope>(1U << i); }  // `i`: index in kScopes

std::string read_key(const std::string& path) {
  std::string key = read_file(path);
  if (key.size() < kMinKeyBytes)
    throw InputError(path, "key must have at least " + std::to_string(kMinKeyBytes) + " bytes (got " +
                               std::to_string(key.size()) + ")");
  return key;
}

Access::Holder read_holder(const std::string& line) {
  std::istringstream words(line);
  std::string name, scopes, hash, more;
  words >> name >> scopes >> hash;
  if (hash.empty() || words >> more)
    throw InputError("", "must be a name, scopes and the SHA-256 of a token, separated by blanks");
  if (!is_sha256_hex(hash)) throw InputError("", "SHA-256 of the token must be 64 digits, 0-9 or a-f");
  return {.name = name, .token_sha256 = hash, .scopes = parse_scopes(scopes)};
}

std::string signed_text(std::string_view address, std::int64_t expires) {
  return std::to_string(expires) + " " + std::string(address);
}

}  // namespace

Access::Access(std::string tokens_file, std::string link_signing_key_file)
    : tokens_file_(std::move(tokens_file)), share_key_file_(std::move(link_signing_key_file)) {
  reload();
}

void Access::reload() {
  auto fresh = std::make_shared<const TokenTable>(read());
  const std::lock_guard lock(mutex_);
  known_ = std::move(fresh);
}

Access::TokenTable Access::read() const {
  TokenTable known;
  std::vector<Problem> problems;
  const auto note = [&](const std::string& place, const auto& read) {
    try {
      read();
    } catch (const InputError& error) {
      problems.push_back({place, error.problems()[0].detail});
    }
  };
  if (!share_key_file_.empty()) note(share_key_file_, [&] { known.key = read_key(share_key_file_); });
  std::string tokens;
  if (!tokens_file_.empty()) note(tokens_file_, [&] { tokens = read_file(tokens_file_); });
  std::istringstream lines(tokens);
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    line.resize(std::min(line.find('#'), line.size()));
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    note(tokens_file_ + ":" + std::to_string(number), [&] { known.holders.push_back(read_holder(line)); });
  }
  if (needs_token() && known.holders.empty() && problems.empty())
    problems.push_back(
        {tokens_file_, "file must contain at least one token; otherwise no client can use the service"});
  if (!problems.empty()) throw InputError(std::move(problems));
  return known;
}

std::shared_ptr<const Access::TokenTable> Access::known() const {
  const std::lock_guard lock(mutex_);
  return known_;
}

std::optional<Access::Holder> Access::holder_of(std::string_view token) const {
  const std::string hash = sha256_hex(token);
  const auto now = known();
  std::optional<Holder> found;
  for (const Holder& holder : now->holders)
    if (equal_in_constant_time(holder.token_sha256, hash)) found = holder;
  return found;
}

std::string Access::sign(std::string_view address, std::int64_t expires) const {
  const auto now = known();
  if (now->key.empty()) throw NotFound("cannot sign links: link_signing_key_file is not set");
  return hmac_sha256_hex(now->key, signed_text(address, expires));
}

bool Access::is_signed(std::string_view address, std::int64_t expires, std::string_view signature) const {
  const auto now = known();
  return !now->key.empty() &&
         equal_in_constant_time(hmac_sha256_hex(now->key, signed_text(address, expires)), signature);
}

std::string token_line(std::string_view name, std::string_view scopes, std::string_view token) {
  return std::string(name) + " " + std::string(scopes) + " " + sha256_hex(token);
}

Scope parse_scopes(std::string_view list) {
  constexpr std::string_view kAllowed = "must be one of \"read\", \"render\", \"write\" or \"admin\"";
  if (list.empty()) throw InputError("", std::string(kAllowed) + " (got \"\")");
  std::istringstream names{std::string(list)};
  Scope scopes = Scope::none;
  for (std::string name; std::getline(names, name, ',');) {
    const auto known = std::find(kScopes.begin(), kScopes.end(), name);
    if (known == kScopes.end()) {
      const auto meant = nearest(name, kScopes);
      throw InputError("", std::string(kAllowed) + " (got \"" + name.substr(0, 40) + "\"" +
                               (meant ? "; did you mean \"" + *meant + "\"?" : "") + ")");
    }
    scopes = scopes | scope_number(known - kScopes.begin());
  }
  return scopes;
}

std::optional<std::string_view> missing_scope(Scope held, Scope needed) {
  for (std::size_t i = 0; i < kScopes.size(); ++i)
    if ((needed | scope_number(i)) == needed && (held | scope_number(i)) != held) return kScopes[i];
  return std::nullopt;
}

}  // namespace orrery
