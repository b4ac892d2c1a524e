#include "server/api/render_options.h"

#include <algorithm>
#include <cmath>

#include "core/base/number.h"
#include "core/base/shorten.h"
#include "core/load/load.h"
#include "core/params/json.h"
#include "core/params/suggest.h"

namespace orrery {
namespace {

using Form = RenderOption::Form;

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  for (std::size_t comma; (comma = text.find(',', begin)) != std::string::npos; begin = comma + 1)
    parts.push_back(text.substr(begin, comma - begin));
  parts.push_back(text.substr(begin));
  return parts;
}

// Returns the number, or the text itself if it is not a number, so that the reader reports it.
nlohmann::json number_of(const std::string& text) {
  if (const auto whole = parse_number<std::int64_t>(text)) return *whole;  // a double would round it
  if (const auto number = parse_number<double>(text); number && std::isfinite(*number)) return *number;
  return text;
}

nlohmann::json value_of(const std::string& text, Form form) {
  switch (form) {
    case Form::number: return number_of(text);
    case Form::boolean:
      if (text == "true" || text == "false") return text == "true";
      return text;
    case Form::string: return text;
    case Form::strings: return text.empty() ? nlohmann::json::array() : nlohmann::json(split(text));
    case Form::numbers: break;
  }
  nlohmann::json list = nlohmann::json::array();
  for (const std::string& part : split(text)) list.push_back(number_of(part));
  return list;
}

InputError with_given_names(const InputError& error, std::span<const OptionText> texts) {
  std::vector<Problem> problems = error.problems();
  for (Problem& problem : problems) {
    for (const OptionText& text : texts) {
      const std::string pointer = text.option->pointer();
      if (!(problem.pointer + "/").starts_with(pointer + "/")) continue;
      problem.pointer.replace(0, pointer.size(), text.given_as);
      break;
    }
  }
  return InputError(std::move(problems));
}

}  // namespace

const RenderOption* find_render_option(std::string_view name) {
  for (const RenderOption& option : render_options())
    if (name == option.key || (name == option.short_name && !name.empty())) return &option;
  return nullptr;
}

std::vector<std::string_view> render_option_names() {
  std::vector<std::string_view> names;
  for (const RenderOption& option : render_options()) {
    names.push_back(option.key);
    if (!option.short_name.empty()) names.push_back(option.short_name);
  }
  return names;
}

std::vector<OptionText> option_texts(const Fields& query,
                                     const std::function<std::string(std::string_view)>& called,
                                     std::span<const std::string_view> more) {
  std::vector<std::string_view> names = render_option_names();
  names.insert(names.end(), more.begin(), more.end());
  std::vector<OptionText> texts;
  std::vector<Problem> problems;
  for (const auto& [name, value] : query) {
    if (std::find(more.begin(), more.end(), name) != more.end()) continue;
    const RenderOption* option = find_render_option(name);
    const bool again =
        std::any_of(texts.begin(), texts.end(), [&](const auto& t) { return t.option == option; });
    if (!option)
      problems.push_back({called(name), "unknown query parameter \"" + shortened(name, 40) + "\"" +
                                            did_you_mean_key(name, names)});
    else if (again)
      problems.push_back(
          {called(name), "cannot be used with \"" +
                             std::string(name == option->key ? option->short_name : option->key) +
                             "\", another name of the same option"});
    else
      texts.push_back({option, called(name), value});
  }
  if (!problems.empty()) throw InputError(std::move(problems));
  return texts;
}

RenderRequest read_option_texts(std::span<const OptionText> texts) {
  nlohmann::json request = nlohmann::json::object();
  for (const OptionText& text : texts)
    request[std::string(name_of(text.option->section))][std::string(text.option->key)] =
        value_of(text.text, text.option->form());
  try {
    return read_request(document_of(std::move(request)));
  } catch (const InputError& error) {
    throw with_given_names(error, texts);
  }
}

}  // namespace orrery
