#pragma once
// Pictures of plane cases as drawings: SVG and PDF, sharp at any size.

#include <string>

#include "io/picture/picture.hpp"

namespace breccia {

/// The triangles and cracks of a frame with legend, scale bar and title, laid out as render() does.
/// @param about  kept in the file's metadata; empty: none
/// @throws InputError for a frame without triangles, and as render() does
std::string svg_content(const Frame& frame, const RenderOptions& options,
                        const std::string& about = "");
/// One page; a pixel is 0.75 points. Text in Helvetica, letters beyond Latin 1 as "?".
std::string pdf_content(const Frame& frame, const RenderOptions& options,
                        const std::string& about = "");

/// Metadata of such a file; empty if it has none.
std::string about_drawing(const std::string& content);

}  // namespace breccia
