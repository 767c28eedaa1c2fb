#include "measurement/records/database.h"

#include "measurement/records/migrations.h"
#include "reconstruction/base/atomic_file.h"
#include "tests/measurement/records/record_test.h"

namespace tarsus {
namespace {

class DatabaseTest : public RecordTest {
 protected:
  Database connect() {
    return place_.postgres ? must(Database::openPostgres(*place_.postgres))
                           : must(Database::openSqlite(place_.folder / "records.sqlite"));
  }
};
TARSUS_ON_BOTH_ENGINES(DatabaseTest);

TEST_P(DatabaseTest, ValuesComeBackAsTheyWent) {
  Database database = connect();
  must(database.execute("CREATE TABLE t (a BIGINT, b TEXT, c BYTEA)"));
  const Bytes bytes{0, 255, 39, 92, 0};
  for (const Bytes& blob : {bytes, Bytes()}) {
    must(database.execute("DELETE FROM t"));
    must(database.execute("INSERT INTO t (a, b, c) VALUES (?, ?, ?)",
                          {std::int64_t{-9007199254740993}, std::string("'ü\\?"), blob}));
    const auto rows = must(database.query("SELECT a, b, c FROM t WHERE c = ?", {blob}));
    ASSERT_EQ(rows.size(), 1U);
    EXPECT_EQ(rows[0].integer(0), -9007199254740993);
    EXPECT_EQ(rows[0].text(1), "'ü\\?");
    EXPECT_EQ(rows[0].bytes(2), blob);
  }
}

TEST_P(DatabaseTest, WhatIsNotCommittedIsGone) {
  Database database = connect();
  must(database.execute("CREATE TABLE t (a BIGINT)"));
  const auto count = [&] { return must(database.query("SELECT a FROM t")).size(); };
  {
    Transaction outer = must(Transaction::begin(database));
    must(database.execute("INSERT INTO t (a) VALUES (1)"));
  }
  EXPECT_EQ(count(), 0U);
  {
    Transaction outer = must(Transaction::begin(database));
    must(database.execute("INSERT INTO t (a) VALUES (1)"));
    Transaction inner = must(Transaction::begin(database));
    must(inner.commit());
    must(outer.commit());
  }
  EXPECT_EQ(count(), 1U);
  {
    Transaction outer = must(Transaction::begin(database));
    must(database.execute("INSERT INTO t (a) VALUES (2)"));
    { const Transaction given_up = must(Transaction::begin(database)); }
    EXPECT_FALSE(outer.commit());
  }
  EXPECT_EQ(count(), 1U);
}

TEST_P(DatabaseTest, AFailedMigrationLeavesTheVersionBefore) {
  Database database = connect();
  const std::vector<MigrationText> steps{
      {1, "CREATE TABLE never_made (a BIGINT);\n"},  // taken already
      {2, "-- a comment; with a semicolon\nCREATE TABLE two (a BIGINT);\n"},
      {3, "CREATE TABLE three (a BIGINT);\nCREATE TABLE two (a BIGINT);\n"}};
  EXPECT_FALSE(migrate(database, steps));
  EXPECT_TRUE(database.query("SELECT a FROM two"));
  EXPECT_FALSE(database.query("SELECT a FROM three"));
  EXPECT_FALSE(database.query("SELECT a FROM never_made"));
  EXPECT_EQ(must(database.query("SELECT MAX(version) FROM schema_version")).front().integer(0), 2);
}

TEST_P(DatabaseTest, ANewerStoreIsRefusedAndLeftAlone) {
  {
    Database database = connect();
    must(database.execute("INSERT INTO schema_version (version) VALUES (999)"));
  }
  const auto store = Store::open(place_, testEnvironment(clock(), "ward 1"));
  expectFails(store, ErrorCode::StoreNewer);
}

TEST(SqliteFile, ThatIsNoneGivesASentence) {
  const TemporaryFolder folder;
  ASSERT_TRUE(writeTextAtomically(folder.path() / "records.sqlite",
                                  std::string(5000, 'x') + " this is no database"));
  const auto store = Store::open({.folder = folder.path()}, testEnvironment([] { return 0; }, "a"));
  expectFails(store, ErrorCode::StoreDamaged);
}

TEST(PostgresServerMissing, GivesASentence) {
  const TemporaryFolder folder;
  const auto store =
      Store::open({.folder = folder.path(),
                   .postgres = PostgresAddress{.host = folder.path(), .database = "none"}},
                  testEnvironment([] { return 0; }, "a"));
  expectFails(store, ErrorCode::StoreFailed);
}

}  // namespace
}  // namespace tarsus
