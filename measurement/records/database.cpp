#include "measurement/records/database.h"

#include "reconstruction/base/require.h"

#include <QByteArray>
#include <QSqlDatabase>
#include <QSqlDriver>
#include <QSqlError>
#include <QSqlQuery>
#include <QSqlRecord>
#include <QVariant>

#include <atomic>
#include <unordered_map>
#include <utility>

namespace tarsus {

struct Database::Impl {
  QSqlDatabase connection;
  Engine engine = Engine::Sqlite;
  std::string place;  ///< file or server, for messages
  std::unordered_map<std::string, std::unique_ptr<QSqlQuery>> prepared;
  int depth = 0;
  bool doomed = false;  ///< an inner transaction was given up

  ~Impl() {
    prepared.clear();
    const QString name = connection.connectionName();
    connection = QSqlDatabase();
    QSqlDatabase::removeDatabase(name);
  }
};

namespace {

QVariant toVariant(const SqlValue& value) {
  if (const auto* number = std::get_if<std::int64_t>(&value)) {
    return QVariant(static_cast<qlonglong>(*number));
  }
  if (const auto* text = std::get_if<std::string>(&value)) {
    return QVariant(QString::fromStdString(*text));
  }
  const Bytes& bytes = std::get<Bytes>(value);
  // Never null: an empty QByteArray would be written as NULL.
  return QVariant(bytes.empty() ? QByteArray("", 0)
                                : QByteArray(reinterpret_cast<const char*>(bytes.data()),
                                             static_cast<int>(bytes.size())));
}

SqlValue fromVariant(const QVariant& value) {
  const int type = value.userType();
  if (type == QMetaType::QByteArray) {
    const QByteArray bytes = value.toByteArray();
    return Bytes(bytes.begin(), bytes.end());
  }
  if (type == QMetaType::LongLong || type == QMetaType::Int || type == QMetaType::ULongLong) {
    return static_cast<std::int64_t>(value.toLongLong());
  }
  return value.toString().toStdString();
}

ErrorCode sqliteCode(int native) {
  constexpr int kPrimary = 0xff;  // the rest of an extended code says where it happened
  switch (native & kPrimary) {
    case 5:  // SQLITE_BUSY
    case 6:  // SQLITE_LOCKED
      return ErrorCode::StoreBusy;
    case 8:   // SQLITE_READONLY
    case 10:  // SQLITE_IOERR
    case 14:  // SQLITE_CANTOPEN
      return ErrorCode::FileUnwritable;
    case 13:  // SQLITE_FULL
      return ErrorCode::DiskFull;
    case 11:  // SQLITE_CORRUPT
    case 26:  // SQLITE_NOTADB
      return ErrorCode::StoreDamaged;
    default:
      return ErrorCode::StoreFailed;
  }
}

ErrorCode postgresCode(const QString& state) {
  if (state == QLatin1String("53100")) {
    return ErrorCode::DiskFull;
  }
  if (state == QLatin1String("25006")) {
    return ErrorCode::FileUnwritable;
  }
  if (state == QLatin1String("55P03") || state == QLatin1String("40P01") ||
      state == QLatin1String("40001")) {
    return ErrorCode::StoreBusy;
  }
  return state.startsWith(QLatin1String("XX")) ? ErrorCode::StoreDamaged : ErrorCode::StoreFailed;
}

tl::unexpected<Error> sqlFailure(Database::Engine engine,
                                 const std::string& place,
                                 const QSqlError& error) {
  const QString native = error.nativeErrorCode();
  const ErrorCode code =
      engine == Database::Engine::Sqlite ? sqliteCode(native.toInt()) : postgresCode(native);
  const QString said = error.databaseText().isEmpty() ? error.driverText() : error.databaseText();
  return fail(code, place + ": " + said.simplified().toStdString());
}

/// Qt knows connections by name; each of ours has its own.
QString nextConnectionName() {
  static std::atomic<int> count = 0;
  return QStringLiteral("tarsus-records-%1").arg(++count);
}

/// PostgreSQL prepares nothing else.
bool isPreparable(std::string_view sql) {
  return sql.starts_with("SELECT") || sql.starts_with("INSERT") || sql.starts_with("UPDATE") ||
         sql.starts_with("DELETE") || sql.starts_with("WITH");
}

Expected<void> runPlain(QSqlDatabase& connection,
                        Database::Engine engine,
                        const std::string& place,
                        const char* sql) {
  QSqlQuery query(connection);
  if (!query.exec(QString::fromLatin1(sql))) {
    return sqlFailure(engine, place, query.lastError());
  }
  return {};
}

}  // namespace

std::int64_t SqlRow::integer(std::size_t column) const {
  const auto* value = std::get_if<std::int64_t>(&values_.at(column));
  return value != nullptr ? *value : 0;
}

std::string SqlRow::text(std::size_t column) const {
  const auto* value = std::get_if<std::string>(&values_.at(column));
  return value != nullptr ? *value : std::string();
}

Bytes SqlRow::bytes(std::size_t column) const {
  const auto* value = std::get_if<Bytes>(&values_.at(column));
  return value != nullptr ? *value : Bytes();
}

Database::Database(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Database::Database(Database&&) noexcept = default;
Database& Database::operator=(Database&&) noexcept = default;
Database::~Database() = default;

Database::Engine Database::engine() const { return impl_->engine; }

Expected<Database> Database::openSqlite(const std::filesystem::path& file) {
  auto impl = std::make_unique<Impl>();
  impl->place = file.string();
  impl->connection = QSqlDatabase::addDatabase(QStringLiteral("QSQLITE"), nextConnectionName());
  impl->connection.setDatabaseName(QString::fromStdString(file.string()));
  impl->connection.setConnectOptions(QStringLiteral("QSQLITE_BUSY_TIMEOUT=10000"));
  if (!impl->connection.isValid()) {
    return fail(ErrorCode::StoreFailed, "Qt's SQLite driver is missing");
  }
  if (!impl->connection.open()) {
    return sqlFailure(Engine::Sqlite, impl->place, impl->connection.lastError());
  }
  // secure_delete: what erasure removes is overwritten.
  for (const char* pragma : {"PRAGMA journal_mode = WAL",
                             "PRAGMA synchronous = FULL",
                             "PRAGMA foreign_keys = ON",
                             "PRAGMA secure_delete = ON"}) {
    if (auto set = runPlain(impl->connection, Engine::Sqlite, impl->place, pragma); !set) {
      return tl::unexpected(set.error());
    }
  }
  return Database(std::move(impl));
}

Expected<Database> Database::openPostgres(const PostgresAddress& address) {
  auto impl = std::make_unique<Impl>();
  impl->engine = Engine::Postgres;
  impl->place = "database " + address.database + " on " + address.host;
  impl->connection = QSqlDatabase::addDatabase(QStringLiteral("QPSQL"), nextConnectionName());
  if (!impl->connection.isValid()) {
    return fail(ErrorCode::StoreFailed,
                "Qt's PostgreSQL driver is missing; install the package libqt5sql5-psql");
  }
  impl->connection.setHostName(QString::fromStdString(address.host));
  if (address.port > 0) {
    impl->connection.setPort(address.port);
  }
  impl->connection.setDatabaseName(QString::fromStdString(address.database));
  impl->connection.setUserName(QString::fromStdString(address.user));
  impl->connection.setPassword(QString::fromStdString(address.password));
  impl->connection.setConnectOptions(QStringLiteral("connect_timeout=10"));
  if (!impl->connection.open()) {
    return sqlFailure(Engine::Postgres, impl->place, impl->connection.lastError());
  }
  for (const char* setting : {"SET lock_timeout = '10s'",
                              "SET synchronous_commit = on",
                              "SET client_min_messages = warning"}) {
    if (auto set = runPlain(impl->connection, Engine::Postgres, impl->place, setting); !set) {
      return tl::unexpected(set.error());
    }
  }
  return Database(std::move(impl));
}

Expected<std::vector<SqlRow>> Database::query(std::string_view sql,
                                              const std::vector<SqlValue>& values) {
  auto& statement = impl_->prepared[std::string(sql)];
  const QString text = QString::fromUtf8(sql.data(), static_cast<int>(sql.size()));
  if (!statement) {
    statement = std::make_unique<QSqlQuery>(impl_->connection);
    statement->setForwardOnly(true);
    if (isPreparable(sql) && !statement->prepare(text)) {
      auto failure = sqlFailure(impl_->engine, impl_->place, statement->lastError());
      statement.reset();
      return failure;
    }
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    statement->bindValue(static_cast<int>(i), toVariant(values[i]));
  }
  if (!(isPreparable(sql) ? statement->exec() : statement->exec(text))) {
    auto failure = sqlFailure(impl_->engine, impl_->place, statement->lastError());
    statement.reset();
    return failure;
  }
  std::vector<SqlRow> rows;
  const int columns = statement->isSelect() ? statement->record().count() : 0;
  while (columns > 0 && statement->next()) {
    std::vector<SqlValue> row;
    row.reserve(static_cast<std::size_t>(columns));
    for (int column = 0; column < columns; ++column) {
      row.push_back(fromVariant(statement->value(column)));
    }
    rows.emplace_back(std::move(row));
  }
  // The driver meets some failures (a damaged page) only while it walks the rows.
  if (statement->lastError().isValid()) {
    auto failure = sqlFailure(impl_->engine, impl_->place, statement->lastError());
    statement.reset();
    return failure;
  }
  if (columns == 0) {
    rows.emplace_back(
        std::vector<SqlValue>{static_cast<std::int64_t>(statement->numRowsAffected())});
  }
  statement->finish();
  return rows;
}

Expected<std::int64_t> Database::execute(std::string_view sql,
                                         const std::vector<SqlValue>& values) {
  auto rows = query(sql, values);
  if (!rows) {
    return tl::unexpected(rows.error());
  }
  return rows->empty() ? 0 : rows->front().integer(0);
}

Expected<Transaction> Transaction::begin(Database& database) {
  Database::Impl& impl = *database.impl_;
  if (impl.depth > 0) {
    ++impl.depth;
    return Transaction(impl, false);
  }
  const bool sqlite = impl.engine == Database::Engine::Sqlite;
  if (auto begun =
          runPlain(impl.connection, impl.engine, impl.place, sqlite ? "BEGIN IMMEDIATE" : "BEGIN");
      !begun) {
    return tl::unexpected(begun.error());
  }
  impl.depth = 1;
  impl.doomed = false;
  Transaction transaction(impl, true);
  if (!sqlite) {  // 7461727: "tar" in hexadecimal and our schema's line; any fixed number serves
    if (auto locked = runPlain(
            impl.connection, impl.engine, impl.place, "SELECT pg_advisory_xact_lock(7461727)");
        !locked) {
      return tl::unexpected(locked.error());
    }
  }
  return transaction;
}

Expected<Transaction> Transaction::beginSnapshot(Database& database) {
  Database::Impl& impl = *database.impl_;
  TARSUS_REQUIRE(impl.depth == 0, "a snapshot is not taken inside a change");
  const bool sqlite = impl.engine == Database::Engine::Sqlite;
  if (auto begun = runPlain(impl.connection,
                            impl.engine,
                            impl.place,
                            sqlite ? "BEGIN" : "BEGIN ISOLATION LEVEL REPEATABLE READ READ ONLY");
      !begun) {
    return tl::unexpected(begun.error());
  }
  impl.depth = 1;
  impl.doomed = false;
  return Transaction(impl, true);
}

Transaction::Transaction(Transaction&& other) noexcept
    : database_(std::exchange(other.database_, nullptr)), outermost_(other.outermost_) {}

Transaction::~Transaction() {
  if (database_ == nullptr) {
    return;
  }
  --database_->depth;
  if (!outermost_) {
    database_->doomed = true;
    return;
  }
  QSqlQuery(database_->connection).exec(QStringLiteral("ROLLBACK"));
}

Expected<void> Transaction::commit() {
  TARSUS_REQUIRE(database_ != nullptr, "a transaction is committed once");
  if (outermost_) {
    if (database_->doomed) {
      return fail(ErrorCode::StoreFailed, "a part of this change failed; nothing was written");
    }
    if (auto done = runPlain(database_->connection, database_->engine, database_->place, "COMMIT");
        !done) {
      return done;  // the destructor rolls back
    }
  }
  --database_->depth;
  database_ = nullptr;
  return {};
}

}  // namespace tarsus
