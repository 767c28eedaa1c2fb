-- Everything clinical lies in `sealed`; what stands in clear is what finding and checking need.
-- BYTEA is PostgreSQL's word; SQLite takes it and keeps the bytes as they are.

-- Where each record stands now: always the same as its latest revision.
CREATE TABLE records (
  id TEXT PRIMARY KEY,
  kind TEXT NOT NULL,
  parent TEXT NOT NULL,
  revision BIGINT NOT NULL,
  entry BIGINT NOT NULL,
  state TEXT NOT NULL,
  trashed BIGINT NOT NULL
);
CREATE INDEX record_parent ON records (parent);
CREATE INDEX record_kind ON records (kind, entry);
CREATE INDEX record_state ON records (kind, state);

-- Only ever added to; erasure empties `sealed` and nothing else.
CREATE TABLE revisions (
  record TEXT NOT NULL REFERENCES records (id),
  revision BIGINT NOT NULL,
  entry BIGINT NOT NULL,
  parent TEXT NOT NULL,
  state TEXT NOT NULL,
  trashed BIGINT NOT NULL,
  at_ms BIGINT NOT NULL,
  author TEXT NOT NULL,
  station TEXT NOT NULL,
  action TEXT NOT NULL,
  sealed BYTEA NOT NULL,
  PRIMARY KEY (record, revision)
);
CREATE UNIQUE INDEX revision_entry ON revisions (entry);

CREATE TABLE file_use (
  file TEXT NOT NULL,
  record TEXT NOT NULL REFERENCES records (id),
  PRIMARY KEY (file, record)
);
CREATE INDEX file_use_record ON file_use (record);

CREATE TABLE audit (
  entry BIGINT PRIMARY KEY,
  at_ms BIGINT NOT NULL,
  who TEXT NOT NULL,
  station TEXT NOT NULL,
  action TEXT NOT NULL,
  subject TEXT NOT NULL,
  revision BIGINT NOT NULL,
  digest BYTEA NOT NULL,
  details BYTEA NOT NULL,
  hash BYTEA NOT NULL
);
CREATE INDEX audit_subject ON audit (subject);

-- The store key, wrapped once for each user's password and once for the recovery code.
CREATE TABLE key_wrap (
  holder TEXT PRIMARY KEY,
  user_record TEXT NOT NULL,
  salt BYTEA NOT NULL,
  operations BIGINT NOT NULL,
  memory_bytes BIGINT NOT NULL,
  sealed BYTEA NOT NULL,
  failures BIGINT NOT NULL,
  last_failure_ms BIGINT NOT NULL
);
