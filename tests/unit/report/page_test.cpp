#include "report/page.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "exec/error.hpp"
#include "io/whole_file.hpp"
#include "report/bundle.hpp"
#include "texts.hpp"
#include "unit/report/result_scene.hpp"
#include "unit/report/unpacked.hpp"
#include "unit/run/program.hpp"
#include "unit/run/scratch_folder.hpp"

namespace breccia::report {
namespace page_test {

using Json = nlohmann::json;

/// Text between two marks.
std::string between(const std::string& html, const std::string& open, const std::string& close) {
  const std::size_t begin = html.find(open);
  EXPECT_NE(begin, std::string::npos) << open;
  return html.substr(begin + open.size(), html.find(close, begin) - begin - open.size());
}

std::string page_of_chain(const std::string& folder) {
  return page_of({read_record(folder)}, std::nullopt).html;
}

TEST(ReportPage, OfManyWarningsItTellsHowManyMoreThereAre) {
  const ScratchFolder folder;
  test::write_chain(folder.path());
  std::ofstream log(folder.path() + "/log.jsonl", std::ios::app);
  for (int k = 0; k < 60; ++k) log << "{\"level\": \"warning\", \"message\": \"again\"}\n";
  log.close();
  const std::vector<std::string> warnings = read_record(folder.path()).warnings;
  ASSERT_EQ(warnings.size(), 51U);
  EXPECT_EQ(warnings.back(), "11 more: see log.jsonl");
}

TEST(ReportPage, ItHoldsTheRun) {
  const ScratchFolder folder;
  test::write_chain(folder.path());
  const std::string html = page_of_chain(folder.path());
  const Json data = parsed_json(between(html, "id=\"data\">", "</script>"));
  const Json& run = data["runs"][0];
  EXPECT_EQ(run["name"], "chain");
  EXPECT_EQ(run["title"], "a chain </script><b>pulled</b>");
  EXPECT_EQ(run["summary"]["state_hash"], "00ff");
  EXPECT_EQ(run["film"]["frames"].size(), 3U);
  EXPECT_EQ(run["walls"][0]["velocity"][2], 2.0);
  EXPECT_TRUE(run["regions"][0]["low"][0].is_null());
  EXPECT_EQ(run["view"], "y");
  EXPECT_EQ(run["warnings"], Json::array({"warning: 2 % of the energy is missing"}));
  EXPECT_EQ(run["events"][2]["broken"], Json::array({1}));
  // The case to run again, word for word.
  const std::string blob = "id=\"blob-" + std::to_string(run["case"].get<int>()) + "\">";
  EXPECT_EQ(test::inflated(test::from_base64(between(html, blob, "</script>"))), test::chain_case);
}

TEST(ReportPage, BrokenLinksAreCountedAtRowsWhereTheRunTells) {
  const ScratchFolder folder;
  test::write_chain(folder.path());
  test::write_text(folder.path() + "/broken_links.csv",
                   "a,b,kind,time\n-,-,-,s\n0,1,0,0\n1,2,2,0.0015\n2,3,0,0.001\n3,4,0,0.0015\n");
  const Json data = parsed_json(between(page_of_chain(folder.path()), "id=\"data\">", "</script>"));
  const Json& events = data["runs"][0]["events"];
  const auto broken_at = [&](double time) {  // as the chart looks it up, the nearest
    Json broken;
    double least = 1.0;
    for (const Json& event : events)
      if (const double away = std::abs(event["time"].get<double>() - time); away < least) {
        least = away;
        broken = event["broken"];
      }
    return broken;
  };
  EXPECT_EQ(broken_at(0.0), Json::array({0, 0, 0}));
  EXPECT_EQ(broken_at(0.00099), Json::array({0, 0, 0}));
  EXPECT_EQ(broken_at(0.001), Json::array({1, 0, 0}));
  EXPECT_EQ(broken_at(0.00149), Json::array({1, 0, 0}));
  EXPECT_EQ(broken_at(0.0015), Json::array({2, 0, 1}));
  EXPECT_EQ(events.back()["time"], 0.002);
  EXPECT_EQ(events.back()["broken"], Json::array({2, 0, 1}));
}

TEST(ReportPage, NothingOfARunBecomesMarkup) {
  const ScratchFolder folder;
  test::write_chain(folder.path());
  const std::string html = page_of_chain(folder.path());
  EXPECT_EQ(html.find("<b>pulled"), std::string::npos);
  EXPECT_EQ(escaped_html("<a href=\"x\">&"), "&lt;a href=&quot;x&quot;&gt;&amp;");
}

TEST(ReportPage, ItIsWellFormed) {
  const ScratchFolder folder;
  test::write_chain(folder.path());
  const std::string html = page_of_chain(folder.path());
  EXPECT_TRUE(html.starts_with("<!doctype html>"));
  EXPECT_TRUE(html.ends_with("</html>\n"));
  EXPECT_EQ(html.find("@DATA@"), std::string::npos);
  EXPECT_EQ(html.find("@PROGRAM@"), std::string::npos);
  // As many ends of scripts as beginnings: none inside the program or the data.
  const auto count = [&](const std::string& text) {
    std::size_t found = 0;
    for (std::size_t at = html.find(text); at != std::string::npos; at = html.find(text, at + 1))
      ++found;
    return found;
  };
  EXPECT_EQ(count("<script"), count("</script>"));
  EXPECT_EQ(count("<style"), count("</style>"));
}

TEST(ReportPage, ItAsksNobodyForAnything) {
  const ScratchFolder folder;
  test::write_chain(folder.path());
  const std::string html = page_of_chain(folder.path());
  EXPECT_NE(html.find("default-src 'none'"), std::string::npos);
  for (const char* load : {R"((src|href)\s*=\s*["']?(https?:)?//)", R"(url\(\s*["']?(https?:)?//)",
                           R"(@import)", R"(import\(\s*["']https?:)", R"(fetch\(\s*["']https?:)"}) {
    EXPECT_EQ(first_match(std::string(page_style()), load), "") << load;
    EXPECT_EQ(first_match(std::string(page_template()), load), "") << load;
  }
  for (const char* load :
       {"src=\"http", "href=\"http", "src='http", "import(\"http", "fetch(\"http"})
    EXPECT_EQ(html.find(load), std::string::npos) << load;
}

TEST(ReportPage, TheLicencesOfItsLibrariesAreInIt) {
  const std::string program(page_program());
  EXPECT_NE(program.find("three.js authors"), std::string::npos);
  EXPECT_NE(program.find("Leon Sorokin"), std::string::npos);
}

TEST(ReportPage, TheSameRunGivesTheSameBytes) {
  const ScratchFolder folder;
  test::write_chain(folder.path());
  EXPECT_EQ(page_of_chain(folder.path()), page_of_chain(folder.path()));
}

TEST(ReportPage, ARunStandsBesideAnotherAndALaboratory) {
  const ScratchFolder a, b;
  test::write_chain(a.path());
  test::write_chain(b.path(), 8, 99);
  test::write_text(a / "lab.csv", "time [ms],pull [kN]\n0,0\n1,\n2,3\n");
  const Measured measured{"lab.csv", read_measured(a / "lab.csv")};
  const std::string html = page_of({read_record(a.path()), read_record(b.path())}, measured).html;
  const Json data = parsed_json(between(html, "id=\"data\">", "</script>"));
  EXPECT_EQ(data["runs"].size(), 2U);
  EXPECT_EQ(data["measured"]["columns"][1]["values"], Json::array({0.0, nullptr, 3000.0}));
  // Each frame has a blob of its own.
  EXPECT_GT(data["runs"][1]["film"]["frames"][0]["blob"],
            data["runs"][0]["film"]["frames"][2]["blob"]);
}

TEST(ReportPage, ALongHistoryIsThinnedAndSaysSo) {
  const ScratchFolder folder;
  test::write_chain(folder.path());
  std::string rows = "step,time\n-,s\n";
  for (int k = 0; k < 9001; ++k) rows += fmt::format("{0},{0}\n", k);
  test::write_text(folder / "history.csv", rows);
  const Page page = page_of({read_record(folder.path())}, std::nullopt);
  const Json data = parsed_json(between(page.html, "id=\"data\">", "</script>"));
  EXPECT_EQ(data["runs"][0]["history"]["rows"], 3001);
  ASSERT_EQ(page.notes.size(), 1U);
  EXPECT_EQ(page.notes[0], "One in 3 of the 9001 rows of history.csv is here.");
}

/// Exit code and words of `breccia report`.
struct Said {
  int exit_code;
  std::string text;
};
Said report(const std::string& arguments) {
  const ScratchFolder folder;
  const int exit_code = wait_for(start_program("report " + arguments, folder / "said"));
  return {exit_code, read_whole_file(folder / "said")};
}

TEST(ReportProgram, ItWritesTheReportIntoTheFolder) {
  const ScratchFolder folder;
  test::write_chain(folder.path());
  const Said said = report(folder.path());
  EXPECT_EQ(said.exit_code, 0) << said.text;
  EXPECT_NE(said.text.find("report.html"), std::string::npos);
  EXPECT_EQ(read_whole_file(folder / "report.html"), page_of_chain(folder.path()));
}

TEST(ReportProgram, WrongInputsAreNamed) {
  const ScratchFolder folder;
  test::write_chain(folder.path());
  Said said = report(folder / "nowhere");
  EXPECT_EQ(said.exit_code, 3);
  EXPECT_NE(said.text.find("there is no such folder"), std::string::npos) << said.text;
  said = report(folder / "history.csv");
  EXPECT_EQ(said.exit_code, 2);
  EXPECT_NE(said.text.find("report takes the result folder"), std::string::npos) << said.text;
  std::filesystem::create_directory(folder / "empty");
  said = report(folder / "empty");
  EXPECT_EQ(said.exit_code, 2);
  EXPECT_NE(said.text.find("holds no run"), std::string::npos) << said.text;
  EXPECT_EQ(report(folder.path() + " -o " + (folder / "report.pdf")).exit_code, 2);
  EXPECT_EQ(report(folder.path() + " --data " + (folder / "none.csv")).exit_code, 3);
  EXPECT_EQ(report(folder.path() + " -o " + (folder / "none/report.html")).exit_code, 3);
  EXPECT_EQ(report(folder.path() + " " + folder.path() + " " + folder.path()).exit_code, 2);
}

TEST(ReportProgram, APlaneBesideASpaceIsRefused) {
  const ScratchFolder space, plane;
  test::write_chain(space.path());
  test::write_text(plane / "summary.json", R"({"method": "fdem2d"})");
  const Said said = report(space.path() + " " + plane.path());
  EXPECT_EQ(said.exit_code, 2);
  EXPECT_NE(said.text.find("one camera cannot show both"), std::string::npos) << said.text;
}

TEST(ReportProgram, ADamagedFrameIsNamed) {
  const ScratchFolder folder;
  test::write_chain(folder.path());
  const std::string frame = folder / "fields/elements_0001.vtu";
  const std::string content = read_whole_file(frame);
  test::write_text(frame, content.substr(0, content.size() / 2));
  const Said said = report(folder.path());
  EXPECT_EQ(said.exit_code, 3);
  EXPECT_NE(said.text.find("elements_0001.vtu"), std::string::npos) << said.text;
  EXPECT_FALSE(std::filesystem::exists(folder / "report.html"));
  test::write_text(folder / "summary.json", "{ no json");
  EXPECT_EQ(report(folder.path()).exit_code, 2);
}

}  // namespace page_test
}  // namespace breccia::report
