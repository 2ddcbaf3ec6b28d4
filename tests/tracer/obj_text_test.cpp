// What of an OBJ file's text reaches tinyobjloader.
#include "tracer/scene/obj_text.h"

#include <istream>
#include <iterator>

#include <gtest/gtest.h>

namespace {

using tracer::Job;
using tracer::ObjText;

struct Filtered {
  std::string text;
  tracer::ObjTextReport report;
};

Filtered filtered(std::string_view text) {
  const Job job;
  ObjText lines(text, job);
  std::istream stream(&lines);
  Filtered result;
  result.text.assign(std::istreambuf_iterator<char>(stream), {});
  result.report = lines.report();
  return result;
}

TEST(ObjText, PassesPlainLines) {
  EXPECT_EQ(filtered("v 1 2 3\nvt 0 1\nvn 0 0 1\nf 1/1/1 2/2/2 -1/-1/-1\n").text,
            "v 1 2 3\nvt 0 1\nvn 0 0 1\nf 1/1/1 2/2/2 -1/-1/-1\n");
}

TEST(ObjText, StripsAByteOrderMark) {
  EXPECT_EQ(filtered("\xef\xbb\xbfv 1 2 3\n").text, "v 1 2 3\n");
}

TEST(ObjText, EndsLinesAtAnyLineEnd) {
  EXPECT_EQ(filtered("v 1 2 3\r\nv 4 5 6\rv 7 8 9").text, "v 1 2 3\nv 4 5 6\nv 7 8 9\n");
}

TEST(ObjText, JoinsContinuedLines) {
  EXPECT_EQ(filtered("f 1 2 \\\n  3 \\ \r\n 4\nv 1 2 3\n").text, "f 1 2  3  4\nv 1 2 3\n");
}

TEST(ObjText, DoesNotContinueComments) {
  EXPECT_EQ(filtered("# C:\\scenes\\\nv 1 2 3\n").text, "v 1 2 3\n");
}

TEST(ObjText, DropsWhatCarriesNoTriangles) {
  const Filtered result = filtered("g a b\no c\ns off\nl 1 2\np 1\n\n# x\nv 1 2 3\n");
  EXPECT_EQ(result.text, "v 1 2 3\n");
  EXPECT_EQ(result.report.unknown, 0u);
}

TEST(ObjText, CountsUnknownLines) {
  const Filtered result = filtered("Once upon\na time\nv 1 2 3\n");
  EXPECT_EQ(result.report.unknown, 2u);
  EXPECT_EQ(result.report.understood, 1u);
}

TEST(ObjText, CollectsLibraries) {
  EXPECT_EQ(filtered("mtllib  a b.mtl \nmtllib c.mtl\n").report.libraries,
            (std::vector<std::string>{"a b.mtl", "c.mtl"}));
}

TEST(ObjText, TrimsMaterialNames) {
  EXPECT_EQ(filtered("usemtl \t Wood #25  \n").text, "usemtl Wood #25\n");
}

TEST(ObjText, ReadsDecimalCommasAndSaysSo) {
  const Filtered result = filtered("v 0,5 -1,25e1 3\n");
  EXPECT_EQ(result.text, "v 0.5 -12.5 3\n");
  EXPECT_EQ(result.report.decimal_commas.count, 1u);
  EXPECT_EQ(result.report.bad_numbers.count, 0u);
}

TEST(ObjText, MakesBadNumbersInfinite) {
  const Filtered result = filtered("v 1 nan 3\nv inf 2 abc\nv 1 2\nv\n");
  EXPECT_EQ(result.text, "v 1 1e999 3\nv 1e999 2 1e999\nv 1 2 1e999\nv 1e999 1e999 1e999\n");
  EXPECT_EQ(result.report.bad_numbers.count, 4u);
  EXPECT_EQ(result.report.bad_numbers.first, (std::vector<uint64_t>{1, 2, 3, 4}));
}

TEST(ObjText, HandsOnNoExponentThatOverflows) {
  EXPECT_EQ(filtered("v 1e99999999999 1e-99999999999 1e-5000\n").text, "v 1e999 0 0\n");
}

TEST(ObjText, KeepsColoursAndWeights) {
  EXPECT_EQ(filtered("v 1 2 3 0.5 0.5 0.5\n").text, "v 1 2 3 0.5 0.5 0.5\n");
}

TEST(ObjText, DropsACommentBehindNumbers) {
  EXPECT_EQ(filtered("v 1 2 3 # first\nf 1 2 3 # all\n").text, "v 1 2 3\nf 1 2 3\n");
}

TEST(ObjText, DropsFacesThatAreNone) {
  const Filtered result = filtered("f\nf 1\nf 1 2\nf 1 2 x\nf 1/2/3/4 2 3 4\nf 1,2,3\n");
  EXPECT_EQ(result.text, "");
  EXPECT_EQ(result.report.bad_faces.count, 7u);
  EXPECT_EQ(result.report.bad_faces.first, (std::vector<uint64_t>{1, 2, 3, 4, 5}));
  EXPECT_TRUE(result.report.bad_faces.more);
}

TEST(ObjText, DropsIndicesThatDoNotFit) {
  EXPECT_EQ(filtered("f 1 2 99999999999\n").text, "");
  EXPECT_EQ(filtered("f 1 2 2147483648\n").text, "");
  EXPECT_EQ(filtered("f 1 2 2147483647\n").text, "f 1 2 2147483647\n");
}

TEST(ObjText, TakesEndingSlashesOff) {
  EXPECT_EQ(filtered("f 1/ 2// 3/4/\n").text, "f 1 2 3/4\n");
  EXPECT_EQ(filtered("f / / /\n").text, "");
}

TEST(ObjText, SurvivesEveryByte) {
  std::string text;
  for (int i = 0; i < 256; ++i)
    text += std::string("v ") + char(i) + "\nf " + char(i) + " 1 2\n";
  EXPECT_GT(filtered(text).report.bad_faces.count, 200u);
}

TEST(ObjText, KnowsTheLineNumber) {
  const Job job;
  ObjText lines("v 1 2 3\n\n# x\nf 1 1 \\\n1\n", job);
  std::istream stream(&lines);
  std::string line;
  std::getline(stream, line);
  EXPECT_EQ(lines.line(), 1u);
  std::getline(stream, line);
  EXPECT_EQ(lines.line(), 5u);
}

TEST(LineListText, NamesTheFirstFive) {
  tracer::LineList list;
  add(list, 3);
  EXPECT_EQ(lines_text(list), "line 3");
  for (uint64_t line = 3; line < 9; ++line)
    add(list, line, 2);
  EXPECT_EQ(list.count, 13u);
  EXPECT_EQ(lines_text(list), "lines 3, 4, 5, 6, 7, ...");
}

}  // namespace
