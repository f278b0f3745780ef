#include "report/bundle.hpp"

// The assembler copies the files: no tool is needed, and a megabyte is in within milliseconds.
#define BR_EMBED(name, file)                 \
  __asm__(                                   \
      ".pushsection .rodata\n"               \
      ".global breccia_report_" #name        \
      "\n"                                   \
      "breccia_report_" #name                \
      ":\n"                                  \
      ".incbin \"" BR_REPORT_FOLDER "/" file \
      "\"\n"                                 \
      ".global breccia_report_" #name        \
      "_end\n"                               \
      "breccia_report_" #name                \
      "_end:\n"                              \
      ".byte 0\n"                            \
      ".popsection\n");                      \
  extern "C" const char breccia_report_##name[], breccia_report_##name##_end[]

BR_EMBED(template, "template.html");
BR_EMBED(style, "bundle/report.css");
BR_EMBED(program, "bundle/report.js");

namespace breccia::report {
namespace {

std::string_view between(const char* begin, const char* end) {
  return {begin, static_cast<std::size_t>(end - begin)};
}

}  // namespace

std::string_view page_template() {
  return between(breccia_report_template, breccia_report_template_end);
}
std::string_view page_style() {
  return between(breccia_report_style, breccia_report_style_end);
}
std::string_view page_program() {
  return between(breccia_report_program, breccia_report_program_end);
}

}  // namespace breccia::report
