/// The program itself: bytes, exit codes, sentences.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace {

namespace fs = std::filesystem;

std::string slurp(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

class RecaldSim : public ::testing::Test {
 protected:
  RecaldSim() {
    std::string pattern = (fs::temp_directory_path() / "recald-sim-XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
  }
  ~RecaldSim() override { fs::remove_all(folder_); }

  /// Exit code; what the program wrote to standard error is in `error_`.
  int run(const std::string& arguments) {
    const fs::path error = folder_ / "stderr";
    const int status = std::system((std::string(RECALD_SIM_PROGRAM) + " " + arguments + " >" +
                                    (folder_ / "stdout").string() + " 2>" + error.string())
                                       .c_str());
    error_ = slurp(error);
    return WEXITSTATUS(status);
  }

  [[nodiscard]] std::string out(const std::string& name) const { return (folder_ / name).string(); }

  fs::path folder_;
  std::string error_;
};

TEST_F(RecaldSim, SameSeedSameBytesAndOtherSeedOtherFeed) {
  ASSERT_EQ(run("building --years 1 --seed 5 --out " + out("a")), 0) << error_;
  ASSERT_EQ(run("building --years 1 --seed 5 --out " + out("b")), 0) << error_;
  ASSERT_EQ(run("building --years 1 --seed 6 --out " + out("c")), 0) << error_;
  for (const char* name : {"readings.csv", "weather.csv", "truth.json", "site.toml"}) {
    SCOPED_TRACE(name);
    EXPECT_EQ(slurp(folder_ / "a" / name), slurp(folder_ / "b" / name));
    EXPECT_FALSE(slurp(folder_ / "a" / name).empty());
  }
  for (const char* name : {"readings.csv", "weather.csv", "truth.json"}) {
    EXPECT_NE(slurp(folder_ / "a" / name), slurp(folder_ / "c" / name)) << name;
  }
  // What the user knows does not depend on what is true.
  EXPECT_EQ(slurp(folder_ / "a" / "site.toml"), slurp(folder_ / "c" / "site.toml"));
}

TEST_F(RecaldSim, NoFaultsLeavesEveryRowInPlace) {
  ASSERT_EQ(run("building --years 1 --no-faults --out " + out("clean")), 0) << error_;
  const std::string text = slurp(folder_ / "clean" / "readings.csv");
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1 + 3 * 365 * 96);
  EXPECT_EQ(text.find(",,"), std::string::npos);
}

TEST_F(RecaldSim, WrongUsageExitsWithTwo) {
  EXPECT_EQ(run(""), 2);
  EXPECT_EQ(run("building"), 2);
  EXPECT_NE(error_.find("--out"), std::string::npos) << error_;
  EXPECT_EQ(run("building --out " + out("x") + " --years 0"), 2);
  EXPECT_EQ(run("building --out " + out("x") + " --years many"), 2);
  EXPECT_EQ(run("building --out " + out("x") + " --sead 3"), 2);
  EXPECT_EQ(run("building --out " + out("x") + " --start 2030 --years 20"), 2);
  EXPECT_NE(error_.find("after 2036"), std::string::npos) << error_;
  EXPECT_FALSE(fs::exists(folder_ / "x"));
}

TEST_F(RecaldSim, FolderThatCannotBeMadeExitsWithOneAndOneSentence) {
  std::ofstream(folder_ / "file") << "not a folder";
  EXPECT_EQ(run("building --years 1 --out " + out("file/below")), 1);
  EXPECT_NE(error_.find("cannot make the folder"), std::string::npos) << error_;
  EXPECT_EQ(std::count(error_.begin(), error_.end(), '\n'), 1);
}

TEST_F(RecaldSim, FileThatCannotBeWrittenExitsWithOneAndOneSentence) {
  fs::create_directories(folder_ / "out" / "site.toml");  // a folder where a file must go
  EXPECT_EQ(run("building --years 1 --out " + out("out")), 1);
  EXPECT_NE(error_.find("cannot write"), std::string::npos) << error_;
  EXPECT_EQ(std::count(error_.begin(), error_.end(), '\n'), 1);
}

}  // namespace
