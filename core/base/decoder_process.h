#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace orrery {

// Separate process that decodes one file with a program of this project, so that the file cannot crash or
// exhaust this process. The program must be in the folder of the executable, in the parent folder, or in
// ../libexec/orrery. The destructor kills a process that is still running. Not thread-safe.
class DecoderProcess {
 public:
  // Starts `program` with `arguments`. Its standard input is a file that consists of `parts`. `subject`: what
  // the program decodes, such as "image", for error messages. Throws InputError (pointer "") if the program
  // is missing, Cancelled, and std::system_error if the operating system refuses a process, pipe or file.
  DecoderProcess(const std::string& program, std::vector<std::string> arguments,
                 std::span<const std::string_view> parts, std::string subject);
  ~DecoderProcess();
  DecoderProcess(const DecoderProcess&) = delete;

  // Reads the output of the program until `bytes` is full or the output ends. Returns the number of bytes
  // read. Throws Cancelled within 20 ms after cancellation, and std::system_error.
  std::size_t read_some(std::span<std::byte> bytes);
  // Reads `bytes.size()` bytes. Throws InputError that reports the end of the process if there are fewer.
  void read_all(std::span<std::byte> bytes);
  // Reads an error message of `bytes` bytes and throws its first 500 bytes as InputError (pointer "").
  [[noreturn]] void fail_with_text(std::uint64_t bytes);

 private:
  int wait();
  [[noreturn]] void fail_ended();

  std::string subject_;
  pid_t process_ = 0;
  int output_ = -1;
};

}  // namespace orrery
