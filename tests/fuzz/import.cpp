#include "server/import/import.h"

#include "core/base/error.h"
#include "tests/fuzz/model_check.h"

// Fuzzes scenes of pbrt-v4 and Mitsuba. The input is a scene, a zero byte, and the content of each file that
// it names. Names with "x" are missing. Any bytes are rejected with a short message, or converted.

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace orrery;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const std::size_t end = std::min(bytes.find('\0'), size);
  const std::string other(bytes.substr(std::min(end + 1, size)));
  const ReadNearby nearby = [&](const std::string& name) {
    if (name.find('x') != name.npos) throw InputError("", "missing");
    return other;
  };
  try {
    const ImportedScene made = import_scene(std::string(bytes.substr(0, end)), "fuzz", nearby,
                                            {.limits = {.bytes = 1'000'000, .files = 50, .objects = 10'000}});
    test::require(made.scene.contains("camera"));
  } catch (const InputError& error) {
    test::require(std::string_view(error.what()).size() < 1000);
  }
  return 0;
}
