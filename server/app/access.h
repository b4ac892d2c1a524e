#pragma once

#include <array>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace orrery {

// What the holder of a token may do, and what a request needs: look at what is there, pictures included; have
// pictures made of other scenes, and jobs done; keep scenes and assets, and remove one's own; remove those
// and the jobs of others; or several of these.
enum class Scope : unsigned { none = 0, read = 1, render = 2, write = 4, admin = 8 };
inline constexpr std::array<std::string_view, 4> kScopes{"read", "render", "write", "admin"};
constexpr Scope operator|(Scope a, Scope b) {
  return static_cast<Scope>(static_cast<unsigned>(a) | static_cast<unsigned>(b));
}
// The name of the first scope of `needed` that `held` lacks; none: it has them all.
std::optional<std::string_view> lacking(Scope held, Scope needed);

// Who may use the service: holders of a token, and those whom they gave a signed link. Safe from any thread.
class Access {
 public:
  // tokens_file: a line each, "NAME SCOPE[,SCOPE...] SHA256-OF-TOKEN"; # begins a comment. Empty: everyone
  // may do everything, but remove what others made. share_key_file: bytes, at least 32, that links are signed
  // with. Empty: there are no links. Throws InputError that names the file and the line; a file without
  // tokens is an error.
  Access(std::string tokens_file, std::string share_key_file);

  // Reads the files again. Throws as the constructor does, and then all stays as it is.
  void reload();

  bool needs_token() const { return !tokens_file_.empty(); }
  std::size_t tokens() const { return known()->holders.size(); }

  struct Holder {
    std::string name, token_sha256;
    Scope scopes;
  };
  // Who holds the token; none: nobody. Takes as long for every token.
  std::optional<Holder> holder_of(std::string_view token) const;

  // The signature of an address until `expires` (seconds since 1970). Throws NotFound if there is no key.
  std::string sign(std::string_view address, std::int64_t expires) const;
  bool is_signed(std::string_view address, std::int64_t expires, std::string_view signature) const;

 private:
  struct Known {
    std::vector<Holder> holders;
    std::string key;
  };
  Known read() const;
  std::shared_ptr<const Known> known() const;

  const std::string tokens_file_, share_key_file_;
  mutable std::mutex mutex_;
  std::shared_ptr<const Known> known_;  // guarded by mutex_
};

// A line for a tokens file.
std::string token_line(std::string_view name, std::string_view scopes, std::string_view token);

// Reads a list of scopes with commas between them. Throws InputError.
Scope parse_scopes(std::string_view list);

}  // namespace orrery
