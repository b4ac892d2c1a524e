#include "core/base/error.h"
#include "core/meshes/model.h"
#include "tests/fuzz/model_check.h"

// Fuzzes OBJ files with their material libraries. The input is an OBJ file, a zero byte, and the content of
// each file that it names. Names with "x" are missing. Any bytes are rejected or read as a valid model.

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace orrery;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const std::size_t end = std::min(bytes.find('\0'), size);
  const std::string library(bytes.substr(std::min(end + 1, size)));
  const ReadNearby nearby = [&](const std::string& name) {
    if (name.find('x') != name.npos) throw InputError("", "missing");
    return library;
  };
  const MeshLimits limits{100'000, 100'000};
  try {
    test::check_model(read_model(bytes.substr(0, end), limits, nearby), limits);
  } catch (const InputError& error) {
    test::require(std::string_view(error.what()).size() < 500);
  }
  return 0;
}
