// Pictures of runs as users get them: cameras that follow, keys of [output], options of render.

#include <gtest/gtest.h>

#include <filesystem>

#include "io/file.hpp"
#include "io/picture/picture.hpp"
#include "io/whole_file.hpp"
#include "unit/run/program.hpp"
#include "unit/run/scratch_folder.hpp"

namespace breccia {
namespace pictures_program_test {

/// Four balls side by side, which fall 1.2 m, 6 times their height.
std::string falling_case(const std::string& output) {
  std::string text =
      "title = \"A fall\"\ngravity = [0.0, 0.0, -9.81]\n[time]\nend = \"0.5 s\"\n"
      "[material.rock]\nlaw = \"grain\"\nyoung = \"1 MPa\"\n[output]\nframes = 3\n"
      "history = \"0.1 s\"\nwidth = 320\n" +
      output;
  for (int i = 0; i < 4; ++i)
    text += "[[body]]\nname = \"ball " + std::to_string(i) +
            "\"\nshape = \"element\"\nmaterial = \"rock\"\nradius = \"0.1 m\"\ncenter = [" +
            std::to_string(0.25 * i) + ", 0.0, 0.0]\n";
  return text +
         "[[support]]\nname = \"hook\"\non = \"ball 0\"\nfix = [\"x\"]\n[[wall]]\nname = "
         "\"side\"\npoint = [-5.0, 0.0, 0.0]\nnormal = [1.0, 0.0, 0.0]\n";
}

struct Ran {
  ScratchFolder folder;
  std::string text;
  int code;

  explicit Ran(const std::string& output) {
    write(folder / "case.toml", falling_case(output));
    code = run("run " + (folder / "case.toml") + " -o " + out() + " --threads 1");
  }
  std::string out() const { return folder / "out"; }
  int run(const std::string& arguments) {
    const int ended = wait_for(start_program(arguments, folder / "words"));
    text = read_whole_file(folder / "words");
    return ended;
  }
  static void write(const std::string& path, const std::string& text) { replace_file(path, text); }
  double shown(const std::string& picture) const {
    const Image image = read_png(out() + "/" + picture);
    double count = 0.0;
    for (int y = image.height / 8; y < image.height * 7 / 8; ++y)
      for (int x = 0; x < image.width * 2 / 3; ++x)
        count += image.rgb[static_cast<std::size_t>(3 * (y * image.width + x) + 2)] < 225 ? 1 : 0;
    return count;
  }
};

TEST(PicturesProgram, the_camera_follows_what_falls_and_says_when_it_does_not) {
  Ran followed("");
  ASSERT_EQ(followed.code, 0) << followed.text;
  EXPECT_GT(followed.shown("pictures/0003.png"), 30.0);
  EXPECT_EQ(followed.text.find("nothing of the model"), std::string::npos);
  const std::string log = read_whole_file(followed.out() + "/log.jsonl");
  EXPECT_EQ(log.find("nothing of the model"), std::string::npos);
  EXPECT_EQ(followed.run("verify " + followed.out() + "/pictures/0003.png"), 0) << followed.text;

  EXPECT_EQ(followed.run("render " + followed.out()), 0) << followed.text;
  EXPECT_GT(followed.shown("render.png"), 30.0);
  EXPECT_EQ(followed.run("render " + followed.out() + " --fit first"), 0) << followed.text;
  EXPECT_EQ(followed.shown("render.png"), 0.0);
  EXPECT_NE(followed.text.find("warning: nothing of the model"), std::string::npos);
  EXPECT_EQ(followed.run("render " + followed.out() + " --fit frame"), 0) << followed.text;
  EXPECT_GT(followed.shown("render.png"), 500.0);

  Ran fixed("fit = \"first\"\n");
  EXPECT_EQ(fixed.shown("pictures/0003.png"), 0.0);
  const std::string told = read_whole_file(fixed.out() + "/log.jsonl");
  EXPECT_NE(told.find("nothing of the model is in the picture 0003.png"), std::string::npos);
}

TEST(PicturesProgram, grains_show_the_forces_of_their_contacts) {
  Ran ran(
      "forces = true\ncolor = \"velocity\"\n[[wall]]\nname = \"ground\"\n"
      "point = [0.0, 0.0, -0.102]\nnormal = [0.0, 0.0, 1.0]\n");
  ASSERT_EQ(ran.code, 0) << ran.text;
  EXPECT_EQ(ran.run("verify " + ran.out() + "/pictures/0003.png"), 0) << ran.text;
  EXPECT_EQ(ran.run("render " + ran.out() + " --color force"), 0) << ran.text;
  EXPECT_EQ(ran.text.find("warning"), std::string::npos) << ran.text;
  EXPECT_EQ(ran.run("verify " + ran.out() + "/render.png"), 0) << ran.text;
  EXPECT_EQ(ran.run("info " + ran.out() + "/fields/contacts_0003.vtu"), 0) << ran.text;
  EXPECT_NE(ran.text.find(" contacts without links, "), std::string::npos) << ran.text;
  std::filesystem::remove(ran.out() + "/contacts.pvd");
  EXPECT_EQ(ran.run("render " + ran.out() + " --color force"), 0) << ran.text;
  EXPECT_NE(ran.text.find("warning: " + ran.out() + ": no forces of contacts"), std::string::npos)
      << ran.text;
  EXPECT_NE(ran.text.find("[output] fields = true"), std::string::npos) << ran.text;
}

TEST(PicturesProgram, a_run_that_is_resumed_draws_the_pictures_of_one_without_a_break) {
  Ran ran("");
  ASSERT_EQ(ran.code, 0) << ran.text;
  const std::string broken = ran.folder / "broken";
  ASSERT_EQ(
      ran.run("run " + (ran.folder / "case.toml") + " -o " + broken + " --threads 1 --until 0.25"),
      0)
      << ran.text;
  ASSERT_EQ(ran.run("resume " + broken + " --threads 1 --until 0.5"), 0) << ran.text;
  for (const char* picture : {"/pictures/0002.png", "/pictures/0003.png"})
    EXPECT_EQ(read_whole_file(broken + picture), read_whole_file(ran.out() + picture)) << picture;
}

TEST(PicturesProgram, pictures_of_a_case_and_of_render_know_the_same_looks) {
  Ran ran(
      "arrows = \"displacement\"\ncrosses = true\nscale = 0.5\nxray = true\nlinks = true\n"
      "transparent = true\nmore = [\"force\"]\nclip = \"y=0\"\nhide = [\"ball 3\"]\n"
      "map = \"magma\"\nrange = [0, 1]\n");
  ASSERT_EQ(ran.code, 0) << ran.text;
  const std::string last = ran.out() + "/pictures/0003.png";
  EXPECT_FALSE(read_png_with_alpha(last).alpha.empty());
  EXPECT_EQ(ran.run("verify " + last), 0) << ran.text;
  const std::string picture = ran.folder / "a.png";
  EXPECT_EQ(ran.run("render " + ran.out() + " -o " + picture +
                    " --arrows displacement --scale 2 --crosses --xray --links --transparent "
                    "--size 640x480 --title Falls --range 0..1 --map gray --no-walls --log --edges "
                    "--no-legend --dpi 300"),
            0)
      << ran.text;
  const Image image = read_png_with_alpha(picture);
  EXPECT_EQ(image.width, 640);
  EXPECT_EQ(image.height, 480);
  EXPECT_FALSE(image.alpha.empty());
  EXPECT_EQ(ran.run("verify " + picture), 0) << ran.text;
  EXPECT_EQ(ran.run("render " + ran.out() + " --size 12y"), 2);
  for (const char* size : {"10x10", "10", "20000x10", "300x99999999999"}) {
    EXPECT_EQ(ran.run("render " + ran.out() + " --size " + size), 2);
    EXPECT_NE(ran.text.find("16 to 16384 pixels"), std::string::npos) << ran.text;
  }
  EXPECT_EQ(ran.run("render " + ran.out() + " --arrows spun"), 2);
  EXPECT_NE(ran.text.find("velocity"), std::string::npos);
}

TEST(PicturesProgram, wrong_keys_of_pictures_are_found_before_the_run) {
  Ran ran(
      "more = [\"forces\"]\nclip = \"y~0\"\nhide = [\"roof\"]\nmap = \"jet\"\n"
      "range = [2, 1]\narrows = \"spun\"\n");
  EXPECT_EQ(ran.code, 2);
  for (const char* key : {"output.more", "did you mean force", "output.clip", "output.hide",
                          "output.map", "output.range", "output.arrows"})
    EXPECT_NE(ran.text.find(key), std::string::npos) << key << "\n" << ran.text;
}

}  // namespace pictures_program_test
}  // namespace breccia
