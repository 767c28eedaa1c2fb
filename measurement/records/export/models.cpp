#include "measurement/records/export/models.h"

#include "measurement/records/export/pseudonyms.h"
#include "reconstruction/base/atomic_file.h"
#include "reconstruction/scene/ply.h"
#include "reconstruction/scene/stl.h"

#include <nlohmann/json.hpp>

#include <array>
#include <cstdio>
#include <map>

namespace tarsus {
namespace {

namespace fs = std::filesystem;

constexpr const char* kDisclaimer = "Research software. Not a medical device.";

/// Vertices with colours behind the coordinates, as MeshLab and CloudCompare read them; mm.
std::string objText(const TexturedMesh& model) {
  std::string text = std::string("# ") + kDisclaimer + "\n";
  std::array<char, 160> line{};
  for (std::size_t i = 0; i < model.mesh.vertices.size(); ++i) {
    const Eigen::Vector3f& p = model.mesh.vertices[i];
    int length = std::snprintf(line.data(),
                               line.size(),
                               "v %.4f %.4f %.4f",
                               static_cast<double>(p.x()),
                               static_cast<double>(p.y()),
                               static_cast<double>(p.z()));
    text.append(line.data(), static_cast<std::size_t>(length));
    if (!model.colors.empty()) {
      const Rgb8& c = model.colors[i];
      length = std::snprintf(
          line.data(), line.size(), " %.4f %.4f %.4f", c.r / 255.0, c.g / 255.0, c.b / 255.0);
      text.append(line.data(), static_cast<std::size_t>(length));
    }
    text += '\n';
  }
  for (const auto& face : model.mesh.faces) {
    const int length = std::snprintf(
        line.data(), line.size(), "f %d %d %d\n", face[0] + 1, face[1] + 1, face[2] + 1);
    text.append(line.data(), static_cast<std::size_t>(length));
  }
  return text;
}

Expected<void> writeModels(const fs::path& ply, bool pseudonymised) {
  auto model = readPly(ply);
  if (!model) {
    return tl::unexpected(model.error());
  }
  if (pseudonymised) {
    model->comments = {kDisclaimer};
    if (auto written = writePly(ply, *model); !written) {
      return written;
    }
  }
  fs::path stl = ply;
  fs::path obj = ply;
  return writeTextAtomically(stl.replace_extension(".stl"), stlBytes(model->mesh)).and_then([&] {
    return writeTextAtomically(obj.replace_extension(".obj"), objText(*model));
  });
}

/// model.ply, outline.json, ...; pictures under their own ending, numbered.
std::string nameOf(const VisitFile& file, std::map<std::string, int>& numbers) {
  if (file.role == "model") {
    return "model.ply";
  }
  const int number = ++numbers[file.role];
  const std::string ending = fs::path(file.title).extension().string();
  const bool plain = ending.size() > 1 && ending.size() < 6 &&
                     ending.find_first_not_of("abcdefghijklmnopqrstuvwxyz", 1) == std::string::npos;
  return file.role + (number > 1 ? "_" + std::to_string(number) : "") +
         (plain                    ? ending
          : file.role == "picture" ? ".jpg"
                                   : ".json");
}

}  // namespace

Expected<void> writeVisitFiles(Store& store,
                               const Visit& visit,
                               const fs::path& folder,
                               const ExportOptions& options) {
  std::map<std::string, int> numbers;
  for (const VisitFile& file : visit.content.files) {
    if (file.role == "model" && !options.models) {
      continue;
    }
    const fs::path target = folder / nameOf(file, numbers);
    if (auto got = store.files().get(store.vault(), file.name, target); !got) {
      return got;
    }
    if (file.role == "model") {
      if (auto written = writeModels(target, options.pseudonymised); !written) {
        return written;
      }
    } else if (options.pseudonymised) {  // curves and tissue: pictures are not among them
      const auto text = readTextFile(target);
      const auto document = nlohmann::json::parse(text.value_or(""), nullptr, false);
      const auto kept = withoutFreeFields(document).dump() + "\n";
      if (auto written = writeTextAtomically(target, kept); !written) {
        return written;
      }
    }
  }
  return {};
}

}  // namespace tarsus
