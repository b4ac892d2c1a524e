#include <cstdlib>
#include <string_view>

#include "core/base/error.h"
#include "core/load/load.h"

// Fuzzes the readers of scenes and requests. Any text is accepted or rejected with problems that state their
// place. The canonical JSON of accepted text parses to the same canonical JSON.

namespace {

using namespace orrery;

void require(bool holds) {
  if (!holds) std::abort();
}

void check(const InputError& error) {
  require(!error.problems().empty() && error.problems().size() <= 21);
  for (const Problem& problem : error.problems()) {
    require(problem.pointer.empty() || problem.pointer.front() == '/');
    require(!problem.detail.empty());
  }
}

template <class Read>
void expect_read_or_refused(const Read& read) {
  try {
    read();
  } catch (const InputError& error) {
    check(error);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const JsonLimits limits{.depth = 16, .nodes = 2000};
  expect_read_or_refused([&] {
    const Document document = parse_document(text, limits);
    const std::string canonical = document.canonical();
    require(parse_document(canonical, limits).canonical() == canonical);
    expect_read_or_refused([&] { read_request(document); });
    expect_read_or_refused([&] { load_scene(document); });
  });
  return 0;
}
