#include "core/base/decoder_process.h"

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
#include <system_error>
#include <utility>

#include "core/base/error.h"
#include "core/base/task_scope.h"

namespace orrery {
namespace {

[[noreturn]] void fail_system(const std::string& what) {
  throw std::system_error(errno, std::generic_category(), what);
}

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  int get() const { return number_; }
  int release() { return std::exchange(number_, -1); }

 private:
  int number_;
};

// Returns the path of a program. Throws InputError if it is missing.
std::string path_of(const std::string& name, const std::string& subject) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error).parent_path();
  const fs::path parent = program.parent_path();
  std::vector<fs::path> paths{program / name, parent / name};
  fs::path folder = program;
  Dl_info library;
  if (dladdr(reinterpret_cast<void*>(&path_of), &library) != 0)
    folder = fs::canonical(library.dli_fname, error).parent_path();
  // An installed library is in lib, a folder below it, or lib/ARCHITECTURE/glibc-hwcaps/LEVEL.
  for (int up = 0; up < 5; ++up, folder = folder.parent_path())
    paths.push_back(folder / "libexec/orrery" / name);
  for (const fs::path& path : paths)
    if (access(path.c_str(), X_OK) == 0) return path;
  throw InputError("", "cannot read " + subject + ": program " + name + " is missing in " + program.string());
}

// Writes the parts to a file in memory. Returns the descriptor of the file.
int file_of(std::span<const std::string_view> parts) {
  Descriptor file(memfd_create("input", MFD_CLOEXEC));
  if (file.get() < 0) fail_system("cannot create a file in memory");
  for (std::string_view part : parts)
    while (!part.empty()) {
      checkpoint();
      constexpr std::size_t kAtOnce = 1 << 20;
      const ssize_t written = write(file.get(), part.data(), std::min(part.size(), kAtOnce));
      if (written < 0) fail_system("cannot write a file in memory");
      part.remove_prefix(static_cast<std::size_t>(written));
    }
  return file.release();
}

// When CPU time is scarce, a decoder gets about a tenth of the time of a render thread, because a burst of
// uploads can start dozens of decoders.
constexpr int kNiceness = 10;

// Starts a program with its standard input and output. Returns the number of the process.
pid_t start(const std::string& path, std::vector<std::string>& arguments, int input, int output) {
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
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
  pid_t process = 0;
  const int error = posix_spawn(&process, path.c_str(), &actions, &attributes, pointers.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (error) throw std::system_error(error, std::generic_category(), "cannot start " + arguments.front());
  setpriority(PRIO_PROCESS, static_cast<id_t>(process), kNiceness);
  return process;
}

}  // namespace

DecoderProcess::DecoderProcess(const std::string& program, std::vector<std::string> arguments,
                               std::span<const std::string_view> parts, std::string subject)
    : subject_(std::move(subject)) {
  const std::string path = path_of(program, subject_);
  const Descriptor input(file_of(parts));
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) fail_system("cannot create a pipe");
  Descriptor output(ends[0]);
  const Descriptor to_decoder(ends[1]);
  arguments.insert(arguments.begin(), program);
  process_ = start(path, arguments, input.get(), to_decoder.get());
  output_ = output.release();
}

DecoderProcess::~DecoderProcess() {
  if (process_ > 0) kill(process_, SIGKILL), wait();
  if (output_ >= 0) close(output_);
}

// Waits for the process to end. Returns the status of waitpid().
int DecoderProcess::wait() {
  int status = 0;
  while (waitpid(process_, &status, 0) < 0 && errno == EINTR) {
  }
  process_ = 0;
  return status;
}

std::size_t DecoderProcess::read_some(std::span<std::byte> bytes) {
  constexpr int kLook_ms = 20;  // maximum delay until a cancelled decoder is killed
  std::size_t got = 0;
  while (got < bytes.size()) {
    checkpoint();
    pollfd ready{output_, POLLIN, 0};
    if (poll(&ready, 1, kLook_ms) <= 0) continue;
    const ssize_t more = read(output_, bytes.data() + got, bytes.size() - got);
    if (more < 0 && errno != EINTR) fail_system("cannot read a decoded " + subject_);
    if (more == 0) break;
    got += static_cast<std::size_t>(std::max<ssize_t>(more, 0));
  }
  return got;
}

void DecoderProcess::read_all(std::span<std::byte> bytes) {
  if (read_some(bytes) < bytes.size()) fail_ended();
}

void DecoderProcess::fail_with_text(std::uint64_t bytes) {
  std::string text(std::min<std::uint64_t>(bytes, 500), ' ');
  text.resize(read_some(std::as_writable_bytes(std::span(text))));
  throw InputError("", std::move(text));
}

void DecoderProcess::fail_ended() {
  const int status = wait();
  if (WIFSIGNALED(status))
    throw InputError("", "cannot decode " + subject_ + ": a signal ended the decoder (" +
                             strsignal(WTERMSIG(status)) + ")");
  throw InputError("", subject_ + " is damaged: decoder stopped early");
}

}  // namespace orrery
