#include "measurement/records/file_store.h"

#include "reconstruction/base/atomic_file.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

namespace tarsus {
namespace {

namespace fs = std::filesystem;

class FileStoreTest : public testing::Test {
 protected:
  FileStoreTest() { vault_.unlock(SecretKey::random()); }
  std::string put(const std::string& text) {
    source_ = folder_.path() / "source";
    EXPECT_TRUE(writeTextAtomically(source_, text));
    return files_.put(vault_, source_).value();
  }
  TemporaryFolder folder_;
  fs::path source_;
  Vault vault_{[] { return std::int64_t{0}; }, std::nullopt};
  FileStore files_{folder_.path() / "files"};
};

/// Sizes around the chunk of 64 KiB, where an off-by-one would sit.
TEST_F(FileStoreTest, GivesBackWhatWasPut) {
  for (const std::size_t size : {0U, 1U, 65535U, 65536U, 65537U, 131072U, 300000U}) {
    std::string text(size, 'x');
    for (std::size_t i = 0; i < size; ++i) {
      text[i] = static_cast<char>(i * 31 + i / 257);
    }
    const std::string name = put(text);
    const fs::path target = folder_.path() / "target";
    ASSERT_TRUE(files_.get(vault_, name, target)) << size;
    EXPECT_EQ(readTextFile(target).value(), text);
    const std::string kept = readTextFile(files_.pathOf(name)).value();
    EXPECT_EQ(size >= 16 && kept.find(text.substr(0, 16)) != std::string::npos, false);
  }
}

TEST_F(FileStoreTest, KeepsTheSameContentOnceUnderANameThatNeedsTheKey) {
  const std::string name = put("a model");
  EXPECT_EQ(put("a model"), name);
  EXPECT_EQ(files_.names().value(), std::vector<std::string>{name});
  vault_.unlock(SecretKey::random());
  EXPECT_NE(put("a model"), name);
}

TEST_F(FileStoreTest, FindsAnyChangeAndWritesNothingThen) {
  const std::string name = put(std::string(70000, 'm'));
  const std::string whole = readTextFile(files_.pathOf(name)).value();
  const fs::path target = folder_.path() / "target";
  std::vector<std::string> damaged{whole.substr(0, whole.size() - 1),
                                   whole.substr(0, 24 + 65553),  // a whole first chunk, no end
                                   whole + "x",
                                   whole.substr(0, 10),
                                   ""};
  for (const std::size_t at : {0UL, 23UL, 30UL, 65600UL, whole.size() - 1}) {
    damaged.push_back(whole);
    damaged.back()[at] = static_cast<char>(damaged.back()[at] ^ 1);
  }
  for (const std::string& bytes : damaged) {
    ASSERT_TRUE(writeTextAtomically(files_.pathOf(name), bytes));
    const auto got = files_.get(vault_, name, target);
    ASSERT_FALSE(got);
    EXPECT_EQ(got.error().code, ErrorCode::StoreDamaged);
    EXPECT_NE(got.error().detail.find(files_.pathOf(name).string()), std::string::npos);
    EXPECT_FALSE(fs::exists(target));
  }
  EXPECT_EQ(put(std::string(70000, 'm')), name);  // putting it again mends it
  EXPECT_TRUE(files_.get(vault_, name, target));
}

TEST_F(FileStoreTest, AFileUnderTheNameOfAnotherIsFound) {
  const std::string one = put("one");
  const std::string two = put("two");
  fs::copy_file(files_.pathOf(one), files_.pathOf(two), fs::copy_options::overwrite_existing);
  EXPECT_EQ(files_.verify(vault_, two).error().code, ErrorCode::StoreDamaged);
}

TEST_F(FileStoreTest, NamesTheMissingFileAndNeedsTheKey) {
  const std::string name = put("gone");
  ASSERT_TRUE(files_.remove(name));
  const auto missing = files_.verify(vault_, name);
  EXPECT_EQ(missing.error().code, ErrorCode::FileMissing);
  EXPECT_NE(missing.error().detail.find("restore"), std::string::npos);
  EXPECT_FALSE(files_.verify(vault_, "../../etc/passwd"));
  EXPECT_EQ(files_.put(vault_, folder_.path() / "nothing").error().code, ErrorCode::FileMissing);
  vault_.lock();
  EXPECT_EQ(files_.put(vault_, source_).error().code, ErrorCode::StoreLocked);
}

}  // namespace
}  // namespace tarsus
