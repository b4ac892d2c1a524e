#include "server/import/pbrt_parameters.h"

#include <algorithm>
#include <cmath>

#include "core/base/task_scope.h"
#include "core/meshes/text.h"
#include "core/params/params.h"

namespace orrery {
namespace {

constexpr std::array<std::string_view, 18> kTypes{
    "integer", "float", "point2",    "vector2",  "point3", "vector3", "normal3", "point", "vector",
    "normal",  "rgb",   "blackbody", "spectrum", "bool",   "string",  "texture", "color", "xyz"};

// Returns type and name of the text of a parameter.
PbrtParameter declared(const PbrtToken& token, const PbrtLexer& lexer) {
  TextReader words(token.text);
  PbrtParameter parameter;
  parameter.place = lexer.place_of(token);
  parameter.type = words.word();
  parameter.name = words.word();
  if (parameter.name.empty() || !words.word().empty())
    refuse_at(parameter.place, "parameter must have a type and a name, as in \"float radius\" (got " +
                                   excerpt(token.text) + ")");
  if (std::find(kTypes.begin(), kTypes.end(), parameter.type) == kTypes.end())
    refuse_at(parameter.place, "type of parameter " + excerpt(parameter.name) +
                                   " must be one of pbrt's, such as float (got " + excerpt(parameter.type) +
                                   ")");
  if (parameter.type == "color") parameter.type = "rgb";
  return parameter;
}

void add_value(PbrtParameter& parameter, const PbrtToken& value, const PbrtLexer& lexer) {
  const bool is_bool = value.text == "true" || value.text == "false";
  if (value.is(PbrtToken::Kind::text) || (value.is(PbrtToken::Kind::word) && is_bool))
    parameter.texts.push_back(unescaped(value.text));
  else
    parameter.numbers.push_back(lexer.number(value, "parameter " + excerpt(parameter.name)));
}

}  // namespace

SpectrumTable SpectrumFiles::read(const std::string& name, const ImportPlace& place) const {
  try {
    return read_spectrum(nearby_(name));
  } catch (const InputError& error) {
    refuse_at(place, "spectrum " + excerpt(name, 80) + ": " + error.problems().front().detail);
  }
}

PbrtParameters PbrtParameters::read(PbrtLexer& lexer) {
  PbrtParameters read;
  read.place_ = lexer.place();
  while (lexer.peek().is(PbrtToken::Kind::text)) {
    PbrtParameter parameter = declared(lexer.next(), lexer);
    if (lexer.peek().is(PbrtToken::Kind::open)) {
      lexer.next();
      PbrtToken value = lexer.next();
      for (; !value.is(PbrtToken::Kind::close); value = lexer.next()) {
        if (value.is(PbrtToken::Kind::end))
          refuse_at(parameter.place, "values of parameter " + excerpt(parameter.name) + " must end with ]");
        add_value(parameter, value, lexer);
      }
    } else {
      add_value(parameter, lexer.next(), lexer);
    }
    read.parameters_.push_back(std::move(parameter));
  }
  return read;
}

void PbrtParameters::add_defaults(const PbrtParameters& defaults) {
  for (const PbrtParameter& one : defaults.parameters_)
    if (find(one.name) == nullptr) parameters_.push_back(one);
}

const PbrtParameter* PbrtParameters::find(std::string_view name) const {
  for (const PbrtParameter& one : parameters_) {
    if (one.name != name) continue;
    one.used = true;
    return &one;
  }
  return nullptr;
}

const PbrtParameter* PbrtParameters::find(std::string_view type, std::string_view name) const {
  for (const PbrtParameter& one : parameters_) {
    if (one.name != name || one.type != type) continue;
    one.used = true;
    return &one;
  }
  return nullptr;
}

void PbrtParameters::refuse_size(const PbrtParameter& parameter, const std::string& needed) {
  refuse_at(parameter.place, "parameter " + excerpt(parameter.name) + " must have " + needed + " (got " +
                                 std::to_string(parameter.numbers.size()) + " numbers and " +
                                 std::to_string(parameter.texts.size()) + " texts)");
}

double PbrtParameters::one_number(const PbrtParameter& parameter) const {
  if (parameter.numbers.size() != 1 || !parameter.texts.empty()) refuse_size(parameter, "one number");
  return parameter.numbers.front();
}

double PbrtParameters::number(std::string_view name, double fallback) const {
  const PbrtParameter* const found = find(name);
  if (found == nullptr || found->type == "texture") return fallback;
  return one_number(*found);
}

double PbrtParameters::positive(std::string_view name, double fallback) const {
  const double value = number(name, fallback);
  if (value >= kMinLength && value <= kMaxLength) return value;
  const PbrtParameter* const found = find(name);
  refuse_at(found != nullptr ? found->place : place_,
            std::string(name) + " must be a number from 1e-12 to 1e12 (got " + number_text(value) + ")");
}

int PbrtParameters::integer(std::string_view name, int fallback, int least, int most) const {
  const double value = number(name, fallback);
  if (value == std::floor(value) && value >= least && value <= most) return static_cast<int>(value);
  refuse_at(find(name) != nullptr ? find(name)->place : place_,
            std::string(name) + " must be an integer from " + std::to_string(least) + " to " +
                std::to_string(most) + " (got " + number_text(value) + ")");
}

bool PbrtParameters::flag(std::string_view name, bool fallback) const {
  const PbrtParameter* const found = find("bool", name);
  if (found == nullptr) return fallback;
  if (found->texts.size() != 1 || (found->texts[0] != "true" && found->texts[0] != "false"))
    refuse_size(*found, "the value true or false");
  return found->texts[0] == "true";
}

std::string PbrtParameters::text(std::string_view name, const std::string& fallback) const {
  const PbrtParameter* const found = find("string", name);
  if (found == nullptr) return fallback;
  if (found->texts.size() != 1) refuse_size(*found, "one text");
  return found->texts.front();
}

std::string PbrtParameters::texture(std::string_view name) const {
  const PbrtParameter* const found = find("texture", name);
  if (found == nullptr) return {};
  if (found->texts.size() != 1) refuse_size(*found, "the name of a texture");
  return found->texts.front();
}

std::vector<double> PbrtParameters::numbers(std::string_view name) const {
  const PbrtParameter* const found = find(name);
  return found == nullptr ? std::vector<double>() : found->numbers;
}

std::vector<Vec3d> PbrtParameters::points(std::string_view name) const {
  const PbrtParameter* const found = find(name);
  if (found == nullptr) return {};
  if (found->numbers.size() % 3 != 0) refuse_size(*found, "three numbers for each point");
  std::vector<Vec3d> points(found->numbers.size() / 3);
  for (std::size_t i = 0; i < points.size(); ++i) {
    checkpoint(i);
    points[i] = {found->numbers[3 * i], found->numbers[3 * i + 1], found->numbers[3 * i + 2]};
  }
  return points;
}

std::vector<std::array<double, 2>> PbrtParameters::pairs(std::string_view name) const {
  const PbrtParameter* const found = find(name);
  if (found == nullptr) return {};
  if (found->numbers.size() % 2 != 0) refuse_size(*found, "two numbers for each point");
  std::vector<std::array<double, 2>> pairs(found->numbers.size() / 2);
  for (std::size_t i = 0; i < pairs.size(); ++i)
    pairs[i] = {found->numbers[2 * i], found->numbers[2 * i + 1]};
  return pairs;
}

Vec3d PbrtParameters::point(std::string_view name, const Vec3d& fallback) const {
  const PbrtParameter* const found = find(name);
  if (found == nullptr) return fallback;
  if (found->numbers.size() != 3) refuse_size(*found, "three numbers");
  return {found->numbers[0], found->numbers[1], found->numbers[2]};
}

namespace {

// Returns the spectrum of a list of wavelengths and values.
SpectrumTable table_of(const PbrtParameter& parameter) {
  if (parameter.numbers.empty() || parameter.numbers.size() % 2 != 0)
    refuse_at(parameter.place, "spectrum " + excerpt(parameter.name) +
                                   " must have a wavelength and a value for each point (got " +
                                   std::to_string(parameter.numbers.size()) + " numbers)");
  SpectrumTable table;
  for (std::size_t i = 0; i < parameter.numbers.size(); i += 2) {
    if (i > 0 && parameter.numbers[i] <= parameter.numbers[i - 2])
      refuse_at(parameter.place,
                "wavelengths must be in ascending order (got " + number_text(parameter.numbers[i]) + ")");
    table.points.emplace_back(parameter.numbers[i], parameter.numbers[i + 1]);
  }
  return table;
}

Vec3d rgb_value(const PbrtParameter& parameter) {
  if (parameter.numbers.size() != 3)
    refuse_at(parameter.place, "parameter " + excerpt(parameter.name) + " must have three numbers (got " +
                                   std::to_string(parameter.numbers.size()) + ")");
  return {parameter.numbers[0], parameter.numbers[1], parameter.numbers[2]};
}

double kelvin_of(const PbrtParameter& parameter) {
  const double kelvin = parameter.numbers.empty() ? 0 : parameter.numbers[0];
  if (parameter.numbers.size() == 1 && kelvin >= 100 && kelvin <= 1e6) return kelvin;
  refuse_at(parameter.place, "temperature of a black body must be a number from 100 to 1,000,000 K (got " +
                                 number_text(kelvin) + ")");
}

}  // namespace

std::optional<Vec3d> PbrtParameters::light_color(std::string_view name, const SpectrumFiles& files) const {
  const PbrtParameter* const found = find(name);
  if (found == nullptr || found->type == "texture") return std::nullopt;
  if (found->type == "rgb") return rgb_value(*found);
  if (found->type == "xyz") return with_unit_luminance(rgb_of_xyz(rgb_value(*found)));
  if (found->type == "blackbody") return with_unit_luminance(emitted_rgb_of_blackbody(kelvin_of(*found)));
  if (!found->texts.empty()) {
    if (const auto known = illuminant_rgb(found->texts[0])) return *known;
    return with_unit_luminance(emitted_rgb(files.read(found->texts[0], found->place)));
  }
  return with_unit_luminance(emitted_rgb(table_of(*found)));
}

std::optional<Vec3d> PbrtParameters::surface_color(std::string_view name, const SpectrumFiles& files) const {
  const PbrtParameter* const found = find(name);
  if (found == nullptr || found->type == "texture") return std::nullopt;
  if (found->type == "rgb") return rgb_value(*found);
  if (found->type == "xyz") return rgb_of_xyz(rgb_value(*found));
  if (found->type == "float") return Vec3d(one_number(*found));
  if (found->type == "blackbody") return with_unit_luminance(emitted_rgb_of_blackbody(kelvin_of(*found)));
  if (!found->texts.empty()) return reflected_rgb(files.read(found->texts[0], found->place));
  return reflected_rgb(table_of(*found));
}

SpectrumTable PbrtParameters::index_table(std::string_view name, const SpectrumFiles& files) const {
  const PbrtParameter& found = *find(name);
  return found.texts.empty() ? table_of(found) : files.read(found.texts[0], found.place);
}

void PbrtParameters::require_few_numbers(std::size_t most) const {
  for (const PbrtParameter& one : parameters_)
    if (one.numbers.size() > most || one.texts.size() > most)
      refuse_size(one, "at most " + std::to_string(most) + " values");
}

void PbrtParameters::ignore(std::initializer_list<std::string_view> names) const {
  for (const std::string_view name : names) find(name);
}

void PbrtParameters::note_unused(ImportNotes& notes, const std::string& owner) const {
  for (const PbrtParameter& one : parameters_)
    if (!one.used) notes.add("parameter " + excerpt(one.name) + " of " + owner + " has no effect");
}

std::vector<double> read_numbers(PbrtLexer& lexer, std::size_t count, std::string_view name) {
  const bool in_brackets = lexer.peek().is(PbrtToken::Kind::open);
  if (in_brackets) lexer.next();
  std::vector<double> numbers(count);
  for (double& number : numbers) number = lexer.number(lexer.next(), name);
  if (in_brackets && !lexer.next().is(PbrtToken::Kind::close))
    refuse_at(lexer.place(),
              std::string(name) + " must have " + std::to_string(count) + " numbers (got more)");
  return numbers;
}

}  // namespace orrery
