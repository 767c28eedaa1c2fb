#include "measurement/records/export/archive.h"

#include "reconstruction/base/atomic_file.h"
#include "reconstruction/base/sha256.h"

#include <nlohmann/json.hpp>
#include <zip.h>

#include <algorithm>
#include <cerrno>
#include <memory>
#include <vector>

namespace tarsus {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// Relative, in order.
std::vector<fs::path> filesBelow(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::recursive_directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    if (entry->is_regular_file()) {
      files.push_back(fs::relative(entry->path(), folder));
    }
  }
  std::ranges::sort(files);
  return files;
}

struct ZipCloser {
  void operator()(zip_t* archive) const { zip_discard(archive); }
};

}  // namespace

Expected<ExportSummary> writeManifest(const fs::path& folder, json about) {
  ExportSummary summary;
  json list = json::array();
  for (const fs::path& file : filesBelow(folder)) {
    const auto sum = sha256OfFile(folder / file);
    if (!sum) {
      return tl::unexpected(sum.error());
    }
    const std::uintmax_t bytes = fs::file_size(folder / file);
    list.push_back({{"file", file.generic_string()}, {"bytes", bytes}, {"sha256", *sum}});
    ++summary.files;
    summary.bytes += bytes;
  }
  about["files"] = list;
  if (auto written = writeTextAtomically(folder / "manifest.json", about.dump(1) + "\n");
      !written) {
    return tl::unexpected(written.error());
  }
  return summary;
}

Expected<void> packZip(const fs::path& folder, const fs::path& file) {
  return writeFileAtomically(file, [&](const fs::path& temporary) -> Expected<void> {
    int code = 0;
    std::unique_ptr<zip_t, ZipCloser> archive(
        zip_open(temporary.c_str(), ZIP_CREATE | ZIP_TRUNCATE, &code));
    if (!archive) {
      return fail(ErrorCode::FileUnwritable, file.string());
    }
    constexpr zip_uint16_t k1980 = (1U << 5U) | 1U;  // 1 January, the first day of a zip
    for (const fs::path& name : filesBelow(folder)) {
      zip_source_t* source = zip_source_file(archive.get(), (folder / name).c_str(), 0, -1);
      const zip_int64_t index =
          source == nullptr
              ? -1
              : zip_file_add(
                    archive.get(), name.generic_string().c_str(), source, ZIP_FL_ENC_UTF_8);
      if (index < 0 ||
          zip_file_set_dostime(archive.get(), static_cast<zip_uint64_t>(index), 0, k1980, 0) != 0) {
        zip_source_free(index < 0 ? source : nullptr);
        return fail(ErrorCode::FileUnwritable, file.string() + ": " + zip_strerror(archive.get()));
      }
    }
    if (zip_close(archive.get()) != 0) {
      const bool full = zip_error_code_system(zip_get_error(archive.get())) == ENOSPC;
      return fail(full ? ErrorCode::DiskFull : ErrorCode::FileUnwritable,
                  file.string() + ": " + zip_strerror(archive.get()));
    }
    static_cast<void>(archive.release());  // closed
    return {};
  });
}

}  // namespace tarsus
