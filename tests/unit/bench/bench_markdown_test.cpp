// Texts in Markdown tables are judged by the reference implementation of GitHub's dialect, cmark-gfm.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>

#include "core/base/file.h"
#include "core/base/shell.h"
#include "core/bench/private/comparison.h"
#include "core/bench/private/markdown.h"
#include "core/bench/regression.h"
#include "core/bench/reproduction.h"
#include "core/bench/savings.h"
#include "core/bench/stress.h"
#include "core/bench/tables.h"
#include "tests/unit/bench/bench_rows.h"

namespace limn::bench {
namespace {

using testing::HasSubstr;
using testing::Not;

const std::vector<std::string> kHostile = {
    "<script>alert(1)</script>",
    "<img src=x onerror=alert(1)>",
    "</td><td>",
    "<!-- gone -->",
    "<?php x ?>",
    "a|b",
    "a\\|b",
    "a\\\\|b|",
    "ends with \\",
    "`code` ``more``",
    "[link](javascript:alert(1))",
    "![picture](http://example.org/x.png)",
    "[a][b] [^1]",
    "<http://example.org>",
    "see https://example.org/path?x=1 and www.example.org and ftp://example.org",
    "*a* **b** _c_ __d__ ~e~ ~~f~~ a*b*c",
    "&lt; &amp; &#65; & <",
    "trailing ##",
    "# heading #",
    "{{data}} ${x} $y$",
    "pcss.shadow_map_size=1024 env#0 <0.003 * 1 > 0",
    "--- | :-: |",
    "\xe2\x80\xaertl\xe2\x80\xac \xc3\xa4\xe2\x82\xac",
    "\"quoted\" 'single'",
};

/// What the text must become in HTML.
std::string html(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '&':
        result += "&amp;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

/// HTML of a page, raw HTML let through.
std::string rendered(const std::string& markdown) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("limn_markdown_" + std::to_string(::getpid()) + ".md");
  writeTextFile(file, markdown);
  const std::string command =
      "cmark-gfm --unsafe -e table -e autolink -e strikethrough " + shellQuoted(file.string());
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  std::string text;
  char buffer[4096];
  while (const std::size_t count = std::fread(buffer, 1, sizeof buffer, pipe.get()))
    text.append(buffer, count);
  std::filesystem::remove(file);
  return text;
}

bool hasReferenceImplementation() {
  return std::system("command -v cmark-gfm >/dev/null 2>&1") == 0;
}

TEST(BenchMarkdown, TextsAreShownAsTheyAre) {
  if (!hasReferenceImplementation()) GTEST_SKIP() << "no cmark-gfm (Debian package cmark-gfm)";
  for (const std::string& text : kHostile) {
    const std::string table = "| one | two |\n|---|---|\n" + markdownRow({text, "beside"});
    EXPECT_THAT(rendered(table), HasSubstr("<td>" + html(text) + "</td>\n<td>beside</td>\n</tr>")) << table;
    EXPECT_EQ(rendered("### t: " + markdownText(text) + "\n"), "<h3>t: " + html(text) + "</h3>\n");
  }
}

TEST(BenchMarkdown, TextsAreReadBack) {
  for (const std::string& text : kHostile) EXPECT_EQ(textOfMarkdown(markdownText(text)), text);
  EXPECT_EQ(textOfMarkdown("\\"), "\\") << "behind it is nothing that it could escape";
}

TEST(BenchMarkdown, ControlCharactersAndForeignBytesAreSeen) {
  EXPECT_EQ(markdownText("a\nb\r\nc\td"), "a b  c d");
  EXPECT_EQ(markdownText(std::string("\x1b[31m\0", 6)), "\xe2\x90\x9b\\[31m\xe2\x90\x80");
  EXPECT_EQ(markdownText("\x7f"), "\xe2\x90\xa1");
  // RFC 3629: a lone byte, an overlong form, a surrogate, a sequence that ends too early
  EXPECT_EQ(markdownText("\xff"), "\xef\xbf\xbd");
  EXPECT_EQ(markdownText("\xc0\xaf"), "\xef\xbf\xbd\xef\xbf\xbd");
  EXPECT_EQ(markdownText("\xed\xa0\x80").substr(0, 3), "\xef\xbf\xbd");
  EXPECT_EQ(markdownText("\xe2\x82"), "\xef\xbf\xbd\xef\xbf\xbd");
}

TEST(BenchMarkdown, NamesOfParametersStayReadable) {
  for (const char* text : {"pcss.shadow_map_size=1024", "balls, light env#0: direct, 64x48", "<0.003",
                           "1.00 (0.90 to 1.10)", "*", "-", "+0.01", "inf", "-inf"})
    EXPECT_EQ(markdownText(text), text);
}

TEST(BenchMarkdown, PicturesStayInTheirFolder) {
  EXPECT_EQ(markdownPicture("pictures/a-1.difference.png"), "![](pictures/a-1.difference.png)");
  EXPECT_EQ(markdownPicture("a) <b>|.png"), "![](a%29%20%3Cb%3E%7C.png)");
  EXPECT_EQ(markdownPicture("javascript:alert(1)"), "![](javascript%3Aalert%281%29)");
  for (const char* file : {"", "/etc/passwd", "../secret.png", "pictures/../../secret.png", ".."})
    EXPECT_EQ(markdownPicture(file), "") << file;
}

/// A row with the text in every place that a file of rows can give it.
Row hostileRow(const std::string& text) {
  Row row = test::exampleRow(test::exampleCase());
  Case& c = row.what;
  c.scene = c.camera = c.light = c.technique = c.title = c.term = text;
  c.parameters = {{text, text}};
  c.environment = text;
  c.environmentLights = 0.1;
  c.environmentShape = c.environmentReflection = c.environmentCombine = text;
  c.sigmaA = c.sigmaS = text;
  c.animation = c.grid = text;
  c.lightSettings = {text};
  row.cost.renderer = text;
  row.picture = row.difference = text;
  c.baseline = true;
  return row;
}

TEST(BenchMarkdown, NoPageHoldsMarkupOfARow) {
  const std::string text = "<b>|`x`\n\n# y\n";
  Row failed = hostileRow(text);
  failed.failure = text;
  failed.what.parameters = {{text, text + "y"}};
  Row other = hostileRow(text + "z");
  const std::vector<Row> rows = {hostileRow(text), failed, other};
  Row known = hostileRow(text);
  const std::vector<Row> before = {known, other};
  std::string pages = toMarkdown(compareResults(before, rows));
  for (const Table& table : makeTables(rows)) pages += toMarkdown(table) + picturesMarkdown(table);
  pages += comparisonMarkdown({"", "", rows});
  const std::vector<StressResult> stress = {{.technique = text,
                                             .name = text,
                                             .scene = text,
                                             .settings = text,
                                             .answers = {{.term = text, .message = text}, {.term = text}}}};
  pages += toMarkdown(stress);
  const std::vector<SavingResult> savings = {{.name = text, .how = text, .applies = true},
                                             {.name = text, .how = text}};
  pages += toMarkdown(savings);
  const std::vector<Claim> claims = {{.where = text,
                                      .what = text,
                                      .measure = ClaimMeasure::frame,
                                      .thesis = 1,
                                      .suite = "```\n# y\n",
                                      .slow = {"none"},
                                      .fast = {"none"}},
                                     {.where = text,
                                      .what = text,
                                      .measure = ClaimMeasure::frame,
                                      .thesis = 0,
                                      .suite = "",
                                      .slow = {},
                                      .fast = {},
                                      .because = text},
                                     {.where = text,
                                      .what = text,
                                      .measure = ClaimMeasure::frame,
                                      .thesis = 1,
                                      .suite = "",
                                      .slow = {"\nz$"},
                                      .fast = {"y\n$"}}};
  pages += reproductionMarkdown(claims, rows);
  EXPECT_THAT(pages, Not(HasSubstr("<b>")));
  EXPECT_THAT(pages, Not(HasSubstr("\n# y")));
  EXPECT_THAT(pages, Not(HasSubstr("`x`\n")));
}

TEST(BenchMarkdown, WordsOfAShellAreReadAsTheyWere) {
  for (const std::string& text : kHostile) {
    for (const std::string& more : {std::string(), std::string("'"), std::string("\n\x1b;$(id)\\'")}) {
      const std::string word = shellQuoted(text + more);
      EXPECT_TRUE(std::ranges::all_of(word, [](char c) { return c >= ' ' && c <= '~'; })) << word;
      const std::string command = "bash -c " + shellQuoted("printf %s " + word);
      const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
      std::string back;
      char buffer[512];
      while (const std::size_t count = std::fread(buffer, 1, sizeof buffer, pipe.get()))
        back.append(buffer, count);
      EXPECT_EQ(back, text + more) << word;
    }
  }
  EXPECT_EQ(shellQuoted(""), "''");
  EXPECT_EQ(shellQuoted("pcss.filter_samples=64"), "pcss.filter_samples=64");
}

}  // namespace
}  // namespace limn::bench
