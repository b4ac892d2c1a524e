#include "core/meshes/model_archive.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>

#include "core/base/task_scope.h"
#include "core/meshes/formats.h"
#include "core/meshes/text.h"

namespace orrery {
namespace {

constexpr ZipLimits kArchiveLimits{.unpacked_bytes = std::uint64_t{512} << 20};
constexpr std::size_t kListed = 5;         // models that an error lists
constexpr std::size_t kNameExcerpt = 120;  // characters of a name in errors
// Extensions of models. Those of glTF are first.
constexpr std::array<std::string_view, 6> kModelExtensions{".gltf", ".glb", ".obj", ".ply", ".stl", ".3mf"};
constexpr std::size_t kGltfExtensions = 2;

// Calls `visit(component)` for the components of a path. Backslashes separate components, too.
template <class Visit>
void each_component(std::string_view path, const Visit& visit) {
  while (!path.empty()) {
    const std::size_t end = std::min(path.find_first_of("/\\"), path.size());
    visit(path.substr(0, end));
    path.remove_prefix(std::min(end + 1, path.size()));
  }
}

// Returns the path without "." and "..", with slashes and relative to the archive. Returns nullopt if it
// leads out of the archive.
std::optional<std::string> path_in_archive(std::string_view path) {
  std::vector<std::string_view> parts;
  bool is_inside = true;
  each_component(path, [&](std::string_view part) {
    if (part.empty() || part == ".") return;
    if (part != "..") return parts.push_back(part);
    if (parts.empty())
      is_inside = false;
    else
      parts.pop_back();
  });
  if (!is_inside) return std::nullopt;
  std::string result;
  for (const std::string_view part : parts) result.append(result.empty() ? "" : "/").append(part);
  return result;
}

bool is_hidden(std::string_view path) {
  bool hidden = false;
  each_component(path, [&](std::string_view part) { hidden |= part.starts_with('.') || part == "__MACOSX"; });
  return hidden;
}

std::string folder_of(const std::string& path) { return path.substr(0, path.rfind('/') + 1); }

bool is_folder(std::string_view name) { return name.ends_with('/') || name.ends_with('\\'); }

// Candidate for the model of an archive. Candidates with lower ranks are preferred.
struct Candidate {
  std::pair<bool, std::ptrdiff_t> rank;  // whether it is no glTF file, and the number of its folders
  std::string path;
};

std::optional<Candidate> candidate_of(const std::string& path) {
  if (is_hidden(path)) return std::nullopt;
  const std::string lower = lower_case(path);
  for (std::size_t i = 0; i < kModelExtensions.size(); ++i)
    if (lower.ends_with(kModelExtensions[i]))
      return Candidate{{i >= kGltfExtensions, std::count(path.begin(), path.end(), '/')}, path};
  return std::nullopt;
}

// Returns the path of the best candidate. Throws InputError if there is none, or several of the same rank.
std::string model_of(std::vector<Candidate> candidates) {
  if (candidates.empty())
    throw InputError("", "archive must contain a model: .gltf, .glb, .obj, .ply, .stl or .3mf (got none)");
  const auto best =
      std::min_element(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
        return a.rank < b.rank;
      })->rank;
  std::erase_if(candidates, [&](const Candidate& each) { return each.rank != best; });
  if (candidates.size() == 1) return candidates.front().path;
  std::string list;
  for (std::size_t i = 0; i < std::min(candidates.size(), kListed); ++i)
    list += (i > 0 ? ", " : "") + excerpt(candidates[i].path, kNameExcerpt);
  throw InputError("", "archive must contain one model (got " + std::to_string(candidates.size()) + ": " +
                           list + (candidates.size() > kListed ? ", ..." : "") + ")");
}

}  // namespace

struct ModelArchive::Contents {
  ZipFile zip;
  std::map<std::string, std::string> names, names_in_lower_case;  // entries by normalized path

  explicit Contents(std::string_view bytes) : zip(bytes, kArchiveLimits) {}

  std::string read(const std::string& name, const std::string& folder) {
    const auto path = path_in_archive(folder + name);
    if (!path) throw InputError("", "must be in the archive (got " + excerpt(name, kNameExcerpt) + ")");
    auto found = names.find(*path);
    if (found == names.end()) {
      found = names_in_lower_case.find(lower_case(*path));
      if (found == names_in_lower_case.end())
        throw InputError("", "cannot read " + excerpt(name, kNameExcerpt) + ": not in the archive");
    }
    return zip.read(found->second);
  }
};

bool ModelArchive::is_archive(std::string_view bytes) {
  return ZipFile::is_zip(bytes) && !is_three_mf(bytes);
}

ModelArchive::ModelArchive(std::string_view bytes) : contents_(std::make_shared<Contents>(bytes)) {
  std::vector<Candidate> candidates;
  for (const std::string& name : contents_->zip.names()) {
    checkpoint();
    if (is_folder(name)) continue;
    const auto path = path_in_archive(name);
    if (!path)
      throw InputError("", "entry " + excerpt(name, kNameExcerpt) + ": must have a path inside the archive");
    contents_->names.emplace(*path, name);
    contents_->names_in_lower_case.emplace(lower_case(*path), name);
    if (auto candidate = candidate_of(*path)) candidates.push_back(std::move(*candidate));
  }
  model_ = model_of(std::move(candidates));
}

std::string ModelArchive::read_model_file() const {
  std::string bytes = contents_->read(model_, "");
  if (is_archive(bytes))
    throw InputError("", excerpt(model_, kNameExcerpt) + ": must not be an archive in an archive");
  return bytes;
}

ReadNearby ModelArchive::nearby() const {
  return [contents = contents_, folder = folder_of(model_)](const std::string& name) {
    return contents->read(name, folder);
  };
}

}  // namespace orrery
