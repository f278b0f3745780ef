#pragma once
// Frames as unstructured grids in VTK XML files (appended raw data, UInt64 headers, zlib blocks),
// or in VTKHDF files, whose chunks are those blocks.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "io/frame.hpp"
#include "io/vtu/vtkhdf.hpp"

namespace breccia {

enum class FrameFormat : std::uint8_t {
  vtu,     ///< .vtu, listed in .pvd
  vtkhdf,  ///< .hdf, VTKHDF 1.0, listed in .hdf.series
};

/// The format that a word of case files or commands names. @throws InputError if this program is
/// built without it
FrameFormat frame_format(const std::string& word);

/// The files of one frame.
struct FrameContents {
  double time = 0.0;  ///<  [s]
  /// Vertices, triangles or tetrahedra, with every field of points and `radius`.
  std::string points;
  std::string lines;          ///< lines, or triangles of joints in space, with their fields
  std::string contacts = {};  ///< lines between what touches; empty: no such file
  std::string walls = {};     ///< triangles; empty: no such file
  std::string bolts = {};     ///< lines; empty: no such file
  /// Of a second method in the same run, by kind: "tetrahedra", ... (io/frame_pair.hpp).
  std::vector<std::pair<std::string, std::string>> more = {};
};

/// The files of a frame as blocks, each of which is compressed by itself: by any thread, on any
/// rank. Their list follows from what the whole frame has, not from the part that is here.
class FrameBlocks {
 public:
  /// One array of a file.
  struct Array {
    Carrier carrier;
    std::size_t width;               ///< bytes an item
    std::size_t bytes;               ///< in the whole
    std::span<const std::byte> own;  ///< values of the items of this part
    /// Without a carrier: what stands there from byte `begin` on.
    std::function<void(std::size_t begin, std::span<std::byte> to)> make;
    std::size_t first_block, block_bytes;
  };
  /// A piece of an array, before compression.
  struct Block {
    std::size_t array, begin, size;  ///<  [bytes]
  };

  /// Keeps views of the part. @throws InputError if fields do not fit its items
  FrameBlocks(const Frame& part, const FramePlaces& places, FrameFormat format);
  FrameBlocks(const FrameBlocks&) = delete;
  FrameBlocks& operator=(const FrameBlocks&) = delete;

  const std::vector<Block>& blocks() const { return blocks_; }
  const Array& array_of(const Block& block) const { return arrays_[block.array]; }

  /// The block of a whole frame, or of an array without a carrier, compressed.
  /// @throws DeviceError for want of memory
  std::string packed(const Block& block) const;
  /// Writes a file of bytes that were put together from parts.
  std::string packed(const Block& block, std::span<const std::byte> bytes) const;
  /// The files, from all blocks compressed.
  FrameContents contents(const std::vector<std::string>& packed) const;

 private:
  /// An array as a file names it.
  struct Entry {
    const char* section;
    std::string name, unit;
    FrameNumber type;
    std::size_t rows, components, array;
  };
  /// Content of a file and, of a .vtu, its XML head: texts and, after each but the last, the place
  /// of an array.
  struct Document {
    std::vector<std::string> text{""};
    std::vector<Entry> entries;
    std::size_t cells = 0, corners = 0;  ///< corners of all cells
  };
  /// VTK's numbers.
  enum class Cells : std::uint8_t { vertices = 1, lines = 3, triangles = 5, tetrahedra = 10 };
  struct CellKind {
    Carrier carrier;
    std::size_t width;                         ///< corners of each
    const std::vector<std::int32_t>* corners;  ///< null: each point is a cell
    const std::vector<FrameField>* fields;
  };

  CellKind kind_of(Cells cells) const;
  void list(Document& document, Cells cells);
  void list_field_data(Document& document);
  void list_walls(Document& document);
  void list_groups(Document& document);
  void list_fields(Document& document, const std::vector<FrameField>& fields, Carrier carrier);
  template <class Number>
  void list_field(Document& document, const std::string& name, const std::string& unit,
                  std::size_t width, const std::vector<Number>& values, Carrier carrier);
  void list_cells(Document& document, Cells cells);
  /// Notes an array in a document.
  void place(Document& document, Entry entry);
  std::size_t add(Array array);
  template <class Number>
  std::size_t add_carried(Carrier carrier, std::size_t width, std::span<const Number> own);
  template <class Number, class Value>
  std::size_t add_made(std::size_t count, const Value& value, std::size_t components = 1);
  std::size_t items(Carrier carrier) const;
  std::size_t own_items(Carrier carrier) const;
  std::string content(const Document& document, const std::vector<std::string>& packed) const;
  std::string hdf_content(const Document& document, const std::vector<std::string>& packed) const;

  const Frame& part_;
  const FramePlaces& places_;
  FrameFormat format_;
  std::vector<float> coordinates_, radius_;
  /// Of the part, parts of tensors as one field.
  std::vector<FrameField> triangle_fields_, tetrahedron_fields_;
  std::vector<Array> arrays_;
  std::vector<Block> blocks_;
  std::size_t points_ = 0, time_ = 0, step_ = 0;  ///< arrays that both files have
  Document elements_, links_;
};

/// The files of a frame that is whole, by so many threads.
FrameContents contents_of(const Frame& whole, int threads = 1,
                          FrameFormat format = FrameFormat::vtu);

}  // namespace breccia
