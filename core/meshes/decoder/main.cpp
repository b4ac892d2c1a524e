// Program orrery-decode-mesh: decodes one Draco mesh in a separate process with limited memory and CPU time.
// If a mesh crashes the library, only this process ends.

#include <draco/compression/decode.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <new>
#include <span>
#include <string>
#include <vector>

#include "core/base/decoder_program.h"
#include "core/meshes/decoder/protocol.h"

namespace {

using orrery::write_all;

struct Attribute {
  std::uint32_t id;
  std::size_t components;
};

struct Request {
  std::uint64_t memory_bytes;
  std::size_t points, faces;
  std::vector<Attribute> attributes;
};

[[noreturn]] void fail(const std::string& text) {
  const orrery::DecodedMeshHeader header{text.size()};
  write_all(std::as_bytes(std::span(&header, 1)));
  write_all(std::as_bytes(std::span(text)));
  std::_Exit(0);
}

Request request_of(std::span<char*> arguments) {
  const auto number = [&](std::size_t i) { return std::strtoull(arguments[i], nullptr, 10); };
  Request request{number(1), number(2), number(3), {}};
  for (std::size_t i = 4; i < arguments.size(); ++i) {
    const char* const colon = std::strchr(arguments[i], ':');
    request.attributes.push_back(
        {static_cast<std::uint32_t>(number(i)), colon ? std::strtoull(colon + 1, nullptr, 10) : 1});
  }
  return request;
}

std::unique_ptr<draco::Mesh> decode(std::span<const std::byte> bytes, const Request& request) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  draco::Decoder decoder;
  auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok()) fail("Draco mesh is damaged");
  std::unique_ptr<draco::Mesh> mesh = std::move(decoded).value();
  const auto require = [](const char* what, std::size_t stated, std::size_t got) {
    if (got != stated)
      fail("Draco mesh must have " + std::to_string(stated) + " " + what + ", as its accessors state (got " +
           std::to_string(got) + ")");
  };
  require("points", request.points, mesh->num_points());
  require("triangles", request.faces, mesh->num_faces());
  return mesh;
}

// The library does not check indices of meshes with sequential connectivity.
void write_indices(const draco::Mesh& mesh) {
  std::vector<double> indices;
  indices.reserve(std::size_t{3} * mesh.num_faces());
  for (draco::FaceIndex i(0); i < mesh.num_faces(); ++i)
    for (const draco::PointIndex& point : mesh.face(i)) {
      if (point.value() >= mesh.num_points())
        fail("indices of Draco mesh must be < " + std::to_string(mesh.num_points()) + " (got " +
             std::to_string(point.value()) + ")");
      indices.push_back(point.value());
    }
  const orrery::DecodedMeshHeader header{0};
  write_all(std::as_bytes(std::span(&header, 1)));
  write_all(std::as_bytes(std::span(indices)));
}

// Returns the attribute with integers that are not normalized. Ends the process if there is none with this
// number of components.
draco::PointAttribute& attribute_of(draco::Mesh& mesh, const Attribute& asked) {
  const int index = mesh.GetAttributeIdByUniqueId(asked.id);
  if (index < 0) fail("Draco mesh must have attribute " + std::to_string(asked.id));
  draco::PointAttribute& attribute = *mesh.attribute(index);
  if (static_cast<std::size_t>(attribute.num_components()) != asked.components)
    fail("attribute " + std::to_string(asked.id) + " of Draco mesh must have " +
         std::to_string(asked.components) + " components (got " + std::to_string(attribute.num_components()) +
         ")");
  attribute.set_normalized(false);
  return attribute;
}

void write_attribute(const draco::Mesh& mesh, const draco::PointAttribute& attribute) {
  constexpr std::size_t kAtOnce = 1 << 14;
  const auto components = static_cast<std::size_t>(attribute.num_components());
  std::vector<double> values;
  for (draco::PointIndex i(0); i < mesh.num_points(); ++i) {
    const draco::AttributeValueIndex entry = attribute.mapped_index(i);
    double point[4] = {};
    // A damaged mesh that ends here leaves its output incomplete.
    if (entry.value() >= attribute.size() ||
        !attribute.ConvertValue(entry, static_cast<std::int8_t>(components), point))
      std::_Exit(1);
    values.insert(values.end(), point, point + components);
    if (values.size() >= kAtOnce) write_all(std::as_bytes(std::span(values))), values.clear();
  }
  write_all(std::as_bytes(std::span(values)));
}

void run(const Request& request) {
  const std::span<const std::byte> bytes = orrery::map_input();
  if (bytes.empty()) fail("input is missing");
  orrery::limit_memory(request.memory_bytes);
  const std::unique_ptr<draco::Mesh> mesh = decode(bytes, request);
  std::vector<const draco::PointAttribute*> attributes;
  for (const Attribute& asked : request.attributes) attributes.push_back(&attribute_of(*mesh, asked));
  write_indices(*mesh);
  for (const draco::PointAttribute* const attribute : attributes) write_attribute(*mesh, *attribute);
}

}  // namespace

int main(int argc, char** argv) {
  constexpr rlim_t kMaxSeconds = 60;
  if (argc < 4) return 2;
  orrery::limit_process(kMaxSeconds);
  try {
    run(request_of(std::span(argv, static_cast<std::size_t>(argc))));
  } catch (const std::bad_alloc&) {
    fail("decoding a Draco mesh needs more memory than its accessors allow");
  }
  std::_Exit(0);  // skips cleanup by the library
}
