#include "measurement/records/file_store.h"

#include "reconstruction/base/atomic_file.h"
#include "reconstruction/base/require.h"

#include <sodium.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <system_error>

namespace tarsus {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kChunk = std::size_t{1} << 16U;
constexpr std::size_t kSealedChunk = kChunk + crypto_secretstream_xchacha20poly1305_ABYTES;
constexpr std::size_t kNameLetters = 64;

using Chunk = std::span<const unsigned char>;
using Sink = std::function<Expected<void>(Chunk chunk, bool last)>;

Expected<void> unreadable(const fs::path& path) {
  return fail(ErrorCode::FileUnreadable, path.string());
}

/// Hands the file over in chunks of `size`; the last one (empty for an empty file) is named so.
Expected<void> forEachChunk(const fs::path& path, std::size_t size, const Sink& sink) {
  std::error_code error;
  if (!fs::exists(path, error)) {
    return fail(ErrorCode::FileMissing, path.string());
  }
  std::ifstream file(path, std::ios::binary);
  if (!fs::is_regular_file(path, error) || !file.is_open()) {
    return unreadable(path);
  }
  Bytes now(size);
  Bytes next(size);
  const auto read = [&](Bytes& chunk) {
    chunk.resize(size);
    file.read(reinterpret_cast<char*>(chunk.data()), static_cast<std::streamsize>(size));
    chunk.resize(static_cast<std::size_t>(file.gcount()));
  };
  read(now);
  for (bool last = false; !last; std::swap(now, next)) {
    read(next);
    if (file.bad()) {
      return unreadable(path);
    }
    last = next.empty();
    if (auto taken = sink(now, last); !taken) {
      return taken;
    }
  }
  return {};
}

class KeyedHash {
 public:
  explicit KeyedHash(const SecretKey& key) {
    crypto_generichash_init(&state_, key.data(), SecretKey::kSize, crypto_generichash_BYTES);
  }
  void update(Chunk chunk) { crypto_generichash_update(&state_, chunk.data(), chunk.size()); }
  std::string hex() {
    Bytes hash(crypto_generichash_BYTES);
    crypto_generichash_final(&state_, hash.data(), hash.size());
    return hexOf(hash);
  }

 private:
  crypto_generichash_state state_{};
};

Expected<std::string> nameOf(const SecretKey& key, const fs::path& source) {
  KeyedHash hash(key);
  auto read = forEachChunk(source, kChunk, [&](Chunk chunk, bool) -> Expected<void> {
    hash.update(chunk);
    return {};
  });
  if (!read) {
    return tl::unexpected(read.error());
  }
  return hash.hex();
}

tl::unexpected<Error> damaged(const fs::path& path) {
  return fail(ErrorCode::StoreDamaged,
              path.string() + " is not as it was written; restore this file");
}

bool isName(std::string_view name) {
  return name.size() == kNameLetters && std::ranges::all_of(name, [](char letter) {
           return (letter >= '0' && letter <= '9') || (letter >= 'a' && letter <= 'f');
         });
}

Expected<void> flushed(std::ofstream& file, const fs::path& path) {
  file.close();
  if (!file.fail()) {
    return {};
  }
  std::error_code error;
  const fs::space_info space = fs::space(path.parent_path(), error);
  const bool full = !error && space.available < kChunk;
  return fail(full ? ErrorCode::DiskFull : ErrorCode::FileUnwritable, path.string());
}

Expected<void> encrypt(const SecretKey& key,
                       const std::string& name,
                       const fs::path& source,
                       const fs::path& target) {
  std::ofstream file(target, std::ios::binary | std::ios::trunc);
  crypto_secretstream_xchacha20poly1305_state state;
  Bytes sealed(kSealedChunk);
  crypto_secretstream_xchacha20poly1305_init_push(&state, sealed.data(), key.data());
  file.write(reinterpret_cast<const char*>(sealed.data()),
             crypto_secretstream_xchacha20poly1305_HEADERBYTES);
  const auto* identity = reinterpret_cast<const unsigned char*>(name.data());
  auto read = forEachChunk(source, kChunk, [&](Chunk chunk, bool last) -> Expected<void> {
    unsigned long long size = 0;
    crypto_secretstream_xchacha20poly1305_push(
        &state,
        sealed.data(),
        &size,
        chunk.data(),
        chunk.size(),
        identity,
        name.size(),
        last ? crypto_secretstream_xchacha20poly1305_TAG_FINAL : 0);
    file.write(reinterpret_cast<const char*>(sealed.data()), static_cast<std::streamsize>(size));
    return {};
  });
  return read ? flushed(file, target) : read;
}

struct Keys {
  const SecretKey* names;
  const SecretKey* files;
};

Expected<Keys> keysOf(Vault& vault) {
  const auto names = vault.key(KeyPurpose::FileNames);
  const auto files = vault.key(KeyPurpose::Files);
  if (!names || !files) {
    return fail(ErrorCode::StoreLocked);
  }
  return Keys{.names = *names, .files = *files};
}

/// Hands the plain chunks over; the content's own name is checked at the end.
Expected<void> decrypt(const Keys& keys,
                       std::string_view name,
                       const fs::path& source,
                       const std::function<void(Chunk)>& plain_sink) {
  crypto_secretstream_xchacha20poly1305_state state;
  KeyedHash hash(*keys.names);
  const auto* identity = reinterpret_cast<const unsigned char*>(name.data());
  std::ifstream file(source, std::ios::binary);
  Bytes sealed(crypto_secretstream_xchacha20poly1305_HEADERBYTES);
  file.read(reinterpret_cast<char*>(sealed.data()), static_cast<std::streamsize>(sealed.size()));
  bool whole = file.gcount() == static_cast<std::streamsize>(sealed.size()) &&
               crypto_secretstream_xchacha20poly1305_init_pull(
                   &state, sealed.data(), keys.files->data()) == 0;
  unsigned char tag = 0;
  Bytes plain(kChunk);
  sealed.resize(kSealedChunk);
  while (whole && tag != crypto_secretstream_xchacha20poly1305_TAG_FINAL) {
    file.read(reinterpret_cast<char*>(sealed.data()), kSealedChunk);
    const auto got = static_cast<std::size_t>(file.gcount());
    unsigned long long size = 0;
    whole = got >= crypto_secretstream_xchacha20poly1305_ABYTES &&
            crypto_secretstream_xchacha20poly1305_pull(
                &state, plain.data(), &size, &tag, sealed.data(), got, identity, name.size()) == 0;
    if (whole) {
      const Chunk chunk(plain.data(), static_cast<std::size_t>(size));
      hash.update(chunk);
      plain_sink(chunk);
    }
  }
  whole = whole && file.peek() == std::ifstream::traits_type::eof() && hash.hex() == name;
  return whole ? Expected<void>() : damaged(source);
}

}  // namespace

fs::path FileStore::pathOf(std::string_view name) const {
  return folder_ / std::string(name.substr(0, 2)) /
         std::string(name.substr(std::min<std::size_t>(2, name.size())));
}

Expected<std::string> FileStore::put(Vault& vault, const fs::path& source) {
  const auto keys = keysOf(vault);
  if (!keys) {
    return tl::unexpected(keys.error());
  }
  auto name = nameOf(*keys->names, source);
  if (!name || verify(vault, *name)) {  // there already, and whole
    return name;
  }
  auto written = writeFileAtomically(pathOf(*name), [&](const fs::path& temporary) {
    return encrypt(*keys->files, *name, source, temporary);
  });
  if (written) {  // the source may have changed between the two readings
    written = verify(vault, *name);
  }
  if (!written) {
    return tl::unexpected(written.error());
  }
  return name;
}

Expected<void> FileStore::get(Vault& vault, std::string_view name, const fs::path& target) const {
  const auto keys = keysOf(vault);
  if (!keys) {
    return tl::unexpected(keys.error());
  }
  if (auto whole = verify(vault, name); !whole) {
    return whole;
  }
  return writeFileAtomically(target, [&](const fs::path& temporary) -> Expected<void> {
    std::ofstream file(temporary, std::ios::binary | std::ios::trunc);
    auto opened = decrypt(*keys, name, pathOf(name), [&](Chunk chunk) {
      file.write(reinterpret_cast<const char*>(chunk.data()),
                 static_cast<std::streamsize>(chunk.size()));
    });
    return opened ? flushed(file, temporary) : opened;
  });
}

Expected<void> FileStore::verify(Vault& vault, std::string_view name) const {
  const auto keys = keysOf(vault);
  if (!keys) {
    return tl::unexpected(keys.error());
  }
  if (!isName(name)) {
    return fail(ErrorCode::RecordInvalid, "\"" + std::string(name) + "\" names no stored file");
  }
  std::error_code error;
  if (!fs::is_regular_file(pathOf(name), error)) {
    return fail(ErrorCode::FileMissing, pathOf(name).string() + " is missing; restore this file");
  }
  return decrypt(*keys, name, pathOf(name), [](Chunk) {});
}

Expected<void> FileStore::remove(std::string_view name) {
  TARSUS_REQUIRE(isName(name), "only files of the store are removed");
  std::error_code error;
  fs::remove(pathOf(name), error);
  return error ? Expected<void>(fail(ErrorCode::FileUnwritable,
                                     pathOf(name).string() + ": " + error.message()))
               : Expected<void>();
}

Expected<std::vector<std::string>> FileStore::names() const {
  std::vector<std::string> names;
  std::error_code error;
  if (!fs::exists(folder_, error)) {
    return names;
  }
  fs::recursive_directory_iterator place(folder_, error);
  for (; !error && place != fs::recursive_directory_iterator(); place.increment(error)) {
    std::string name =
        place->path().parent_path().filename().string() + place->path().filename().string();
    if (place->is_regular_file(error) && isName(name)) {
      names.push_back(std::move(name));
    }
  }
  if (error) {
    return fail(ErrorCode::FileUnreadable, folder_.string() + ": " + error.message());
  }
  std::ranges::sort(names);
  return names;
}

}  // namespace tarsus
