#include "io/picture/png_notes.hpp"

#include <gtest/gtest.h>

#include "exec/error.hpp"
#include "io/picture/picture.hpp"

namespace breccia {
namespace png_notes_test {

const std::string plain = png_content({2, 1, {0, 1, 2, 3, 4, 5}});

TEST(png_notes, read_back_as_written) {
  const std::string large(300000, 'x');
  const std::string png =
      with_notes(plain, {{"Case", "Größe 1"}, {"Case file", large}, {"Empty", ""}});
  const std::vector<PngNote> notes = notes_of(png, "p.png");
  ASSERT_EQ(notes.size(), 3u);
  EXPECT_EQ(note(notes, "Case"), "Größe 1");
  EXPECT_EQ(note(notes, "Case file"), large);
  EXPECT_EQ(note(notes, "Empty"), "");
  EXPECT_EQ(note(notes, "Title"), "");
  EXPECT_LT(png.size(), plain.size() + 2000);
}

TEST(png_notes, a_picture_without_them_has_none) {
  EXPECT_TRUE(notes_of(plain, "p.png").empty());
  EXPECT_EQ(with_notes("", {{"Case", "a"}}), "");
}

TEST(png_notes, damage_is_refused_with_the_path) {
  const std::string png = with_notes(plain, {{"Case", "a long text of a case"}});
  EXPECT_THROW(notes_of("GIF89a", "p.png"), InputError);
  EXPECT_THROW(notes_of("", "p.png"), InputError);
  for (std::size_t length = 9; length < png.size(); ++length) {
    try {
      notes_of(png.substr(0, length), "p.png");
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find("p.png: "), 0u);
    }
  }
  for (std::size_t place = 41; place < 33 + 12 + 4 + 5; ++place) {  // the text's data
    std::string changed = png;
    changed[place] = static_cast<char>(changed[place] ^ 1);
    EXPECT_THROW(notes_of(changed, "p.png"), InputError) << place;
  }
}

TEST(png_notes, a_text_that_would_fill_the_memory_is_refused) {
  const std::string png = with_notes(plain, {{"Bomb", std::string(20u << 20, 'x')}});
  EXPECT_LT(png.size(), 100000u);
  EXPECT_THROW(notes_of(png, "p.png"), InputError);
}

}  // namespace png_notes_test
}  // namespace breccia
