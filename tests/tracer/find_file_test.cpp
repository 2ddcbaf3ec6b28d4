// Finding the files that a scene file names.
#include "tracer/scene/find_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "temporary_folder.h"

namespace {

using testing::HasSubstr;
using tracer::find_file;

struct FindFile : testing::Test {
  TemporaryFolder folder;
  std::filesystem::path scene = folder.path / "scene";
  FindFile() {
    folder.file("outside.png");
    folder.file("scene/Wood.PNG");
    folder.file("scene/with space.png");
    folder.file("scene/maps/stone.png");
  }
};

TEST_F(FindFile, Beside) {
  EXPECT_EQ(find_file(scene, "Wood.PNG").path, scene / "Wood.PNG");
}

TEST_F(FindFile, InASubfolder) {
  EXPECT_EQ(find_file(scene, "maps/stone.png").path, scene / "maps/stone.png");
  EXPECT_EQ(find_file(scene, ".\\maps\\stone.png").path, scene / "maps/stone.png");
  EXPECT_EQ(find_file(scene, "maps/../Wood.PNG").path, scene / "Wood.PNG");
}

TEST_F(FindFile, InAnotherCase) {
  EXPECT_EQ(find_file(scene, "wood.png").path, scene / "Wood.PNG");
  EXPECT_EQ(find_file(scene, "MAPS/Stone.png").path, scene / "maps/stone.png");
}

TEST_F(FindFile, WithBlanksAndQuotes) {
  EXPECT_EQ(find_file(scene, "with space.png").path, scene / "with space.png");
  EXPECT_EQ(find_file(scene, "with\\ space.png").path, scene / "with space.png");
  EXPECT_EQ(find_file(scene, "\"with space.png\"").path, scene / "with space.png");
}

TEST_F(FindFile, OfAnotherMachine) {
  EXPECT_EQ(find_file(scene, "C:\\work\\maps\\wood.png").path, scene / "Wood.PNG");
  EXPECT_EQ(find_file(scene, "/home/somebody/wood.png").path, scene / "Wood.PNG");
  EXPECT_EQ(find_file(scene, "textures/wood.png").path, scene / "Wood.PNG");
}

TEST_F(FindFile, NeverOutside) {
  for (const char* name : {"../outside.png", "maps/../../outside.png", "..\\outside.png"}) {
    EXPECT_FALSE(find_file(scene, name).path);
    EXPECT_THAT(find_file(scene, name).problem, HasSubstr("outside of the scene's folder"));
  }
  EXPECT_FALSE(find_file(scene, (folder.path / "outside.png").string()).path);
}

TEST_F(FindFile, OddNames) {
  for (const std::string& name :
       {std::string(), std::string(1, '\0'), std::string(5000, 'a'), std::string("."),
        std::string(".."), std::string("maps/"), std::string("\\ "), std::string("nothing.png")}) {
    EXPECT_FALSE(find_file(scene, name).path);
    EXPECT_FALSE(find_file(scene, name).problem.empty());
  }
}

}  // namespace
