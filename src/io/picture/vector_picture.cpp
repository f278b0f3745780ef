#include "io/picture/vector_picture.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <vector>

#include "exec/error.hpp"
#include "io/picture/annotation.hpp"
#include "io/picture/font.hpp"
#include "io/picture/layout.hpp"

namespace breccia {
namespace {

constexpr double letter_size = 7.0 / 0.729;  ///< of text: capitals are 7 units high  [units]

/// A page of lines, areas and text.
class Page : public Paper {
 public:
  using Paper::Paper;
  /// Triangles of one colour, three corners each.
  virtual void triangles(const std::vector<ScreenPoint>& corners, const Color& color) = 0;
  /// @param about  kept in the file's metadata; empty: none
  virtual std::string content(const std::string& about) const = 0;
};

constexpr std::string_view svg_begin = "<metadata>", svg_end = "</metadata>\n";
constexpr std::string_view pdf_begin = "<</Producer(breccia)/Subject(", pdf_end = ")>>";

std::string as_xml(std::string_view text) {
  std::string plain;
  for (const char c : text)
    plain += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
  return plain;
}

std::string of_xml(std::string_view text) {
  std::string plain;
  while (!text.empty()) {
    std::size_t taken = 1;
    char letter = text.front();
    for (const auto& [name, stands_for] :
         {std::pair{std::string_view("&lt;"), '<'}, {"&gt;", '>'}, {"&amp;", '&'}})
      if (text.starts_with(name)) {
        taken = name.size();
        letter = stands_for;
      }
    plain += letter;
    text.remove_prefix(taken);
  }
  return plain;
}

/// A string of PDF, without its brackets.
std::string as_pdf(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '(' || c == ')' || c == '\\') escaped += '\\';
    escaped += c;
  }
  return escaped;
}

std::string of_pdf(std::string_view escaped) {
  std::string text;
  for (std::size_t i = 0; i < escaped.size(); ++i) {
    if (escaped[i] == '\\' && i + 1 < escaped.size()) ++i;
    text += escaped[i];
  }
  return text;
}

/// Text between two marks of a file.
std::string_view between(std::string_view content, std::string_view begin, std::string_view end) {
  const std::size_t at = content.find(begin);
  if (at == std::string_view::npos) return {};
  content.remove_prefix(at + begin.size());
  const std::size_t stop = content.find(end);
  return stop == std::string_view::npos ? std::string_view() : content.substr(0, stop);
}

class SvgPage : public Page {
 public:
  SvgPage(int wide, int high, bool transparent) : Page(wide, high), transparent_(transparent) {}
  void fill(int left, int top, int right, int bottom, const Color& color) override {
    add("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"{}\"/>\n", left, top,
        right - left, bottom - top, name_of(color));
  }
  void write(int x, int y, std::string_view text, int scale, const Color& color) override {
    add("<text x=\"{}\" y=\"{}\" font-size=\"{:.2f}\" fill=\"{}\" "
        "xml:space=\"preserve\">{}</text>\n",
        x, y + 7 * scale, letter_size * scale, name_of(color), as_xml(text));
  }
  void stroke(double from_x, double from_y, double to_x, double to_y, double thick,
              const Color& color) override {
    add("<path d=\"M{:.2f} {:.2f}L{:.2f} {:.2f}\" stroke=\"{}\" stroke-width=\"{:.2f}\" "
        "stroke-linecap=\"round\"/>\n",
        from_x, from_y, to_x, to_y, name_of(color), thick);
  }
  void veil(int left, int top, int right, int bottom, int scale) override {
    const int edge = 4 * scale;
    add("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"#fff\" fill-opacity=\"0.8\"/>\n",
        left - edge, top - edge, right - left + 2 * edge, bottom - top + 2 * edge);
  }
  void triangles(const std::vector<ScreenPoint>& corners, const Color& color) override {
    // a thin stroke of the same colour closes the seams that viewers leave between neighbours
    add("<path fill=\"{0}\" stroke=\"{0}\" stroke-width=\"0.4\" d=\"", name_of(color));
    for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
      add("M{:.2f} {:.2f}L{:.2f} {:.2f}L{:.2f} {:.2f}Z", corners[i].u, corners[i].v,
          corners[i + 1].u, corners[i + 1].v, corners[i + 2].u, corners[i + 2].v);
    add("\"/>\n");
  }
  std::string content(const std::string& about) const override {
    return fmt::format(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" "
        "width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" font-family=\"DejaVu Sans, Verdana, "
        "sans-serif\">\n{2}{3}{4}</svg>\n",
        width, height,
        about.empty() ? std::string() : fmt::format("{}{}{}", svg_begin, as_xml(about), svg_end),
        transparent_
            ? std::string()
            : fmt::format("<rect width=\"{}\" height=\"{}\" fill=\"#fff\"/>\n", width, height),
        body_);
  }

 private:
  template <class... Of>
  void add(fmt::format_string<Of...> pattern, Of&&... of) {
    fmt::format_to(std::back_inserter(body_), pattern, std::forward<Of>(of)...);
  }
  static std::string name_of(const Color& color) {
    const auto byte = [](float channel) { return static_cast<int>(255.0F * channel + 0.5F); };
    return fmt::format("#{:02x}{:02x}{:02x}", byte(color.red), byte(color.green), byte(color.blue));
  }
  bool transparent_;
  std::string body_;
};

/// PDF 1.4, ISO 32000-1: a page with one compressed stream and the standard font Helvetica.
class PdfPage : public Page {
 public:
  using Page::Page;
  void fill(int left, int top, int right, int bottom, const Color& color) override {
    paint(color, "rg");
    add("{} {} {} {} re f\n", left, height - bottom, right - left, bottom - top);
  }
  void write(int x, int y, std::string_view text, int scale, const Color& color) override {
    paint(color, "rg");
    add("BT /F1 {:.2f} Tf {} {} Td (", letter_size * scale, x, height - y - 7 * scale);
    for (const char32_t letter : code_points(text)) {
      if (letter == U'(' || letter == U')' || letter == U'\\') body_ += '\\';
      body_ += letter < 256 ? static_cast<char>(letter) : '?';
    }
    add(") Tj ET\n");
  }
  void stroke(double from_x, double from_y, double to_x, double to_y, double thick,
              const Color& color) override {
    paint(color, "RG");
    add("1 J {:.2f} w {:.2f} {:.2f} m {:.2f} {:.2f} l S\n", thick, from_x, height - from_y, to_x,
        height - to_y);
  }
  void veil(int left, int top, int right, int bottom, int scale) override {
    const int edge = 4 * scale;
    add("q /Veil gs 1 1 1 rg {} {} {} {} re f Q\n", left - edge, height - bottom - edge,
        right - left + 2 * edge, bottom - top + 2 * edge);
  }
  void triangles(const std::vector<ScreenPoint>& corners, const Color& color) override {
    paint(color, "rg");
    paint(color, "RG");
    add("0.4 w ");
    for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
      add("{:.2f} {:.2f} m {:.2f} {:.2f} l {:.2f} {:.2f} l h\n", corners[i].u,
          height - corners[i].v, corners[i + 1].u, height - corners[i + 1].v, corners[i + 2].u,
          height - corners[i + 2].v);
    add("B\n");
  }
  std::string content(const std::string& about) const override {
    const std::string stream = "0.75 0 0 0.75 0 0 cm\n" + body_;
    uLongf size = compressBound(static_cast<uLong>(stream.size()));
    std::string packed(size, '\0');
    if (compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
                  reinterpret_cast<const Bytef*>(stream.data()), static_cast<uLong>(stream.size()),
                  6) != Z_OK)
      throw IoError("a page of " + std::to_string(stream.size()) + " bytes cannot be packed");
    packed.resize(size);
    std::vector<std::string> objects{
        std::string("<</Type/Catalog/Pages 2 0 R>>"),
        std::string("<</Type/Pages/Kids[3 0 R]/Count 1>>"),
        fmt::format(
            "<</Type/Page/Parent 2 0 R/MediaBox[0 0 {:.2f} {:.2f}]/Contents 6 0 R/Resources<<"
            "/Font<</F1 4 0 R>>/ExtGState<</Veil 5 0 R>>>>>>",
            0.75 * width, 0.75 * height),
        std::string("<</Type/Font/Subtype/Type1/BaseFont/Helvetica/Encoding/WinAnsiEncoding>>"),
        std::string("<</Type/ExtGState/ca 0.8>>"),
        fmt::format("<</Length {}/Filter/FlateDecode>>\nstream\n", packed.size()) + packed +
            "\nendstream"};
    if (!about.empty()) objects.push_back(fmt::format("{}{}{}", pdf_begin, as_pdf(about), pdf_end));
    std::string file = "%PDF-1.4\n%\xB5\xB5\n", table;
    for (std::size_t i = 0; i < objects.size(); ++i) {
      table += fmt::format("{:010} 00000 n \n", file.size());
      file += fmt::format("{} 0 obj\n", i + 1) + objects[i] + "\nendobj\n";
    }
    const std::size_t start = file.size(), count = objects.size() + 1;
    return file + fmt::format(
                      "xref\n0 {}\n0000000000 65535 f \n{}trailer\n<</Size {}/Root 1 0 R{}>>\n"
                      "startxref\n{}\n%%EOF\n",
                      count, table, count, about.empty() ? "" : "/Info 7 0 R", start);
  }

 private:
  template <class... Of>
  void add(fmt::format_string<Of...> pattern, Of&&... of) {
    fmt::format_to(std::back_inserter(body_), pattern, std::forward<Of>(of)...);
  }
  void paint(const Color& color, const char* how) {
    add("{:.3f} {:.3f} {:.3f} {} ", color.red, color.green, color.blue, how);
  }
  std::string body_;
};

/// A colour as eight bits a channel, by which triangles are put together.
using Shade = std::array<int, 3>;
Shade shade_of(const Color& color) {
  const auto byte = [](float channel) { return static_cast<int>(255.0F * channel + 0.5F); };
  return {byte(color.red), byte(color.green), byte(color.blue)};
}

AsDrawn plane_drawing(const Frame& frame, const RenderOptions& options) {
  if (!places_in(frame).plane())
    throw InputError(
        "SVG and PDF are for plane cases; pictures of spheres and of solid bodies are PNG files");
  if (!options.clip.empty()) throw InputError("SVG and PDF know no clip planes; use PNG");
  check_frame(frame, options);
  RenderOptions from_above = options;
  from_above.view = "z";
  return {frame, from_above};
}

std::string drawn(const AsDrawn& drawing, Page& page, const std::string& about) {
  const Frame& frame = drawing.frame();
  const RenderOptions& options = drawing.options;
  const Layout layout(frame, options);
  const Coloring& coloring = layout.coloring;
  const Camera camera = layout.camera(options);
  const auto at = [&](std::int32_t point) {
    return camera.project(frame.position[static_cast<std::size_t>(point)]);
  };
  std::map<Shade, std::vector<ScreenPoint>> areas;
  for (std::size_t i = 0; i < coloring.triangles.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k)
      areas[shade_of(coloring.triangles[i])].push_back(at(frame.triangles[3 * i + k]));
  for (const auto& [shade, corners] : areas)
    page.triangles(corners,
                   {static_cast<float>(shade[0]) / 255.0F, static_cast<float>(shade[1]) / 255.0F,
                    static_cast<float>(shade[2]) / 255.0F});
  const int scale = text_scale(options);
  if (options.show_links || coloring.of_lines || coloring.cracks)
    for (std::size_t i = 0; i < coloring.lines.size(); ++i) {
      if (!coloring.hidden_lines.empty() && coloring.hidden_lines[i]) continue;
      const ScreenPoint a = at(frame.lines[2 * i]), b = at(frame.lines[2 * i + 1]);
      const double width = coloring.line_widths.empty() ? 1.0 : coloring.line_widths[i];
      page.stroke(a.u, a.v, b.u, b.v, 1.3 * scale * width, coloring.lines[i]);
    }
  layout.overlay.draw(page, {camera, [](std::size_t) { return true; }}, scale);
  if (options.bare) return page.content(about);
  draw_title(page, options.title, frame, scale);
  draw_legend(page, coloring.legend, scale);
  draw_scale_bar(page, camera.resolution, scale);
  draw_axes(page, layout.axes, scale);
  return page.content(about);
}

}  // namespace

std::string svg_content(const Frame& frame, const RenderOptions& options,
                        const std::string& about) {
  const AsDrawn drawing = plane_drawing(frame, options);
  SvgPage page(drawing.options.width, drawing.options.height, options.transparent);
  return drawn(drawing, page, about);
}

std::string pdf_content(const Frame& frame, const RenderOptions& options,
                        const std::string& about) {
  const AsDrawn drawing = plane_drawing(frame, options);
  PdfPage page(drawing.options.width, drawing.options.height);
  return drawn(drawing, page, about);
}

std::string about_drawing(const std::string& content) {
  if (content.starts_with("%PDF")) return of_pdf(between(content, pdf_begin, pdf_end));
  return of_xml(between(content, svg_begin, svg_end));
}

}  // namespace breccia
