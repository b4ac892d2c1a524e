#include <array>
#include <cmath>
#include <cstdlib>
#include <string_view>

#include "server/http/target.h"
#include "server/routes/answers.h"

// Fuzzes the parsers of request targets and of the headers Accept and If-None-Match. Each parser accepts any
// text or rejects it as invalid input.

namespace {

using namespace orrery;

void require(bool holds) {
  if (!holds) std::abort();
}

std::string take_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  const std::string line(text.substr(0, end));
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  return line;
}

void read_options(const Request& request) {
  constexpr std::array<std::string_view, 2> kMore{"frames", "fps"};
  try {
    const RenderRequest read = read_query(request, kMore);
    require(!read.azimuth_degrees || std::isfinite(*read.azimuth_degrees));
    require(!read.distance || *read.distance > 0);
    require(!read.samples || *read.samples >= 1);
  } catch (const InputError& error) {
    require(!error.problems().empty() && !error.problems().front().detail.empty());
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string_view text(reinterpret_cast<const char*>(data), size);
  Request request;
  try {
    Target target = parse_target(take_line(text));
    require(target.path.starts_with('/'));
    request.query = std::move(target.query);
    read_options(request);
  } catch (const HttpError& error) {
    require(error.status() == 400);
  }
  request.headers = {{"Accept", take_line(text)}, {"If-None-Match", take_line(text)}};
  constexpr std::array<std::string_view, 3> kTypes{"image/png", "image/jpeg", "application/json"};
  try {
    const std::string_view chosen = negotiate(request, kTypes);
    require(std::find(kTypes.begin(), kTypes.end(), chosen) != kTypes.end());
  } catch (const HttpError& error) {
    require(error.status() == 406);
  }
  has_current(request, "\"abc\"");
  return 0;
}
