#pragma once
// Case files: read, checked, completed and documented from the one list of keys that a
// configuration gives of itself (core/keys.hpp).

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/keys.hpp"
#include "core/table_over_time.hpp"
#include "math/vec.hpp"
#include "math/vec2.hpp"

namespace breccia {

/// The text of a case that lies in another file.
struct CaseText {
  std::string text;
  std::string origin;  ///< that file, for messages
};

/// Reads values from a TOML file, key by key, and collects all that is wrong with them.
class CaseReader {
 public:
  /// @throws InputError if the file cannot be read or is no TOML, or an override makes no sense
  CaseReader(const std::string& path, const std::vector<std::string>& overrides);
  CaseReader(const CaseText& text, const std::vector<std::string>& overrides);
  CaseReader(const CaseReader&) = delete;
  CaseReader& operator=(const CaseReader&) = delete;
  ~CaseReader();

  void read(const char* name, double& value, const char* unit, const Range& range,
            const char* meaning);
  void read(const char* name, std::int64_t& value, const char* unit, const Range& range,
            const char* meaning);
  void read(const char* name, int& value, const char* unit, const Range& range,
            const char* meaning);
  void read(const char* name, Vec3& value, const char* unit, const Range& range,
            const char* meaning);
  void read(const char* name, Vec2& value, const char* unit, const Range& range,
            const char* meaning);
  void read(const char* name, OverTime<double>& value, const char* unit, const Range& range,
            const char* meaning);
  void read(const char* name, OverTime<Vec2>& value, const char* unit, const Range& range,
            const char* meaning);
  void read(const char* name, OverTime<Vec3>& value, const char* unit, const Range& range,
            const char* meaning);
  void read(const char* name, std::vector<double>& value, const char* unit, const Range& range,
            const char* meaning);
  void read(const char* name, std::vector<Vec2>& value, const char* unit, const Range& range,
            const char* meaning);
  void read(const char* name, std::vector<Vec3>& value, const char* unit, const Range& range,
            const char* meaning);
  void read(const char* name, bool& value, const char* meaning);
  void read(const char* name, std::string& value, const char* meaning);
  void read(const char* name, std::string& value, const OneOf& words, const char* meaning);
  void read(const char* name, std::vector<std::string>& value, const char* meaning);
  void require(const char* name);

  /// Goes into a table; false (and nothing is entered) if it is inside a list's item and not there.
  bool enter(const char* name);
  /// Items of a list of tables, and into one of them.
  std::size_t count(const char* name);
  void enter_item(const char* name, std::size_t item);
  /// Names of the tables below a table, and into one of them.
  std::vector<std::string> names(const char* name);
  void enter_named(const char* name, const std::string& item);
  /// Back out; keys of the table that nobody has asked for are problems.
  void leave();

  /// Numbers of named materials that do not count, as keys of the case stand in their place.
  const std::vector<std::string>& notes() const;
  /// @throws InputError with all problems, if there are any
  void finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Visitor of each_key that reads.
struct ReadKeys {
  CaseReader& reader;

  template <class T>
  void operator()(const char* name, T& value, const char* unit, const Range& range,
                  const char* meaning) {
    reader.read(name, value, unit, range, meaning);
  }
  template <class T>
  void operator()(const char* name, T& value, const char* meaning) {
    reader.read(name, value, meaning);
  }
  void operator()(const char* name, std::string& value, const OneOf& words, const char* meaning) {
    reader.read(name, value, words, meaning);
  }
  void required(const char* name) { reader.require(name); }
  template <class Config>
  void table(const char* name, Config& config, const char*) {
    if (!reader.enter(name)) return;
    config.each_key(*this);
    reader.leave();
  }
  template <class Config>
  void list(const char* name, std::vector<Config>& configs, const char*) {
    configs.resize(reader.count(name));
    for (std::size_t i = 0; i < configs.size(); ++i) {
      reader.enter_item(name, i);
      configs[i].each_key(*this);
      reader.leave();
    }
  }
  template <class Config>
  void named(const char* name, std::vector<Config>& configs, const char*) {
    for (const std::string& item : reader.names(name)) {
      Config& config = configs.emplace_back();
      config.name = item;
      reader.enter_named(name, item);
      config.each_key(*this);
      reader.leave();
    }
  }
};

/// One key, for people.
struct KeyInfo {
  std::string path, type, unit, default_text, range, meaning;
  std::string table_meaning{};  ///< of the table that holds it; empty at the top
  Range limits{};               ///< of numbers
};

// How values and ranges are written, in files and on terminals.
std::string number_text(double value);
std::string value_text(double value);
std::string value_text(int value);
std::string value_text(std::int64_t value);
std::string value_text(const Vec3& value);
std::string value_text(const Vec2& value);
std::string value_text(const OverTime<double>& value);
std::string value_text(const OverTime<Vec2>& value);
std::string value_text(const OverTime<Vec3>& value);
std::string value_text(const std::vector<double>& value);
std::string value_text(const std::vector<Vec2>& value);
std::string value_text(const std::vector<Vec3>& value);
std::string value_text(bool value);
std::string value_text(const std::string& value);
std::string value_text(const std::vector<std::string>& value);
/// The name of a table as TOML wants it: quoted unless it holds letters, digits, _ and - only.
std::string key_text(const std::string& name);
std::string range_text(const Range& range);
std::string words_text(const OneOf& words);
inline const char* type_name(const double&) {
  return "number";
}
inline const char* type_name(const int&) {
  return "integer";
}
inline const char* type_name(const std::int64_t&) {
  return "integer";
}
inline const char* type_name(const Vec3&) {
  return "3 numbers";
}
inline const char* type_name(const Vec2&) {
  return "2 numbers";
}
inline const char* type_name(const OverTime<double>&) {
  return "number or table";
}
inline const char* type_name(const OverTime<Vec2>&) {
  return "2 numbers or table";
}
inline const char* type_name(const OverTime<Vec3>&) {
  return "3 numbers or table";
}
inline const char* type_name(const std::vector<double>&) {
  return "numbers";
}
inline const char* type_name(const std::vector<Vec2>&) {
  return "points";
}
inline const char* type_name(const std::vector<Vec3>&) {
  return "points in space";
}
inline const char* type_name(const bool&) {
  return "true/false";
}
inline const char* type_name(const std::string&) {
  return "text";
}
inline const char* type_name(const std::vector<std::string>&) {
  return "texts";
}

/// Visitor of each_key that writes TOML: first a table's own keys, then the tables below it.
struct WriteKeys {
  explicit WriteKeys(std::string where = {}) : path(std::move(where)) {}

  std::string path;        ///< of the table, with a dot behind it; empty at the top
  std::string own, below;  ///< text so far
  bool has_unset = false;  ///< a required key still has its default: the table was not given
  std::string last_value;  ///< of the key visited last

  template <class T>
  void operator()(const char* name, T& value, const char* unit, const Range&, const char* meaning) {
    put(name, value_text(value), std::string("[") + unit + "] " + meaning);
  }
  template <class T>
  void operator()(const char* name, T& value, const char* meaning) {
    put(name, value_text(value), meaning);
  }
  void operator()(const char* name, std::string& value, const OneOf& words, const char* meaning) {
    put(name, value_text(value), words_text(words) + ": " + meaning);
  }
  void required(const char*) {
    has_unset = has_unset || last_value == "0" || last_value == "0.0" || last_value == "\"\"";
  }
  template <class Config>
  void table(const char* name, Config& config, const char* meaning) {
    WriteKeys inner(path + name + ".");
    config.each_key(inner);
    if (inner.has_unset && !path.empty()) return;
    below += "\n# " + std::string(meaning) + "\n[" + path + name + "]\n" + inner.own + inner.below;
  }
  template <class Config>
  void list(const char* name, std::vector<Config>& configs, const char* meaning) {
    for (Config& config : configs) {
      WriteKeys inner(path + name + ".");
      config.each_key(inner);
      below +=
          "\n# " + std::string(meaning) + "\n[[" + path + name + "]]\n" + inner.own + inner.below;
    }
  }
  template <class Config>
  void named(const char* name, std::vector<Config>& configs, const char* meaning) {
    for (Config& config : configs) {
      const std::string inner_path = path + name + "." + key_text(config.name);
      WriteKeys inner(inner_path + ".");
      config.each_key(inner);
      below += "\n# " + std::string(meaning) + "\n[" + inner_path + "]\n" + inner.own + inner.below;
    }
  }

 private:
  void put(const std::string& name, const std::string& value, const std::string& comment) {
    own += name + " = " + value + "  # " + comment + "\n";
    last_value = value;
  }
};

/// Visitor of each_key that lists.
struct ListKeys {
  std::string path;
  std::vector<KeyInfo>& keys;
  std::string table_meaning{};

  template <class T>
  void operator()(const char* name, T& value, const char* unit, const Range& range,
                  const char* meaning) {
    keys.push_back({path + name, type_name(value), unit, value_text(value), range_text(range),
                    meaning, table_meaning, range});
  }
  template <class T>
  void operator()(const char* name, T& value, const char* meaning) {
    keys.push_back(
        {path + name, type_name(value), "", value_text(value), "", meaning, table_meaning});
  }
  void operator()(const char* name, std::string& value, const OneOf& words, const char* meaning) {
    keys.push_back(
        {path + name, "word", "", value_text(value), words_text(words), meaning, table_meaning});
  }
  void required(const char*) { keys.back().default_text = "(required)"; }
  template <class Config>
  void table(const char* name, Config& config, const char* meaning) {
    config.each_key(ListKeys{path + name + ".", keys, meaning});
  }
  template <class Config>
  void list(const char* name, std::vector<Config>&, const char* meaning) {
    Config config;
    config.each_key(ListKeys{path + name + "[].", keys, meaning});
  }
  template <class Config>
  void named(const char* name, std::vector<Config>&, const char* meaning) {
    Config config;
    config.each_key(ListKeys{path + name + ".<name>.", keys, meaning});
  }
};

/// A case from a TOML file, from case.toml in a folder, or from a CaseText; overrides
/// "key.path=value" count last.
/// @throws InputError with every problem at once; nothing was run
template <class Config, class Source>
Config read_case(const Source& source, const std::vector<std::string>& overrides) {
  Config config;
  CaseReader reader(source, overrides);
  config.each_key(ReadKeys{reader});
  reader.finish();
  return config;
}

/// The method that a case asks for, before anything else of it is looked at.
/// @throws InputError if the file cannot be read or is no TOML, or an override makes no sense
template <class Source>
std::string case_method(const Source& source, const std::vector<std::string>& overrides) {
  CaseReader reader(source, overrides);
  std::string method = "dem3d";
  reader.read("method", method, "");
  return method;
}

/// The completed input: every key with the value used, in SI. Reading it gives the same case again.
template <class Config>
std::string completed_case(const Config& config) {
  Config copy = config;
  WriteKeys text;
  copy.each_key(text);
  return text.own + text.below;
}

/// Whether a key is one of those that a prefix asks for: body.pack and body[].pack both do for
/// body[].pack.count.
bool begins_with(const KeyInfo& key, const std::string& prefix);
/// Every key whose path begins with `prefix`.
template <class Config>
std::vector<KeyInfo> list_keys(const std::string& prefix) {
  Config config;
  std::vector<KeyInfo> all, wanted;
  config.each_key(ListKeys{"", all});
  for (KeyInfo& key : all)
    if (begins_with(key, prefix)) wanted.push_back(std::move(key));
  return wanted;
}

/// A message about a case with the file and the lines of the keys that its sentences begin with:
/// of problems that were found after the file had been read.
std::string with_lines(const std::string& message, const std::string& path);

/// The stem of the file: thesis/beam.toml is beam. A case.toml has the name of its folder, and
/// files beside it are its variants: cases/rc_slab is rc_slab, cases/rc_slab/small.toml
/// rc_slab_small.
std::string case_name(const std::string& path);
/// The folder that the files a case names are looked for in.
std::string case_folder(const std::string& path);
/// The text of a case without what follows a # outside quotes: keys and values alone.
std::string without_comments(const std::string& text);
/// SHA-256 of a text, in hexadecimal digits.
std::string case_digest(const std::string& text);

}  // namespace breccia
