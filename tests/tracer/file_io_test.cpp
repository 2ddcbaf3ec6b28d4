// Whole files in and out.
#include "tracer/file_io.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "temporary_folder.h"

namespace {

using testing::HasSubstr;
using tracer::read_file;
using tracer::write_file_atomically;

size_t files_in(const std::filesystem::path& folder) {
  size_t count = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder))
    ++count;
  return count;
}

TEST(ReadFile, GivesAllBytes) {
  const TemporaryFolder folder;
  const std::string bytes("a\0b\r\n\xff", 6);
  EXPECT_EQ(read_file(folder.file("x", bytes), 6), bytes);
}

TEST(ReadFile, EmptyFileIsEmpty) {
  const TemporaryFolder folder;
  EXPECT_EQ(read_file(folder.file("x"), 10), "");
}

TEST(ReadFile, RefusesMoreThanTheLimit) {
  const TemporaryFolder folder;
  const auto file = folder.file("big", "1234567");
  EXPECT_THAT(message_of([&] { read_file(file, 6); }), HasSubstr("big: has 7 bytes"));
}

TEST(ReadFile, NamesAMissingFile) {
  EXPECT_THAT(message_of([] { read_file("no/such/file", 10); }),
              "no/such/file: the file does not exist");
}

TEST(ReadFile, RefusesAFolder) {
  const TemporaryFolder folder;
  EXPECT_THAT(message_of([&] { read_file(folder.path, 10); }), HasSubstr("is a folder"));
}

TEST(ReadFile, RefusesAPipeAtOnce) {
  const TemporaryFolder folder;
  const auto pipe = folder.path / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THAT(message_of([&] { read_file(pipe, 10); }), HasSubstr("not a regular file"));
}

TEST(WriteFile, WritesANewFile) {
  const TemporaryFolder folder;
  write_file_atomically(folder.path / "new", "abc");
  EXPECT_EQ(read_file(folder.path / "new", 10), "abc");
  EXPECT_EQ(files_in(folder.path), 1u);
}

TEST(WriteFile, ReplacesAFileAndKeepsItsMode) {
  const TemporaryFolder folder;
  const auto file = folder.file("old", "a long old content");
  ASSERT_EQ(chmod(file.c_str(), 0640), 0);
  write_file_atomically(file, "new");
  EXPECT_EQ(read_file(file, 10), "new");
  struct stat status {};
  ASSERT_EQ(stat(file.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0640u);
  EXPECT_EQ(files_in(folder.path), 1u);
}

TEST(WriteFile, FollowsALink) {
  const TemporaryFolder folder;
  const auto file = folder.file("target", "old");
  std::filesystem::create_symlink("target", folder.path / "link");
  write_file_atomically(folder.path / "link", "new");
  EXPECT_TRUE(std::filesystem::is_symlink(folder.path / "link"));
  EXPECT_EQ(read_file(file, 10), "new");
}

TEST(WriteFile, RefusesAFolder) {
  const TemporaryFolder folder;
  EXPECT_THAT(message_of([&] { write_file_atomically(folder.path, "x"); }),
              HasSubstr("it is a folder"));
}

TEST(WriteFile, NamesFileBytesAndReason) {
  const TemporaryFolder folder;
  const std::string message =
      message_of([&] { write_file_atomically(folder.path / "missing" / "out.png", "12345"); });
  EXPECT_THAT(message, HasSubstr("out.png: cannot write 5 bytes: No such file or directory"));
}

TEST(WriteFile, AFullDiskIsTold) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  EXPECT_THAT(message_of([] { write_file_atomically("/dev/full", "x"); }),
              HasSubstr("No space left on device; free some space"));
}

TEST(WriteFile, LeavesADeviceInPlace) {
  write_file_atomically("/dev/null", "x");
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

TEST(WriteFile, AcceptsALongName) {
  const TemporaryFolder folder;
  const auto file = folder.path / std::string(255, 'n');
  write_file_atomically(file, "abc");
  EXPECT_EQ(read_file(file, 10), "abc");
}

TEST(WriteFile, AnUnwritableFileStaysAsItIs) {
  if (geteuid() == 0) GTEST_SKIP() << "root may write everything";
  const TemporaryFolder folder;
  const auto file = folder.file("locked", "old");
  ASSERT_EQ(chmod(file.c_str(), 0400), 0);
  EXPECT_THAT(message_of([&] { write_file_atomically(file, "new"); }),
              HasSubstr("Permission denied"));
  EXPECT_EQ(read_file(file, 10), "old");
}

}  // namespace
