#include "reconstruction/capture/openni/plain_path.h"

#include "reconstruction/base/temporary_folder.h"
#include "reconstruction/capture/openni/simulated_camera/address.h"

#include <algorithm>
#include <map>
#include <mutex>
#include <string_view>

namespace tarsus {
namespace {

namespace fs = std::filesystem;

bool isPlain(std::string_view text) {
  constexpr std::size_t kLongest = 200;  // of 255, with room for what is put behind it
  return text.size() <= kLongest &&
         std::ranges::all_of(text, [](char c) { return c > ' ' - 1 && c < 127 && c != '?'; });
}

/// The links of this process, by what they lead to.
class Links {
 public:
  Expected<fs::path> to(const fs::path& target) {
    const std::scoped_lock lock(mutex_);
    if (const auto known = links_.find(target); known != links_.end()) {
      return known->second;
    }
    const fs::path link =
        folder_.path() / ("link" + std::to_string(links_.size()) + target.extension().string());
    const fs::path plain = isPlain(link.string()) ? link : folder_.path() / link.stem();
    std::error_code error;
    fs::create_symlink(target, plain, error);
    if (error || folder_.path().empty() || !isPlain(plain.string())) {
      return fail(ErrorCode::FileUnwritable,
                  "the camera's library cannot read " + target.string() +
                      "; set TMPDIR to a folder with a plain short name, or rename it");
    }
    links_.emplace(target, plain);
    return plain;
  }

 private:
  TemporaryFolder folder_;
  std::mutex mutex_;  ///< guards `links_`
  std::map<fs::path, fs::path> links_;
};

}  // namespace

Expected<fs::path> plainPath(const fs::path& path) {
  std::error_code error;
  const fs::path absolute = fs::absolute(path, error);
  if (isPlain(absolute.string())) {
    return absolute;
  }
  static Links links;
  return links.to(absolute);
}

Expected<std::string> plainUri(const std::string& uri) {
  const auto address = parseSimulatedAddress(uri);
  if (!address) {
    return uri;
  }
  const std::string scan = address->scan.string();
  const auto plain = plainPath(scan);
  if (!plain) {
    return tl::unexpected(plain.error());
  }
  return std::string(kSimulatedScheme) + plain->string() +
         uri.substr(kSimulatedScheme.size() + scan.size());
}

}  // namespace tarsus
