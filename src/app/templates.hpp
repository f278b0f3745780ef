#pragma once
// Small cases to begin from, each checked and run in under a minute on one core.

#include <string>
#include <vector>

namespace breccia::app {

struct CaseTemplate {
  const char* name;
  const char* shows;  ///< one line
  const char* look;   ///< what to look at when it has run
  const char* text;
};
extern const char* const bar_of_tetrahedra;  ///< text of the one that is of solids
const std::vector<CaseTemplate>& case_templates();
/// @throws InputError with the names that there are
const CaseTemplate& template_named(const std::string& name);

}  // namespace breccia::app
