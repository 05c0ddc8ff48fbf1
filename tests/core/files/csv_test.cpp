#include "hbar/core/files/csv.h"

#include <gtest/gtest.h>

#include "hbar/core/base/error.h"
#include "tests/support/message_of.h"
#include "tests/support/numerics.h"

namespace hbar::scene {
namespace {

std::vector<std::vector<std::string>> texts(std::string_view text) {
  std::vector<std::vector<std::string>> out;
  for (const CsvRow& row : parse_csv(text, "a.csv")) {
    out.emplace_back();
    for (const CsvCell& cell : row) {
      out.back().push_back(cell.text);
    }
  }
  return out;
}

TEST(Csv, ReadsCellsQuotesBlankLinesAndComments) {
  using Table = std::vector<std::vector<std::string>>;
  EXPECT_EQ(texts("a,b\n1,2\n"), (Table{{"a", "b"}, {"1", "2"}}));
  EXPECT_EQ(texts("a, b \r\n\r\n# note, \"\n,"), (Table{{"a", "b"}, {"", ""}}));
  EXPECT_EQ(texts("\"a,b\",\"say \"\"x\"\"\"\n\"two\nlines\",c"),
            (Table{{"a,b", "say \"x\""}, {"two\nlines", "c"}}));
  EXPECT_TRUE(texts("").empty());
  EXPECT_TRUE(texts("\n\n").empty());
}

TEST(Csv, KnowsWhereACellStands) {
  const std::vector<CsvRow> rows = parse_csv("# x\n\"a\nb\",cd,e\n f,g", "a.csv");
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0][0].line, 2);
  EXPECT_EQ(rows[0][2].line, 3);
  EXPECT_EQ(rows[0][2].column, 7);
  EXPECT_EQ(rows[1][1].line, 4);
  EXPECT_EQ(rows[1][1].column, 4);
}

TEST(Csv, ReadsWhatItWrites) {
  for (const std::string text :
       {"plain", "", "a,b", "say \"x\"", "two\nlines", " blanks ", "# no comment"}) {
    const auto table = texts(csv_cell(text) + ",end\n");
    ASSERT_EQ(table.size(), 1U) << text;
    EXPECT_EQ(table[0][0], text);
  }
}

TEST(Csv, SaysWhereItCannotBeRead) {
  const auto message = [](const auto& call) { return testing::message_of<InvalidInput>(call); };
  EXPECT_EQ(message([] { (void)parse_csv("a\nb,\"c\n", "a.csv"); }),
            "a.csv:2:3: a quote is opened here and not closed");
  EXPECT_EQ(message([] { (void)parse_csv("\"a\"b", "a.csv"); }).substr(0, 10), "a.csv:1:1:");
  EXPECT_EQ(message([] {
              (void)number_in({"1.5x", 7, 3}, "a.csv");
            }),
            "a.csv:7:3: \"1.5x\" is not a finite number");
  EXPECT_EQ(message([] {
              (void)number_in({"nan", 7, 3}, "a.csv");
            }),
            "a.csv:7:3: \"nan\" is not a finite number");
  EXPECT_EQ(message([] {
              (void)integer_in({"1.5", 7, 3}, "a.csv");
            }),
            "a.csv:7:3: \"1.5\" is not a whole number");
  EXPECT_EQ(number_in({"-1.5e3", 1, 1}, "a.csv"), -1500.0);
}

TEST(Csv, ReadsTablesOfSpreadsheets) {
  EXPECT_EQ(texts("\xef\xbb\xbftime;\"q;1\"\n0;1.5\n"),
            (std::vector<std::vector<std::string>>{{"time", "q;1"}, {"0", "1.5"}}));
  EXPECT_EQ(texts("\"a;b\",c\n1;2,3\n"),
            (std::vector<std::vector<std::string>>{{"a;b", "c"}, {"1;2", "3"}}));
  EXPECT_EQ(texts("# a; b, c\ntime;x"), (std::vector<std::vector<std::string>>{{"time", "x"}}));
  EXPECT_EQ(csv_cell("a;b"), "\"a;b\"");
  EXPECT_EQ(csv_cell("\xef\xbb\xbf#"), "\"\xef\xbb\xbf#\"") << "would be a mark and a comment";
}

}  // namespace
}  // namespace hbar::scene
