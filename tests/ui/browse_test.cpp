// The file browser: listing, what a typed name means, and its window.
#include "ui/browse.h"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "driver.h"

namespace {

namespace fs = std::filesystem;
using ui::FilePurpose;

class Browse : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() / ("bvhscope_browse_" + std::string(test->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "models");
    for (const char* name : {"b.obj", "A.OBJ", "notes.txt", ".hidden.obj", "sky.hdr"}) {
      std::ofstream(folder_ / name) << "x";
    }
    std::ofstream(folder_ / "models" / "\xc3\xa4 cow.obj") << "x";
  }
  void TearDown() override { fs::remove_all(folder_); }

  ui::FileBrowser opened(FilePurpose purpose) const {
    ui::FileBrowser browser;
    browser.folder = folder_;
    ui::open_browser(browser, purpose);
    return browser;
  }

  fs::path folder_;
};

std::vector<std::string> names(const ui::FileBrowser& browser) {
  std::vector<std::string> result;
  for (const ui::FileEntry& entry : browser.entries)
    result.push_back(entry.name);
  return result;
}

TEST_F(Browse, ListsFoldersFirstThenKnownFilesByName) {
  EXPECT_EQ(names(opened(FilePurpose::open_scene)),
            (std::vector<std::string>{"models", "A.OBJ", "b.obj"}));
}

TEST_F(Browse, ASkyIsAnotherKindOfFile) {
  EXPECT_EQ(names(opened(FilePurpose::open_sky)), (std::vector<std::string>{"models", "sky.hdr"}));
}

TEST_F(Browse, AllFilesMeansAllButHiddenOnes) {
  ui::FileBrowser browser = opened(FilePurpose::open_scene);
  browser.all_files = true;
  ui::enter_folder(browser, folder_);
  EXPECT_EQ(browser.entries.size(), 5u);
}

TEST_F(Browse, AFolderThatIsNotThereKeepsTheOldListAndSaysSo) {
  ui::FileBrowser browser = opened(FilePurpose::open_scene);
  ui::enter_folder(browser, folder_ / "nothing");
  EXPECT_EQ(browser.folder, folder_);
  EXPECT_EQ(browser.entries.size(), 3u);
  EXPECT_NE(browser.error.find("nothing"), std::string::npos);
}

TEST_F(Browse, ATypedNameIsAFileOfTheFolder) {
  ui::FileBrowser browser = opened(FilePurpose::open_scene);
  browser.typed = "b.obj";
  EXPECT_EQ(ui::take_typed(browser), folder_ / "b.obj");
}

TEST_F(Browse, ATypedPathIsTaken) {
  ui::FileBrowser browser = opened(FilePurpose::open_scene);
  browser.typed = (folder_ / "models" / "\xc3\xa4 cow.obj").string();
  EXPECT_EQ(ui::take_typed(browser), folder_ / "models" / "\xc3\xa4 cow.obj");
}

TEST_F(Browse, ATypedFolderIsEntered) {
  ui::FileBrowser browser = opened(FilePurpose::open_scene);
  browser.typed = "models";
  EXPECT_FALSE(ui::take_typed(browser).has_value());
  EXPECT_EQ(names(browser), (std::vector<std::string>{"\xc3\xa4 cow.obj"}));
  browser.typed = "..";
  EXPECT_FALSE(ui::take_typed(browser).has_value());
  EXPECT_EQ(browser.entries.size(), 3u);
}

TEST_F(Browse, AMissingFileIsAnError) {
  ui::FileBrowser browser = opened(FilePurpose::open_scene);
  browser.typed = "missing.obj";
  EXPECT_FALSE(ui::take_typed(browser).has_value());
  EXPECT_NE(browser.error.find("missing.obj"), std::string::npos);
}

TEST_F(Browse, SavingAddsTheEnding) {
  ui::FileBrowser browser = opened(FilePurpose::save_picture);
  browser.typed = "shot";
  EXPECT_EQ(ui::take_typed(browser), folder_ / "shot.png");
  browser.typed = "shot.exr";
  EXPECT_EQ(ui::take_typed(browser), folder_ / "shot.exr");
}

TEST_F(Browse, SavingOverAFileAsksFirst) {
  std::ofstream(folder_ / "shot.png") << "x";
  ui::FileBrowser browser = opened(FilePurpose::save_picture);
  browser.typed = "shot.png";
  EXPECT_FALSE(ui::take_typed(browser).has_value());
  EXPECT_TRUE(browser.confirm);
  EXPECT_EQ(ui::take_typed(browser), folder_ / "shot.png");
}

TEST_F(Browse, SavingIntoAMissingFolderIsAnError) {
  ui::FileBrowser browser = opened(FilePurpose::save_session);
  browser.typed = "nowhere/session.json";
  EXPECT_FALSE(ui::take_typed(browser).has_value());
  EXPECT_NE(browser.error.find("nowhere"), std::string::npos);
}

TEST_F(Browse, TheWindowOpensADoubleClickedFile) {
  ui::Driver driver("");
  driver.state.browser.folder = folder_;
  driver.menu({"File", "Open scene..."});
  driver.double_click("browser/files/b.obj");
  EXPECT_EQ(driver.requests.open, (folder_ / "b.obj").string());
  EXPECT_FALSE(driver.state.browser.visible);
  EXPECT_EQ(driver.state.recent_files, (std::vector<std::string>{(folder_ / "b.obj").string()}));
}

TEST_F(Browse, TheWindowGoesIntoFoldersAndBackByTheirNames) {
  ui::Driver driver("");
  driver.state.browser.folder = folder_;
  driver.press('O', true);
  driver.click("browser/files/models");
  EXPECT_EQ(driver.state.browser.folder, folder_ / "models");
  driver.click("browser/path/" + folder_.filename().string());
  EXPECT_EQ(driver.state.browser.folder, folder_);
}

TEST_F(Browse, ANameTypedAndEnterOpens) {
  ui::Driver driver("");
  driver.state.browser.folder = folder_;
  driver.press('O', true);
  driver.frame(3);
  driver.type("b.obj\n");
  EXPECT_EQ(driver.requests.open, (folder_ / "b.obj").string());
}

TEST_F(Browse, EscapeAndCancelClose) {
  ui::Driver driver("");
  driver.state.browser.folder = folder_;
  driver.press('O', true);
  driver.frame(3);
  ASSERT_TRUE(driver.state.browser.visible);
  driver.press(ui::key_escape);
  EXPECT_FALSE(driver.state.browser.visible);
  driver.press('O', true);
  driver.click("browser/Cancel");
  EXPECT_FALSE(driver.state.browser.visible);
  EXPECT_FALSE(driver.requests.open.has_value());
}

TEST_F(Browse, TheButtonReplacesOnlyWhenAskedTwice) {
  std::ofstream(folder_ / "session.json") << "x";
  ui::Driver driver("");
  driver.state.browser.folder = folder_;
  driver.press('S', true);
  driver.click("browser/Save");
  EXPECT_FALSE(driver.requests.save_session.has_value());
  driver.click("browser/Replace");
  EXPECT_EQ(driver.requests.save_session, (folder_ / "session.json").string());
}

TEST_F(Browse, AllFilesIsABoxInTheWindow) {
  ui::Driver driver("");
  driver.state.browser.folder = folder_;
  driver.press('O', true);
  driver.click("browser/All files");
  EXPECT_TRUE(driver.is_there("browser/files/notes.txt"));
}

TEST_F(Browse, PlacesAndRecentFiles) {
  ui::Driver driver("");
  driver.state.browser.folder = folder_;
  driver.state.recent_files = {"/somewhere/cow.obj"};
  driver.press('O', true);
  driver.click("browser/places/Start folder");
  EXPECT_EQ(driver.state.browser.folder, fs::current_path());
  driver.click("browser/places//somewhere/cow.obj");
  EXPECT_EQ(driver.requests.open, "/somewhere/cow.obj");
}

TEST_F(Browse, TheSkyBecomesPartOfTheScene) {
  ui::Driver driver;
  driver.state.browser.folder = folder_;
  driver.menu({"File", "Open sky..."});
  driver.double_click("browser/files/sky.hdr");
  EXPECT_EQ(driver.edited.settings.source.sky_file, (folder_ / "sky.hdr").string());
}

TEST_F(Browse, PictureAndSessionsAreRequested) {
  ui::Driver driver;
  driver.state.browser.folder = folder_;
  std::ofstream(folder_ / "old.json") << "{}";
  driver.menu({"File", "Save picture..."});
  driver.click("browser/Save");
  EXPECT_EQ(driver.requests.save_picture, (folder_ / "picture.png").string());
  driver.menu({"File", "Open session..."});
  driver.double_click("browser/files/old.json");
  EXPECT_EQ(driver.requests.open_session, (folder_ / "old.json").string());
}

}  // namespace
