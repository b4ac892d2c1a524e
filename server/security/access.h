#pragma once

#include <array>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace orrery {

// Set of permissions that a token grants or a request needs.
//  - `read`: get stored resources and render images of stored scenes.
//  - `render`: render scenes from a request body, and start and cancel jobs.
//  - `write`: store scenes and assets, and remove those of the same client.
//  - `admin`: remove scenes, assets and jobs of other clients.
enum class Scope : unsigned { none = 0, read = 1, render = 2, write = 4, admin = 8 };
inline constexpr std::array<std::string_view, 4> kScopes{"read", "render", "write", "admin"};
constexpr Scope operator|(Scope a, Scope b) {
  return static_cast<Scope>(static_cast<unsigned>(a) | static_cast<unsigned>(b));
}
// Returns the name of the first scope of `needed` that `held` lacks, or nullopt if `held` includes all of
// them.
std::optional<std::string_view> missing_scope(Scope held, Scope needed);

// Access control by tokens and signed links. Thread-safe.
class Access {
 public:
  // Each line of `tokens_file` is "NAME SCOPE[,SCOPE...] SHA256-OF-TOKEN". # starts a comment. If
  // `tokens_file` is "", every client has all permissions except removing resources of other clients.
  // `link_signing_key_file` contains the key that signs links, at least 32 bytes. If it is "", links are
  // disabled. Throws InputError with file and line if a file is invalid or `tokens_file` contains no token.
  Access(std::string tokens_file, std::string link_signing_key_file);

  // Reads both files again. If it throws like the constructor, the old tokens and key stay in use.
  void reload();

  bool needs_token() const { return !tokens_file_.empty(); }
  std::size_t tokens() const { return known()->holders.size(); }

  struct Holder {
    std::string name, token_sha256;
    Scope scopes;
  };
  // Returns the holder of the token, or nullopt if the token is unknown. The time taken does not reveal how
  // much of a stored hash matches.
  std::optional<Holder> holder_of(std::string_view token) const;

  // Returns the signature of the URL `address`, valid until `expires` (seconds since 1970). Throws NotFound
  // if no key is configured.
  std::string sign(std::string_view address, std::int64_t expires) const;
  // Returns whether the signature is valid. Does not check whether it has expired.
  bool is_signed(std::string_view address, std::int64_t expires, std::string_view signature) const;

 private:
  struct TokenTable {
    std::vector<Holder> holders;
    std::string key;
  };
  TokenTable read() const;
  std::shared_ptr<const TokenTable> known() const;

  const std::string tokens_file_, share_key_file_;
  mutable std::mutex mutex_;
  std::shared_ptr<const TokenTable> known_;  // guarded by mutex_
};

// Returns the line of a tokens file that grants `scopes` to `token`.
std::string token_line(std::string_view name, std::string_view scopes, std::string_view token);

// Parses a comma-separated list of scopes. Throws InputError if it is empty or a scope is unknown.
Scope parse_scopes(std::string_view list);

}  // namespace orrery
