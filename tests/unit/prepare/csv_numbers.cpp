#include "prepare/csv_numbers.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "exec/error.hpp"
#include "io/whole_file.hpp"
#include "unit/run/scratch_folder.hpp"

namespace breccia::prepare {
namespace csv_numbers_test {

class CsvNumbers : public testing::Test {
 protected:
  /// How many lines of two numbers the text has.
  std::size_t lines_in(const std::string& text) {
    replace_file(path(), text);
    std::size_t lines = 0;
    read_csv(path(), 2, "x,y in metres", [&](const std::vector<double>&) { return ++lines > 0; });
    return lines;
  }
  std::string refusal_of(const std::string& text) {
    try {
      lines_in(text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  std::string path() const { return folder_ / "points.csv"; }

 private:
  ScratchFolder folder_;
};

TEST_F(CsvNumbers, a_first_line_of_names_is_passed_over) {
  for (const char* names : {"", "x,y\n", "x [m], y [m]\r\n", "\"x\",\"y\"\n", "# points\nx1,y1\n"})
    EXPECT_EQ(lines_in(names + std::string("0,0\n1,0.5\n")), 2U) << names;
}

TEST_F(CsvNumbers, a_first_line_of_numbers_with_a_slip_is_refused) {
  for (const char* slip : {"0.0,0.1x", "-1,x", "x,1", "+a,b", ".5x,y", "\"0.0\",\"0.1\"", "nan,nan",
                           "inf,y", "0;0", ",", "x,", "1,2,3"}) {
    const std::string message = refusal_of(slip + std::string("\n1,0.5\n"));
    EXPECT_NE(message.find("line 1"), std::string::npos) << slip << ": " << message;
  }
}

TEST_F(CsvNumbers, the_mark_that_spreadsheets_put_first_is_no_part_of_a_line) {
  EXPECT_EQ(lines_in("\xef\xbb\xbf"
                     "0,0\n1,0.5\n"),
            2U);
  EXPECT_EQ(lines_in("\xef\xbb\xbfx,y\n0,0\n1,0.5\n"), 2U);
}

TEST_F(CsvNumbers, a_line_is_quoted_only_after_one_of_numbers) {
  EXPECT_NE(refusal_of("x;y\n0,5;1,5\n").find("in metres; it has semicolons"), std::string::npos);
  EXPECT_NE(refusal_of("0,0\n1,b\n").find("line 2: \"1,b\" is not x,y"), std::string::npos);
  for (const char* names : {"", "user:secret\n"}) {  // of a file that has nothing to do with it
    const std::string message = refusal_of(names + std::string("3:secret\n"));
    EXPECT_EQ(message.find("secret"), std::string::npos) << message;
    EXPECT_NE(message.find(" is not x,y in metres"), std::string::npos) << message;
  }
  EXPECT_LT(refusal_of("0,0\n" + std::string(10'000, 'x')).size(), 300U);
}

TEST_F(CsvNumbers, a_pipe_is_refused_at_once) {
  ASSERT_EQ(::mkfifo(path().c_str(), 0600), 0);
  const auto take = [](const std::vector<double>&) { return true; };
  EXPECT_THROW(read_csv(path(), 2, "x,y in metres", take), IoError);
}

}  // namespace csv_numbers_test
}  // namespace breccia::prepare
