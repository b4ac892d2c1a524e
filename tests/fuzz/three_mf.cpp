#include "core/base/error.h"
#include "core/meshes/model.h"
#include "tests/fuzz/model_check.h"
#include "tests/meshes/writers.h"

// Fuzzes 3MF. The input is the model part, a zero byte, and a second part, which the harness stores in a
// valid archive. Any bytes are rejected or read as a valid model.

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace orrery;
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  const std::size_t end = std::min(bytes.find('\0'), size);
  const std::string archive = test::Zip()
                                  .add("3D/3dmodel.model", bytes.substr(0, end))
                                  .add("3D/b.model", bytes.substr(std::min(end + 1, size)))
                                  .bytes();
  const MeshLimits limits{10'000, 10'000};
  try {
    test::check_model(read_model(archive, limits), limits);
  } catch (const InputError& error) {
    test::require(std::string_view(error.what()).size() < 700);
  }
  return 0;
}
