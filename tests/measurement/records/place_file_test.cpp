#include "measurement/records/place_file.h"

#include "tests/measurement/records/record_test.h"

#include <gtest/gtest.h>

#include <fstream>

namespace tarsus {
namespace {

namespace fs = std::filesystem;

TEST(PlaceFile, WithoutItTheRecordsLieBesideIt) {
  EXPECT_EQ(must(readStorePlace("/srv/data/records.json")).folder, "/srv/data/records");
}

TEST(PlaceFile, FolderAndServerComeBackAsTheyWereWritten) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "new" / "records.json";
  StorePlace place{.folder = folder.path() / "a folder" / ".." / "ward \"3\"",
                   .postgres = must(postgresAddressOf("host=db.ward port=5433 dbname=t user=u"))};
  must(writeStorePlace(file, place));
  const StorePlace read = must(readStorePlace(file));
  EXPECT_EQ(read.folder, folder.path() / "ward \"3\"");
  ASSERT_TRUE(read.postgres);
  EXPECT_EQ(read.postgres->host, "db.ward");
  EXPECT_EQ(read.postgres->port, 5433);
  EXPECT_EQ(read.postgres->database, "t");
  EXPECT_EQ(read.postgres->user, "u");
  place.postgres.reset();
  must(writeStorePlace(file, place));
  EXPECT_FALSE(must(readStorePlace(file)).postgres);
}

TEST(PlaceFile, WhatMakesNoSenseIsSaid) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "records.json";
  for (const char* text : {"",
                           "{",
                           "[]",
                           "{\"folder\": 3}",
                           "{\"folder\": \"\"}",
                           "{\"folder\": \"/x\", \"postgres\": \"hots=a\"}"}) {
    std::ofstream(file) << text;
    const auto place = readStorePlace(file);
    ASSERT_FALSE(place) << text;
    EXPECT_EQ(place.error().code, ErrorCode::FileUnreadable) << text;
  }
}

TEST(PlaceFile, AServersAddressIsReadStrictly) {
  for (const char* text :
       {"host", "host=", "port=x", "port=0", "port=70000", "port=5x", "pasword=a"}) {
    const auto address = postgresAddressOf(text);
    ASSERT_FALSE(address) << text;
    EXPECT_EQ(address.error().code, ErrorCode::BadOption) << text;
  }
}

}  // namespace
}  // namespace tarsus
