#include "parameters/files/strict_xml.hpp"

#include <expat.h>

#include <algorithm>
#include <list>
#include <memory>
#include <vector>

#include "base/errors.hpp"
#include "base/shortened.hpp"
#include "parameters/files/claim_name.hpp"
#include "parameters/formula.hpp"
#include "parameters/mistakes.hpp"
#include "parameters/strict_values.hpp"
#include "parameters/suggestion.hpp"

namespace lockstep {

namespace {

using Attributes = std::map<std::string, std::string>;

/// Builds the list while expat reports the elements. A callback must not throw through expat:
/// mistakes are noted, and thrown at the end.
class Reader {
 public:
  Reader(const std::string& name, FormulaPolicy formulas)
      : formulas_(formulas),
        parser_(XML_ParserCreate(nullptr), XML_ParserFree),
        document_{ParameterList(name), {}} {
    document_.source.file = name;
    XML_SetUserData(parser_.get(), this);
    XML_SetElementHandler(parser_.get(), on_start, on_end);
    XML_SetCharacterDataHandler(parser_.get(), on_text);
    XML_SetStartDoctypeDeclHandler(parser_.get(), on_doctype);
  }

  Document read(const std::string& text) {
    const std::string& file = document_.source.file;
    check_input(!trimmed(text).empty(), "{} is empty; a parameter file holds one <ParameterList>.",
                file);
    const auto status = XML_Parse(parser_.get(), text.data(), static_cast<int>(text.size()), 1);
    if (status != XML_STATUS_OK)
      note(malformed());
    if (is_broken_)
      mistakes_.throw_all();
    return std::move(document_);
  }

 private:
  struct OpenList {
    ParameterList* list;
    std::string path;
    int line;
  };

  static Reader& self(void* data) { return *static_cast<Reader*>(data); }
  static void on_start(void* data, const XML_Char* element, const XML_Char** attributes) {
    self(data).guard([&] {
      Attributes map;
      for (; *attributes; attributes += 2)
        map[attributes[0]] = attributes[1];
      self(data).start(element, map);
    });
  }
  static void on_end(void* data, const XML_Char* element) {
    self(data).guard([&] { self(data).end(element); });
  }
  static void on_text(void* data, const XML_Char* text, int length) {
    self(data).guard([&] {
      const std::string word = trimmed(std::string(text, length));
      check_input(word.empty(),
                  "the text \"{}\" stands between the elements; only <ParameterList>, <Parameter> "
                  "and comments may.",
                  shortened(word));
    });
  }
  static void on_doctype(void* data, const XML_Char*, const XML_Char*, const XML_Char*, int) {
    self(data).guard([] { throw InputError("a parameter file has no <!DOCTYPE>; remove it."); });
  }

  template <typename Work>
  void guard(Work work) {
    try {
      work();
    } catch (const std::exception& error) {
      note(fmt::format("{}: {}", here(), error.what()));
    }
  }

  /// A mistake for which the rest of the document is of no use, but to look for more of them.
  void note(const std::string& message) {
    mistakes_.add(message);
    is_broken_ = true;
  }

  int line() const { return static_cast<int>(XML_GetCurrentLineNumber(parser_.get())); }
  std::string here() const { return fmt::format("{}, line {}", document_.source.file, line()); }

  std::string malformed() const {
    const XML_Error code = XML_GetErrorCode(parser_.get());
    std::string hint;
    const bool unclosed = code == XML_ERROR_TAG_MISMATCH || code == XML_ERROR_NO_ELEMENTS;
    if (unclosed && n_open_parameters_ > 0) {
      hint = fmt::format(" The <Parameter> of line {} is not closed; end it with \"/>\".",
                         parameter_line_);
    } else if (unclosed && !open_.empty()) {
      hint = fmt::format(" The <ParameterList> of line {} is not closed.", open_.back().line);
    }
    return fmt::format("{}: this is not well-formed XML ({}).{}", here(), XML_ErrorString(code),
                       hint);
  }

  void start(const std::string& element, const Attributes& attributes) {
    const bool is_parameter = element == "Parameter" && !open_.empty();
    const bool is_within_parameter = n_open_parameters_ > 0;
    const std::size_t n_open = open_.size();
    if (is_parameter) {
      ++n_open_parameters_;
      parameter_line_ = line();
    }
    guard([&] {
      check_input(!is_within_parameter, "a <Parameter> holds nothing; end it with \"/>\".");
      if (n_open <= most_nested_lists)  // deeper ones have been told of
        start_element(element, attributes);
    });
    if (!is_parameter && open_.size() == n_open)  // a dropped list may hold mistakes, too
      open_.push_back({&dropped_.emplace_back(), n_open == 0 ? "" : open_.back().path, line()});
  }

  void start_element(const std::string& element, const Attributes& attributes) {
    if (element == "ParameterList") {
      start_list(attributes);
    } else if (open_.empty()) {
      throw InputError(fmt::format("the file must hold one <ParameterList>, not <{}>.", element));
    } else if (element == "Parameter") {
      add_parameter(attributes);
    } else {
      const std::string nearest = nearest_name(element, {"Parameter", "ParameterList"});
      throw InputError(fmt::format("{}, <{}> is not an element of a parameter file.{}",
                                   in_list(open_.back().path), element,
                                   nearest.empty() ? "" : " Did you mean <" + nearest + ">?"));
    }
  }

  void end(const std::string& element) {
    if (element == "Parameter" && n_open_parameters_ > 0) {
      --n_open_parameters_;
    } else {
      open_.pop_back();
    }
  }

  void start_list(const Attributes& attributes) {
    check_attributes("ParameterList", attributes, {"name"}, {"docString", "id"});
    if (open_.empty()) {
      open_.push_back({&document_.list, "", line()});
      return;
    }
    const std::string name = attributes.count("name") ? attributes.at("name") : "";
    check_input(open_.size() < most_nested_lists,
                "lists are nested more than {} deep, which no parameter file needs; close some "
                "<ParameterList>.",
                most_nested_lists);
    const std::string path = claim("ParameterList", name);
    ParameterList& list = open_.back().list->sublist(name);
    open_.push_back({&list, path, line()});
  }

  void add_parameter(const Attributes& attributes) {
    const std::string name = attributes.count("name") ? attributes.at("name") : "";
    check_attributes("Parameter", attributes, {"name", "type", "value"},
                     {"docString", "id", "isDefault", "isUsed"});
    claim("Parameter", name);
    try {
      ParameterEntry entry = value_of(attributes);
      if (attributes.count("docString"))
        entry.setDocString(attributes.at("docString"));
      open_.back().list->setEntry(name, entry);
    } catch (const InputError& error) {
      const std::string message =
          fmt::format("{}: {}, \"{}\" {}.", here(), in_list(open_.back().path), name, error.what());
      mistakes_.add(message);
      is_broken_ = is_broken_ || formulas_ == FormulaPolicy::refused;
      open_.back().list->setEntry(name, ParameterEntry(Mistake{{message}}));
    }
  }

  /// Throws InputError with the predicate of a sentence.
  ParameterEntry value_of(const Attributes& attributes) const {
    const std::string &type_text = attributes.at("type"), &text = attributes.at("value");
    const auto type = value_type(type_text);
    check_input(type.has_value(), "has the unknown type \"{}\"; types are {}", shortened(type_text),
                known_type_names());
    if (formulas_ == FormulaPolicy::kept && is_formula(*type, text))
      return ParameterEntry(Formula{*type, text});
    try {
      return parse_value(*type, text);
    } catch (const InputError& error) {
      throw InputError(fmt::format("{} (type \"{}\")", error.what(), type_text));
    }
  }

  void check_attributes(const std::string& element, const Attributes& attributes,
                        const std::vector<std::string>& required,
                        const std::vector<std::string>& others) const {
    std::vector<std::string> known = required;
    known.insert(known.end(), others.begin(), others.end());
    const auto name = attributes.find("name");
    const std::string which =
        name == attributes.end() ? "" : fmt::format(" of \"{}\"", shortened(name->second));
    for (const auto& [key, value] : attributes) {
      if (std::find(known.begin(), known.end(), key) != known.end())
        continue;
      const std::string nearest = nearest_name(key, known);
      throw InputError(fmt::format("\"{}\" is not an attribute of <{}>{}.{}", key, element, which,
                                   nearest.empty() ? "" : " Did you mean \"" + nearest + "\"?"));
    }
    const bool root = open_.empty();
    for (const std::string& key : required) {
      check_input(root || attributes.count(key), "the <{}>{} has no attribute \"{}\".", element,
                  which, key);
    }
  }

  /// Takes the name in the open list and notes its line; gives its path.
  std::string claim(const std::string& element, const std::string& name) {
    const OpenList& open = open_.back();
    check_input(!trimmed(name).empty(), "the <{}> has an empty name.", element);
    return claim_name(document_, *open.list, open.path, name, here());
  }

  FormulaPolicy formulas_;
  std::unique_ptr<XML_ParserStruct, decltype(&XML_ParserFree)> parser_;
  Document document_;
  std::vector<OpenList> open_;
  int n_open_parameters_ = 0;  ///< more than one by mistake
  int parameter_line_ = 0;
  std::list<ParameterList> dropped_;  ///< lists that stand where they must not
  Mistakes mistakes_;
  bool is_broken_ = false;
};

}  // namespace

Document read_xml_string(const std::string& text, const std::string& name, FormulaPolicy formulas) {
  return Reader(name, formulas).read(text);
}

}  // namespace lockstep
