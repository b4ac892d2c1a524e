#include "core/meshes/gltf_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>

#include "core/base/task_scope.h"
#include "core/meshes/formats.h"
#include "core/meshes/gltf_draco.h"
#include "core/meshes/gltf_meshopt.h"
#include "core/meshes/text.h"

// glTF 2.0 (Khronos, ISO/IEC 12113:2022): sections 3.6 (binary data) and 4 (GLB).
namespace orrery {
namespace {

template <class T>
T little_endian(const char* bytes) {
  std::array<char, sizeof(T)> copy;
  std::memcpy(copy.data(), bytes, sizeof(T));
  if constexpr (std::endian::native == std::endian::big) std::reverse(copy.begin(), copy.end());
  return std::bit_cast<T>(copy);
}

template <class T, bool normalized>
double load(const char* bytes) {
  const double value = static_cast<double>(little_endian<T>(bytes));
  if constexpr (normalized) return std::max(value / static_cast<double>(std::numeric_limits<T>::max()), -1.0);
  return value;
}

struct ComponentType {
  std::uint64_t code;
  std::size_t bytes;
  double (*load)(const char*);
  double (*load_normalized)(const char*);
  double most;  // largest integer, or 0 for floating point numbers
};
template <class T>
constexpr ComponentType integers(std::uint64_t code) {
  return {code, sizeof(T), load<T, false>, load<T, true>, static_cast<double>(std::numeric_limits<T>::max())};
}
constexpr ComponentType kComponentTypes[] = {
    integers<std::int8_t>(5120),   integers<std::uint8_t>(5121),
    integers<std::int16_t>(5122),  integers<std::uint16_t>(5123),
    integers<std::uint32_t>(5125), {5126, 4, load<float, false>, load<float, false>, 0}};

ComponentType component_type(const GltfValue& code) {
  for (const ComponentType& type : kComponentTypes)
    if (type.code == code.integer()) return type;
  code.fail("must be a component type: 5120 to 5123, 5125 or 5126 (got " + std::to_string(code.integer()) +
            ")");
}

struct Chunks {
  std::string_view json, binary;
};

// Splits a GLB file into chunks. The file has a header (magic, version, length) and chunks (length, type,
// bytes), the JSON chunk first. Each number has 4 bytes.
Chunks split_glb(std::string_view bytes) {
  constexpr std::uint32_t kJson = 0x4e4f534a, kBinary = 0x004e4942;
  const auto word = [&](std::size_t at) { return little_endian<std::uint32_t>(bytes.data() + at); };
  if (bytes.size() < 12)
    throw InputError(
        "", "file must begin with a GLB header of 12 bytes (got " + std::to_string(bytes.size()) + " bytes)");
  if (word(4) != 2) fail_at("byte 4", "must be GLB version 2 (got " + std::to_string(word(4)) + ")");
  if (word(8) > bytes.size())
    fail_at("byte 8", "GLB length must be at most the file size, " + std::to_string(bytes.size()) +
                          " bytes (got " + std::to_string(word(8)) + ")");
  bytes = bytes.substr(0, word(8));
  Chunks chunks;
  std::size_t at = 12;
  while (bytes.size() >= at + 8) {
    const std::size_t left = bytes.size() - at - 8;
    if (word(at) > left)
      fail_at("byte " + std::to_string(at), "must be a GLB chunk of at most " + std::to_string(left) +
                                                " bytes (got " + std::to_string(word(at)) + ")");
    const std::string_view chunk = bytes.substr(at + 8, word(at));
    if (at == 12 && word(at + 4) == kJson) chunks.json = chunk;
    if (at > 12 && word(at + 4) == kBinary && chunks.binary.empty()) chunks.binary = chunk;
    at += 8 + chunk.size();
  }
  if (chunks.json.empty()) fail_at("byte 12", "must be a non-empty GLB chunk of type \"JSON\" (got none)");
  return chunks;
}

std::array<std::int8_t, 256> base64_digits() {
  std::array<std::int8_t, 256> digits;
  digits.fill(-1);
  constexpr std::string_view kAlphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (std::size_t i = 0; i < kAlphabet.size(); ++i)
    digits[static_cast<unsigned char>(kAlphabet[i])] = static_cast<std::int8_t>(i);
  return digits;
}

// Decodes base64 (RFC 4648). Padding is optional.
std::string decode_base64(std::string_view text, const GltfValue& place) {
  while (text.ends_with('=')) text.remove_suffix(1);
  if (text.size() % 4 == 1)
    place.fail("must be base64 (got " + std::to_string(text.size()) +
               " digits, one more than a multiple of 4)");
  const auto digits = base64_digits();
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3 + 2);
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const int digit = digits[static_cast<unsigned char>(text[i])];
    if (digit < 0)
      place.fail("must be base64 (got " + excerpt(text.substr(i, 1)) + " at digit " + std::to_string(i) +
                 ")");
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    const std::size_t pending = (i + 1) * 6 % 8;  // bits of an incomplete byte after this digit
    if (i % 4 != 0) bytes.push_back(static_cast<char>(bits >> pending));
  }
  return bytes;
}

// Decodes %20 and the like (RFC 3986).
std::string decode_percent(const std::string& text) {
  std::string decoded;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned code = 0;
    if (text[i] == '%' && i + 2 < text.size() &&
        std::from_chars(text.data() + i + 1, text.data() + i + 3, code, 16).ptr == text.data() + i + 3) {
      decoded += static_cast<char>(code);
      i += 2;
    } else {
      decoded += text[i];
    }
  }
  return decoded;
}

std::size_t components_of(std::string_view type) {
  return type == "SCALAR" ? 1 : type == "VEC2" ? 2 : type == "VEC3" ? 3 : type == "MAT4" ? 16 : 4;
}

// Returns the numbers of elements that follow each other.
GltfNumbers numbers_of(const std::vector<double>& values, std::size_t components) {
  return {reinterpret_cast<const char*>(values.data()),
          values.size() / components,
          components * sizeof(double),
          components,
          sizeof(double),
          [](const char* bytes) {
            double value;
            std::memcpy(&value, bytes, sizeof value);
            return value;
          }};
}

// Attributes that are read from a Draco mesh.
constexpr const char* kDracoAttributes[] = {"POSITION",   "NORMAL",     "COLOR_0",    "TEXCOORD_0",
                                            "TEXCOORD_1", "TEXCOORD_2", "TEXCOORD_3", "TEXCOORD_4",
                                            "TEXCOORD_5", "TEXCOORD_6", "TEXCOORD_7", "JOINTS_0",
                                            "JOINTS_1",   "WEIGHTS_0",  "WEIGHTS_1"};

// Maximum size of all files that a file names, and of all decoded buffer views.
constexpr std::size_t kMaxFileBytes = std::size_t{1} << 30;

// Maximum number of values of an accessor that is not in a buffer, and of all of them.
constexpr std::uint64_t kMaxUnpacked = 30'000'000, kMaxUnpackedInAll = 100'000'000;

}  // namespace

GltfFile::GltfFile(std::string_view bytes, const ReadNearby& nearby) : nearby_(nearby) {
  Chunks chunks{bytes, {}};
  if (bytes.starts_with("glTF")) chunks = split_glb(bytes);
  document_ = parse_gltf(chunks.json);
  binary_ = chunks.binary;
  const GltfValue version = root().at("asset").at("version");
  if (!version.text().starts_with("2."))
    version.fail("must be \"2.0\" (got " + excerpt(version.text()) +
                 "); gltf-pipeline or Blender convert older files");
  if (const auto buffers = root().find("buffers")) buffers_.resize(buffers->size());
}

std::string_view GltfFile::bytes_of(const GltfValue& uri) {
  const std::string& text = uri.text();
  constexpr std::string_view kMark = ";base64,";
  const std::size_t comma = text.find(',');
  if (text.starts_with("data:") && comma != text.npos && text.substr(0, comma + 1).ends_with(kMark))
    return decoded_.emplace_back(decode_base64(std::string_view(text).substr(comma + 1), uri));
  if (!nearby_ || text.starts_with("data:") || text.find("://") != text.npos)
    uri.fail("must be a data: URI in base64" + std::string(nearby_ ? ", or the name of a file" : "") +
             ", because other files are not read (got " + excerpt(text) +
             "); a .glb file contains its buffers");
  const std::string name = decode_percent(text);
  if (const auto known = files_.find(name); known != files_.end()) return known->second;
  try {
    std::string bytes = nearby_(name);
    file_bytes_ += bytes.size();
    if (file_bytes_ > kMaxFileBytes)
      throw InputError("", "files of the model have more than " + grouped(kMaxFileBytes) + " bytes (limit " +
                               grouped(kMaxFileBytes) + ")");
    return files_[name] = std::move(bytes);
  } catch (const InputError& error) {
    uri.fail(error.problems().front().detail);
  }
}

std::string_view GltfFile::image_bytes(const GltfValue& image) {
  if (const auto uri = image.find("uri")) return bytes_of(*uri);
  return view(image.at("bufferView"));
}

std::string_view GltfFile::buffer(const GltfValue& user) {
  const std::size_t index = user.integer();
  const GltfValue buffer = root().at("buffers").item(index);
  Buffer& entry = buffers_[index];
  if (entry.decoded) return entry.bytes;
  if (const auto uri = buffer.find("uri")) {
    entry.bytes = bytes_of(*uri);
  } else {
    if (index != 0 || binary_.empty()) buffer.fail("missing key \"uri\"");
    entry.bytes = binary_;
  }
  const GltfValue length = buffer.at("byteLength");
  if (length.integer() > entry.bytes.size())
    length.fail("must be at most " + std::to_string(entry.bytes.size()) + ", the buffer size in bytes (got " +
                std::to_string(length.integer()) + ")");
  entry.bytes = entry.bytes.substr(0, length.integer());
  entry.decoded = true;
  return entry.bytes;
}

std::string_view GltfFile::bytes_in(const GltfValue& range) {
  const std::string_view bytes = buffer(range.at("buffer"));
  const std::uint64_t offset = integer_or(range, "byteOffset", 0), length = range.at("byteLength").integer();
  if (offset > bytes.size() || length > bytes.size() - offset)
    range.fail("byteOffset + byteLength must be at most " + std::to_string(bytes.size()) +
               ", the buffer size in bytes (got " + std::to_string(offset) + " + " + std::to_string(length) +
               ")");
  return bytes.substr(offset, length);
}

std::string_view GltfFile::view(const GltfValue& user) {
  const GltfValue view = root().at("bufferViews").item(user.integer());
  const auto extension = extension_of(view, "EXT_meshopt_compression");
  return extension ? expanded(user.integer(), view, *extension) : bytes_in(view);
}

std::string_view GltfFile::expanded(std::uint64_t index, const GltfValue& view, const GltfValue& extension) {
  if (const auto known = expanded_.find(index); known != expanded_.end()) return known->second;
  const MeshoptView compressed(view, extension);
  expanded_bytes_ += compressed.decoded_bytes();
  if (compressed.decoded_bytes() > kMaxFileBytes || expanded_bytes_ > kMaxFileBytes)
    extension.fail("compressed buffer views have more than " + grouped(kMaxFileBytes) +
                   " decoded bytes (limit " + grouped(kMaxFileBytes) + ")");
  return expanded_[index] = compressed.decode(bytes_in(extension));
}

GltfNumbers GltfFile::elements(const GltfValue& place, std::uint64_t count, std::string_view type,
                               const GltfValue& component_type, bool normalized) {
  const ComponentType component = orrery::component_type(component_type);
  GltfNumbers numbers{};
  numbers.components = components_of(type);
  numbers.component_bytes = component.bytes;
  numbers.load = normalized ? component.load_normalized : component.load;
  const std::size_t element = numbers.components * component.bytes;

  const GltfValue view_index = place.at("bufferView");
  const std::string_view bytes = view(view_index);
  const std::uint64_t offset = integer_or(place, "byteOffset", 0);
  numbers.stride = integer_or(root().at("bufferViews").item(view_index.integer()), "byteStride", element);
  if (numbers.stride < element || numbers.stride > 252)
    place.fail("byteStride must be from " + std::to_string(element) + " to 252 (got " +
               std::to_string(numbers.stride) + ")");
  if (count == 0 || offset > bytes.size() || element > bytes.size() - offset ||
      count - 1 > (bytes.size() - offset - element) / numbers.stride)
    place.fail("must have at least 1 element of " + std::to_string(element) + " bytes, " +
               std::to_string(numbers.stride) + " bytes apart, within the " + std::to_string(bytes.size()) +
               " bytes of the buffer view (got " + std::to_string(count) + " elements from byte " +
               std::to_string(offset) + ")");
  numbers.count = count;
  numbers.data = bytes.data() + offset;
  return numbers;
}

GltfNumbers GltfFile::unpacked(const GltfValue& accessor, std::uint64_t count, std::string_view type,
                               bool normalized) {
  const std::size_t components = components_of(type);
  if (count == 0 || count > kMaxUnpacked / components)
    accessor.fail("count must be from 1 to " + grouped(kMaxUnpacked / components) + " (got " +
                  std::to_string(count) + ")");
  unpacked_values_ += count * components;
  if (unpacked_values_ > kMaxUnpackedInAll)
    accessor.fail("sparse accessors, and those without a buffer view, have more than " +
                  grouped(kMaxUnpackedInAll) + " numbers (limit " + grouped(kMaxUnpackedInAll) + ")");
  std::vector<double>& values = unpacked_.emplace_back(count * components);
  if (accessor.find("bufferView")) {
    const GltfNumbers dense = elements(accessor, count, type, accessor.at("componentType"), normalized);
    for (std::size_t k = 0; k < values.size(); ++k) values[k] = dense.value(k / components, k % components);
  }
  if (const auto sparse = accessor.find("sparse")) {
    const GltfValue replaced = sparse->at("indices");
    const std::uint64_t replacements = sparse->at("count").integer();
    if (replacements > count)
      sparse->at("count").fail("must be at most " + std::to_string(count) +
                               ", the count of the accessor (got " + std::to_string(replacements) + ")");
    const GltfNumbers places =
        elements(replaced, replacements, "SCALAR", replaced.at("componentType"), false);
    const GltfNumbers replacing =
        elements(sparse->at("values"), replacements, type, accessor.at("componentType"), normalized);
    double before = -1;
    for (std::size_t i = 0; i < places.count; ++i) {
      checkpoint(i);
      const double at = places.value(i, 0);
      if (!(at > before && at < static_cast<double>(count) && at == std::floor(at)))
        replaced.fail("indices must be ascending integers >= 0 and < " + std::to_string(count) + " (got " +
                      text_of(at) + " at entry " + std::to_string(i) + ")");
      before = at;
      for (std::size_t c = 0; c < components; ++c)
        values[static_cast<std::size_t>(at) * components + c] = replacing.value(i, c);
    }
  }
  return numbers_of(values, components);
}

void GltfFile::decode_primitive(const GltfValue& primitive, const MeshLimits& limits) {
  const auto extension = extension_of(primitive, "KHR_draco_mesh_compression");
  if (!extension) return;
  if (integer_or(primitive, "mode", 4) != 4) primitive.at("mode").fail("must be 4 for a Draco mesh");
  const auto accessor_of = [&](const GltfValue& user) { return root().at("accessors").item(user.integer()); };
  const GltfValue view_index = extension->at("bufferView"), indices = primitive.at("indices");
  std::vector<std::uint64_t> key{view_index.integer(), indices.integer()};
  std::vector<DracoAttribute> attributes;
  std::vector<GltfValue> users;
  for (const char* const name : kDracoAttributes) {
    const auto id = extension->at("attributes").find(name), user = primitive.at("attributes").find(name);
    if (!id || !user) continue;
    attributes.push_back({id->integer(), components_of(accessor_of(*user).at("type").text())});
    users.push_back(*user);
    key.insert(key.end(), {id->integer(), user->integer()});
  }
  if (!decoded_primitives_.insert(std::move(key)).second) return;
  const std::uint64_t points = accessor_of(primitive.at("attributes").at("POSITION")).at("count").integer(),
                      corners = accessor_of(indices).at("count").integer();
  check_vertices(points, limits);
  check_triangles(corners / 3, limits);
  if (corners % 3 != 0) indices.fail("count must be a multiple of 3 (got " + std::to_string(corners) + ")");
  try {
    DracoMesh mesh = decode_draco(view(view_index), points, corners / 3, attributes);
    set_accessor(indices, std::move(mesh.indices));
    for (std::size_t i = 0; i < users.size(); ++i) set_accessor(users[i], std::move(mesh.attributes[i]));
  } catch (const InputError& error) {
    extension->fail(error.problems().front().detail);
  }
}

void GltfFile::set_accessor(const GltfValue& user, std::vector<double> values) {
  const GltfValue accessor = root().at("accessors").item(user.integer());
  const auto flag = accessor.find("normalized");
  const ComponentType type = component_type(accessor.at("componentType"));
  if (flag && flag->flag() && type.most > 0)
    for (double& value : values) value = std::max(value / type.most, -1.0);
  known_[user.integer()] =
      numbers_of(unpacked_.emplace_back(std::move(values)), components_of(accessor.at("type").text()));
}

GltfNumbers GltfFile::accessor(const GltfValue& user, std::string_view type) {
  const GltfValue accessor = root().at("accessors").item(user.integer());
  const GltfValue stated = accessor.at("type");
  if (stated.text() != type)
    stated.fail("must be " + excerpt(type) + " (got " + excerpt(stated.text()) + ")");
  const auto flag = accessor.find("normalized");
  const bool normalized = flag && flag->flag();
  const std::uint64_t count = accessor.at("count").integer();
  if (const auto known = known_.find(user.integer()); known != known_.end()) return known->second;
  if (accessor.find("sparse") || !accessor.find("bufferView"))
    return known_[user.integer()] = unpacked(accessor, count, type, normalized);
  return elements(accessor, count, type, accessor.at("componentType"), normalized);
}

GltfNumbers GltfFile::attribute(const GltfValue& user, std::string_view type, std::size_t count) {
  const GltfNumbers numbers = accessor(user, type);
  if (numbers.count != count)
    user.fail("must have " + std::to_string(count) + " elements, one per position (got " +
              std::to_string(numbers.count) + ")");
  return numbers;
}

}  // namespace orrery
