#include "parameters/files/strict_yaml.hpp"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <vector>

#include "base/errors.hpp"
#include "base/shortened.hpp"
#include "parameters/files/claim_name.hpp"
#include "parameters/mistakes.hpp"
#include "parameters/strict_values.hpp"
#include "parameters/untyped.hpp"

namespace lockstep {

namespace {

/// Characters that XML cannot hold, as which a run writes down its parameters.
bool has_control_character(const std::string& text) {
  return std::any_of(text.begin(), text.end(), [](unsigned char c) {
    return c < 0x20 && c != '\t' && c != '\n' && c != '\r';
  });
}

bool is_utf8(const std::string& text) {
  try {
    nlohmann::json(text).dump();
    return true;
  } catch (const nlohmann::json::exception&) {
    return false;
  }
}

/// Builds the list while yaml-cpp reports what it reads. Mistakes are noted, and thrown at the end.
class YamlReader : public YAML::EventHandler {
 public:
  explicit YamlReader(const std::string& name) : document_{ParameterList(name), {}} {
    document_.source.file = name;
  }

  Document read(const std::string& text) {
    const std::string& file = document_.source.file;
    check_input(is_utf8(text), "{} is no text in UTF-8.", file);
    check_input(trimmed(text).substr(0, 1) != "<",
                "{} is XML, not YAML: let its name end in \".xml\".", file);
    try {
      std::istringstream stream(text);
      YAML::Parser parser(stream);
      while (parser.HandleNextDocument(*this))
        continue;
    } catch (const YAML::Exception& error) {
      note(error.mark, fmt::format("this is not well-formed YAML ({}).", error.msg));
    } catch (const InputError& error) {
      mistakes_.add(error.what());
    }
    if (mistakes_.empty() && n_documents_ == 0)
      mistakes_.add(fmt::format("{} is empty; a parameter file holds names and values.", file));
    mistakes_.throw_all();
    return std::move(document_);
  }

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (++n_documents_ == 1)
      return;
    note(mark, "a second document begins here; a parameter file holds one.");
    mistakes_.throw_all();
  }
  void OnDocumentEnd() override {}

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& text) override {
    check_features(mark, tag, anchor);
    if (has_control_character(text))
      note(mark, fmt::format("\"{}\" holds a control character; take it out.", shortened(text)));
    if (n_dropped_ == 0 && expects_name())
      take_name(mark, text);
    else
      take_value(mark, {text, tag == "!"});
  }

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    check_features(mark, "?", anchor);
    if (n_dropped_ > 0)
      return;
    if (expects_name())
      return take_name(mark, "");
    if (open_.empty())
      note(mark, "a parameter file holds names and values.");
    else if (open_.back().array)
      note(mark, fmt::format("a component of the array \"{}\" has no value.", name_));
    else
      note(name_mark_,
           fmt::format("{}, \"{}\" has no value; {}", in_list(open_.back().path), shortened(name_),
                       open_.back().is_flow ? "an array is written in brackets: [1, 2, 3]."
                                            : "a list without parameters is written {}."));
    name_taken_ = false;
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
    note(mark, no_anchors);
    if (n_dropped_ == 0)
      name_taken_ = expects_name();
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    check_features(mark, tag, anchor);
    if (n_dropped_ > 0 || expects_name())
      return drop(mark, "a name cannot be an array.");
    if (open_.empty())
      return drop(mark, "a parameter file holds names and values, not an array.");
    if (open_.back().array)
      return drop(mark,
                  "arrays do not nest; a formula in brackets is written in quotes: \"[2*R]\".");
    open_.push_back({open_.back().list, "", false, Untyped{{}, true}});
  }

  void OnSequenceEnd() override {
    if (n_dropped_ > 0)
      return close_dropped();
    open_.back().list->setEntry(name_, ParameterEntry(*open_.back().array));
    open_.pop_back();
    name_taken_ = false;
  }

  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value style) override {
    check_features(mark, tag, anchor);
    if (n_dropped_ > 0 || expects_name())
      return drop(mark, "a name cannot be a list.");
    if (!open_.empty() && open_.back().array)
      return drop(mark,
                  "an array holds numbers or strings; lists are named: \"NAME:\" and its "
                  "parameters indented below.");
    if (open_.size() >= most_nested_lists)
      return drop(mark,
                  fmt::format("lists are nested more than {} deep, which no parameter file needs.",
                              most_nested_lists));
    const bool is_flow = style == YAML::EmitterStyle::Flow;
    if (open_.empty())
      open_.push_back({&document_.list, "", is_flow, std::nullopt});
    else
      open_.push_back({&open_.back().list->sublist(name_), join_path(open_.back().path, name_),
                       is_flow, std::nullopt});
    name_taken_ = false;
  }

  void OnMapEnd() override {
    if (n_dropped_ > 0)
      return close_dropped();
    open_.pop_back();
    name_taken_ = false;
  }

 private:
  static constexpr const char* no_anchors =
      "anchors (&) and aliases (*) of YAML are not read; what several lists share belongs into "
      "\"Defaults\", \"Constants\" or a file to \"Include\".";

  /// A list or an array that is being read.
  struct Open {
    ParameterList* list;  ///< the list that an array stands in
    std::string path;
    bool is_flow;  ///< a list in braces
    std::optional<Untyped> array;
  };

  void note(const YAML::Mark& mark, const std::string& message) {
    const std::string& file = document_.source.file;
    mistakes_.add(mark.is_null() ? fmt::format("{}: {}", file, message)
                                 : fmt::format("{}, line {}: {}", file, mark.line + 1, message));
  }

  void check_features(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor) {
    if (anchor != YAML::NullAnchor)
      note(mark, no_anchors);
    if (!tag.empty() && tag != "?" && tag != "!")
      note(mark, fmt::format("the tag \"{}\" is not read; parameters have the type that the "
                             "reference says.",
                             shortened(tag)));
  }

  bool expects_name() const { return !open_.empty() && !open_.back().array && !name_taken_; }

  void take_name(const YAML::Mark& mark, const std::string& name) {
    Open& open = open_.back();
    name_taken_ = true;
    name_ = name;
    name_mark_ = mark;
    try {
      check_input(
          name != "<<",
          "merges (<<) of YAML are not read; \"Include\" and \"Defaults\" do what they do.");
      check_input(!trimmed(name).empty(), "{}, a name is empty.", in_list(open.path));
      claim_name(document_, *open.list, open.path, name,
                 fmt::format("{}, line {}", document_.source.file, mark.line + 1));
    } catch (const InputError& error) {
      note(mark, error.what());
      open.list->remove(name, false);  // more mistakes may follow
    }
  }

  void take_value(const YAML::Mark& mark, const Untyped::Scalar& scalar) {
    if (n_dropped_ > 0)
      return;
    if (open_.empty()) {
      note(mark, "a parameter file holds names and values: \"NAME: value\".");
    } else if (open_.back().array) {
      open_.back().array->scalars.push_back(scalar);
    } else {
      open_.back().list->setEntry(name_, ParameterEntry(Untyped{{scalar}, false}));
      name_taken_ = false;
    }
  }

  /// Leaves out a list or an array that stands where it must not.
  void drop(const YAML::Mark& mark, const std::string& message) {
    if (n_dropped_++ > 0)
      return;
    note(mark, message);
    is_name_dropped_ = expects_name();
  }

  void close_dropped() {
    if (--n_dropped_ > 0 || open_.empty() || open_.back().array)
      return;
    name_taken_ = is_name_dropped_;
    name_ = "";
  }

  Document document_;
  std::vector<Open> open_;
  std::string name_;
  YAML::Mark name_mark_;
  bool name_taken_ = false;  ///< the name of what comes next has been read
  int n_dropped_ = 0;        ///< lists and arrays inside of one that is left out
  bool is_name_dropped_ = false;
  int n_documents_ = 0;
  Mistakes mistakes_;
};

}  // namespace

Document read_yaml_string(const std::string& text, const std::string& name) {
  return YamlReader(name).read(text);
}

}  // namespace lockstep
