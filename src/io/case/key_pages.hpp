#pragma once
// The keys of case files as pages: for terminals, for Markdown, as JSON, and as the JSON Schema
// that editors complete TOML files by.

#include <string>
#include <vector>

#include "io/case/case_file.hpp"

namespace breccia {

/// The keys of a method, by its word.
struct MethodKeys {
  std::string method;
  std::vector<KeyInfo> keys;
};
/// Keys of several methods, those alike listed once: first those of all methods, then those of
/// fewer and fewer.
struct KeyList {
  struct Section {
    std::vector<std::string> methods;
    std::vector<KeyInfo> keys;
  };
  std::vector<Section> sections;  ///< none is empty
  bool empty() const { return sections.empty(); }
  std::size_t size() const;
};
KeyList key_list(const std::vector<MethodKeys>& methods);

/// The keys whose path begins with `words`, or else those in whose path, meaning or allowed words
/// each word stands, whatever its capitals. The name of an item may stand in a path:
/// material.concrete.young.
std::vector<KeyInfo> keys_about(const std::vector<KeyInfo>& keys, const std::string& words);
/// Keys that are about at least one of several words.
std::vector<KeyInfo> keys_about_each(const std::vector<KeyInfo>& keys, const std::string& words);

/// "[material.NAME]", "[[body]]", "[body.pack]" of a key in that table; empty at the top.
std::string table_heading(const KeyInfo& key);
/// A line of a case file: `young = "30 GPa"`, with the default as people type it, or with
/// an example where there is none.
std::string example_line(const KeyInfo& key);

/// Headings of tables, example lines, allowed values and meanings, in 80 columns.
std::string keys_for_terminal(const KeyList& keys);
std::string keys_as_markdown(const KeyList& keys);
/// One object a key: path, methods, table, type, unit, default, allowed, meaning, example.
std::string keys_as_json(const KeyList& keys);
/// JSON Schema (draft 7) of the case files of methods; the first is that of cases that name none.
std::string key_schema(const std::vector<MethodKeys>& methods);

/// The words of a text in lines of at most `width` letters, unless a word alone is longer.
std::vector<std::string> wrapped(const std::string& text, std::size_t width);

}  // namespace breccia
