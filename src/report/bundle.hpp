#pragma once
// The page's program, style and frame, built from web/report and carried inside this program.

#include <string_view>

namespace breccia::report {

std::string_view page_template();  ///< HTML with places such as @DATA@
std::string_view page_style();     ///< CSS
std::string_view page_program();   ///< JavaScript: three.js, uPlot and the report's own

}  // namespace breccia::report
