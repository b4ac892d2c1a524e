#include "core/image/decode/decode_process.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <span>
#include <system_error>
#include <vector>

#include "core/base/error.h"
#include "core/base/task_scope.h"
#include "core/image/decode/decoder/protocol.h"

namespace orrery {
namespace {

[[noreturn]] void fail_system(const char* what) {
  throw std::system_error(errno, std::generic_category(), what);
}

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() { reset(); }
  Descriptor(const Descriptor&) = delete;
  int get() const { return number_; }
  void reset() {
    if (number_ >= 0) close(number_);
    number_ = -1;
  }

 private:
  int number_;
};

std::string decoder_path() {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error).parent_path();
  const fs::path parent = program.parent_path();
  std::vector<fs::path> paths{program / "orrery-decode", parent / "orrery-decode"};
  fs::path folder = program;
  Dl_info library;
  if (dladdr(reinterpret_cast<void*>(&decoder_path), &library) != 0)
    folder = fs::canonical(library.dli_fname, error).parent_path();
  // An installed library is in lib, a folder below it, or lib/ARCHITECTURE/glibc-hwcaps/LEVEL.
  for (int up = 0; up < 5; ++up, folder = folder.parent_path())
    paths.push_back(folder / "libexec/orrery/orrery-decode");
  for (const fs::path& path : paths)
    if (access(path.c_str(), X_OK) == 0) return path;
  throw InputError("", "cannot read images: program orrery-decode is missing in " + program.string());
}

const char* plugin_of(PictureFormat format) {
  switch (format) {
    case PictureFormat::exr: return "openexr";
    case PictureFormat::hdr: return "hdr";
    case PictureFormat::png: return "png";
    case PictureFormat::jpeg: return "jpeg";
  }
  return "";
}

// Returns the bytes that the process may allocate in addition to kDecoderBytes.
std::uint64_t allowance(const PictureFile& file) {
  const std::uint64_t rows = std::min<std::uint64_t>(file.height, kRowsAtOnce), samples = 2, sample_bytes = 4;
  return file.decoder_bytes + samples * sample_bytes * file.width * rows * 4;
}

// Writes the parts that affect texels to a file in memory. Returns the descriptor of the file.
int file_of_parts(const PictureFile& file) {
  const int number = memfd_create("picture", MFD_CLOEXEC);
  if (number < 0) fail_system("cannot create a file in memory");
  for (std::string_view part : file.parts)
    while (!part.empty()) {
      checkpoint();
      constexpr std::size_t kAtOnce = 1 << 20;
      const ssize_t written = write(number, part.data(), std::min(part.size(), kAtOnce));
      if (written < 0) {
        close(number);
        fail_system("cannot write a file in memory");
      }
      part.remove_prefix(static_cast<std::size_t>(written));
    }
  return number;
}

// When CPU time is scarce, a decoder gets about a tenth of the time of a render thread, because a burst of
// uploads can start dozens of decoders.
constexpr int kNiceness = 10;

// Decoder process. The destructor kills it if it is still running.
class Decoder {
 public:
  Decoder(const PictureFile& file, int input, int output) {
    const std::string path = decoder_path(), bytes = std::to_string(allowance(file));
    const char* const arguments[] = {path.c_str(), plugin_of(file.format), bytes.c_str(), nullptr};
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    sigset_t none, all;
    sigemptyset(&none);
    sigfillset(&all);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setsigdefault(&attributes, &all);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
    const int error = posix_spawn(&process_, path.c_str(), &actions, &attributes,
                                  const_cast<char* const*>(arguments), environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    if (error) throw std::system_error(error, std::generic_category(), "cannot start orrery-decode");
    setpriority(PRIO_PROCESS, static_cast<id_t>(process_), kNiceness);
  }
  ~Decoder() {
    if (process_ > 0) kill(process_, SIGKILL), wait();
  }
  Decoder(const Decoder&) = delete;

  // Waits for the process to end. Returns the status of waitpid().
  int wait() {
    int status = 0;
    while (waitpid(process_, &status, 0) < 0 && errno == EINTR) {
    }
    process_ = 0;
    return status;
  }

 private:
  pid_t process_ = 0;
};

// Reads until `bytes` is full or the other end is closed. Returns the number of bytes read. Throws Cancelled.
std::size_t read_full(int from, std::span<std::byte> bytes) {
  constexpr int kLook_ms = 20;  // maximum delay until a cancelled decoder is killed
  std::size_t got = 0;
  while (got < bytes.size()) {
    checkpoint();
    pollfd ready{from, POLLIN, 0};
    if (poll(&ready, 1, kLook_ms) <= 0) continue;
    const ssize_t more = read(from, bytes.data() + got, bytes.size() - got);
    if (more < 0 && errno != EINTR) fail_system("cannot read a decoded image");
    if (more == 0) break;
    got += static_cast<std::size_t>(std::max<ssize_t>(more, 0));
  }
  return got;
}

// Reads texels with alpha by read(values), which fills a list, and separates the alpha.
template <class Read>
void read_with_alpha(const Read& read, Texels& picture) {
  constexpr std::size_t kAtOnce = 16384;  // texels
  picture.alpha.resize(picture.rgb.size() / 3);
  std::vector<float> values;
  for (std::size_t at = 0; at < picture.alpha.size(); at += kAtOnce) {
    const std::size_t count = std::min(kAtOnce, picture.alpha.size() - at);
    values.resize(4 * count);
    read(values);
    for (std::size_t i = 0; i < count; ++i) {
      std::copy_n(&values[4 * i], 3, &picture.rgb[3 * (at + i)]);
      picture.alpha[at + i] = values[4 * i + 3];
    }
  }
}

[[noreturn]] void fail_ended(int status) {
  if (WIFSIGNALED(status))
    throw InputError("", std::string("cannot decode image: a signal ended the decoder (") +
                             strsignal(WTERMSIG(status)) + ")");
  throw InputError("", "image is damaged: decoder stopped early");
}

}  // namespace

Texels decode_in_process(const PictureFile& file) {
  const MemoryCharge charge(kDecoderBytes + allowance(file));
  const Descriptor input(file_of_parts(file));
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) fail_system("cannot create a pipe");
  const Descriptor output(ends[0]);
  Descriptor to_decoder(ends[1]);
  Decoder decoder(file, input.get(), to_decoder.get());
  to_decoder.reset();
  DecodedHeader header{};
  if (read_full(output.get(), std::as_writable_bytes(std::span(&header, 1))) < sizeof header)
    fail_ended(decoder.wait());
  if (header.text_bytes > 0) {
    std::string text(std::min<std::size_t>(header.text_bytes, 500), ' ');
    text.resize(read_full(output.get(), std::as_writable_bytes(std::span(text))));
    throw InputError("", std::move(text));
  }
  if (header.width != file.width || header.height != file.height)
    throw InputError("", "image is damaged: decoded size must equal the size in the header, " +
                             std::to_string(file.width) + " x " + std::to_string(file.height) + " (got " +
                             std::to_string(header.width) + " x " + std::to_string(header.height) + ")");
  Texels picture{static_cast<int>(header.width), static_cast<int>(header.height), {}, {}};
  picture.rgb.resize(std::size_t{3} * header.width * header.height);
  const auto read = [&](std::span<float> values) {
    const std::span<std::byte> bytes = std::as_writable_bytes(values);
    if (read_full(output.get(), bytes) < bytes.size()) fail_ended(decoder.wait());
  };
  if (header.channels == 3)
    read(picture.rgb);
  else
    read_with_alpha(read, picture);
  return picture;
}

}  // namespace orrery
