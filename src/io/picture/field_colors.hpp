#pragma once
// Which colour every item of a frame gets, and the legend that explains it.

#include <optional>
#include <string>
#include <vector>

#include "io/picture/color_map.hpp"
#include "io/picture/picture.hpp"
#include "io/round_numbers.hpp"

namespace breccia {

/// Contents of a legend.
struct Legend {
  struct Bar {
    ColorMap map;
    ValueRange range;  ///< in the unit of the field
    std::vector<Tick> ticks;
    std::string note;  ///< what the range leaves out; may be empty
  };
  struct Swatch {
    Color color;
    std::string name;
  };
  std::string title;  ///< "velocity [m/s]"; empty: no field
  std::optional<Bar> bar;
  std::vector<Swatch> swatches;
  std::vector<std::string> notes;  ///< below them
};

/// How the force of a contact is drawn.
struct ContactLook {
  std::size_t contact;  ///< of those of the frame
  Color color;
  double width;  ///< 0 to 1 for the largest force
};

/// A colour an item. Of a frame with tetrahedra, "lines" are the triangles of its joints.
struct Coloring {
  std::vector<Color> points, lines;
  std::vector<Color> triangles, tetrahedra;  ///< that are bodies
  bool of_lines = false;                     ///< the field is one of the lines
  bool cracks = false;                ///< lines are cracks in the bodies, drawn with any field
  std::vector<bool> hidden_lines;     ///< not to be drawn; empty: all are
  std::vector<float> line_widths;     ///< factors; empty: all 1
  std::vector<bool> inside;           ///< points that an x-ray shows; empty: it shows cracks alone
  std::vector<bool> bars;             ///< points that show through others; empty: none
  std::vector<float> veil;            ///< by point, how much of a bar behind it shows: 0 to 1
  std::vector<ContactLook> contacts;  ///< that are drawn, the weakest first
  Legend legend;
};

/// The items that are joints or links: triangles if bodies are of tetrahedra, else lines.
Carrier joints_of(const Frame& frame);

/// A field of such items by its name; null if there is none.
const FrameField* field_of(const Frame& frame, Carrier carrier, const std::string& name);

/// @param map  name of the map of colours; empty: by the field
/// @param lines_first  of two fields of that name the one of lines counts
/// @param log  colours follow the logarithm: four powers of ten, if no range is given
/// @throws InputError if the frame has no such field (lists what it has), or one of wrong length,
///                    or there is no such map
Coloring color_frame(const Frame& frame, const std::string& field,
                     const std::optional<ValueRange>& range, const std::string& map = {},
                     bool lines_first = false, bool log = false);
/// As the options say.
Coloring color_frame(const Frame& frame, const RenderOptions& options);

}  // namespace breccia
