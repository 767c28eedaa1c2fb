#include "reconstruction/scene/mesh_index.h"

#include "reconstruction/base/require.h"
#include "reconstruction/scene/nearest_on_triangle.h"

#include <Eigen/Geometry>

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace tarsus {
namespace {

constexpr int kPacket = 16;  ///< rays per Embree call; smaller hardware splits it by itself

// Which of two faces a ray along their common edge hits differs between Embree's code paths; capped
// here, every processor since 2013 takes the same one.
constexpr const char* kDeviceOptions = "max_isa=avx2";

using Packet = RTCRayHit16;

void requireValid(const TriangleMesh& mesh) {
  const int count = static_cast<int>(mesh.vertices.size());
  const bool in_range = std::all_of(mesh.faces.begin(), mesh.faces.end(), [count](const auto& f) {
    return f.minCoeff() >= 0 && f.maxCoeff() < count;
  });
  TARSUS_REQUIRE(in_range, "faces name vertices of their own mesh");
}

void setRay(Packet& packet,
            int lane,
            const Eigen::Vector3f& origin,
            const Eigen::Vector3f& direction) {
  RTCRay16& ray = packet.ray;
  ray.org_x[lane] = origin.x();
  ray.org_y[lane] = origin.y();
  ray.org_z[lane] = origin.z();
  ray.dir_x[lane] = direction.x();
  ray.dir_y[lane] = direction.y();
  ray.dir_z[lane] = direction.z();
  ray.tnear[lane] = 0.0F;
  ray.tfar[lane] = std::numeric_limits<float>::infinity();
  ray.time[lane] = 0.0F;
  ray.mask[lane] = ~0U;
  ray.id[lane] = 0;
  ray.flags[lane] = 0;
  packet.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
  packet.hit.primID[lane] = RTC_INVALID_GEOMETRY_ID;
  packet.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
}

/// What Embree says of a hit, in single precision and with the processor's own reciprocal.
struct RawHit {
  int face = -1;
  float u = 0.0F;
  float v = 0.0F;
  float distance = 0.0F;
};

}  // namespace

struct MeshIndex::Scene {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  std::vector<float> coordinates;  ///< #V x 3, and one float of padding, which Embree may read
  std::vector<Eigen::Vector3i> faces;

  explicit Scene(const TriangleMesh& mesh);
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;
  ~Scene() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }

  void addGeometry(std::size_t vertex_count);

  [[nodiscard]] Eigen::Vector3d vertex(int index) const {
    const float* p = &coordinates[3 * static_cast<std::size_t>(index)];
    return {p[0], p[1], p[2]};
  }
  [[nodiscard]] Triangle triangle(std::size_t face) const {
    const Eigen::Vector3i& f = faces[face];
    return {vertex(f[0]), vertex(f[1]), vertex(f[2])};
  }
  [[nodiscard]] RayHit refined(const RawHit& raw,
                               const Eigen::Vector3f& origin,
                               const Eigen::Vector3f& direction) const;
  template <typename RayAt>
  void castPackets(const RayAt& ray_at, std::span<RayHit> hits) const;
};

MeshIndex::Scene::Scene(const TriangleMesh& mesh) : faces(mesh.faces) {
  requireValid(mesh);
  coordinates.resize(3 * mesh.vertices.size() + 1);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    std::copy_n(mesh.vertices[i].data(), 3, &coordinates[3 * i]);
  }
  device = rtcNewDevice(kDeviceOptions);
  TARSUS_REQUIRE(device != nullptr, "Embree runs on this processor");
  scene = rtcNewScene(device);
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  if (!faces.empty()) {
    addGeometry(mesh.vertices.size());
  }
  rtcCommitScene(scene);
  TARSUS_REQUIRE(rtcGetDeviceError(device) == RTC_ERROR_NONE, "Embree accepts the mesh");
}

void MeshIndex::Scene::addGeometry(std::size_t vertex_count) {
  static_assert(sizeof(Eigen::Vector3i) == 3 * sizeof(unsigned), "faces are read as they lie");
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetSharedGeometryBuffer(geometry,
                             RTC_BUFFER_TYPE_VERTEX,
                             0,
                             RTC_FORMAT_FLOAT3,
                             coordinates.data(),
                             0,
                             3 * sizeof(float),
                             vertex_count);
  rtcSetSharedGeometryBuffer(geometry,
                             RTC_BUFFER_TYPE_INDEX,
                             0,
                             RTC_FORMAT_UINT3,
                             faces.data(),
                             0,
                             sizeof(Eigen::Vector3i),
                             faces.size());
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
}

/// The hit computed anew in double from the triangle itself: exact to the float vertices, and the
/// same bits on every processor (Embree's reciprocals differ between makes).
MeshIndex::RayHit MeshIndex::Scene::refined(const RawHit& raw,
                                            const Eigen::Vector3f& origin,
                                            const Eigen::Vector3f& direction) const {
  RayHit hit{.face = raw.face,
             .barycentric = {1.0F - raw.u - raw.v, raw.u, raw.v},
             .distance = raw.distance};
  const Triangle t = triangle(static_cast<std::size_t>(raw.face));
  const Eigen::Vector3d d = direction.cast<double>();
  const Eigen::Vector3d ab = t.b - t.a;
  const Eigen::Vector3d ac = t.c - t.a;
  const Eigen::Vector3d ao = origin.cast<double>() - t.a;
  const Eigen::Vector3d normal = ab.cross(ac);
  const double determinant = -normal.dot(d);
  const double distance = normal.dot(ao) / determinant;
  // An edge-on triangle has no determinant to speak of; Embree's own figure stands then.
  if (!(std::abs(distance - raw.distance) <= 1e-3 * std::abs(raw.distance))) {
    return hit;
  }
  const Eigen::Vector3d turned = ao.cross(d);
  const double v = std::clamp(ac.dot(turned) / determinant, 0.0, 1.0);
  const double w = std::clamp(-ab.dot(turned) / determinant, 0.0, 1.0 - v);
  hit.barycentric = Eigen::Vector3d(1.0 - v - w, v, w).cast<float>();
  hit.distance = static_cast<float>(distance);
  return hit;
}

template <typename RayAt>
void MeshIndex::Scene::castPackets(const RayAt& ray_at, std::span<RayHit> hits) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  alignas(64) std::array<int, kPacket> valid{};
  alignas(64) Packet packet;
  for (std::size_t start = 0; start < hits.size(); start += kPacket) {
    const int count = static_cast<int>(std::min<std::size_t>(kPacket, hits.size() - start));
    for (int lane = 0; lane < kPacket; ++lane) {
      valid[static_cast<std::size_t>(lane)] = lane < count ? -1 : 0;
      const auto [origin, direction] =
          ray_at(start + static_cast<std::size_t>(std::min(lane, count - 1)));
      setRay(packet, lane, origin, direction);
    }
    rtcIntersect16(valid.data(), scene, &context, &packet);
    for (int lane = 0; lane < count; ++lane) {
      const std::size_t i = start + static_cast<std::size_t>(lane);
      if (packet.hit.geomID[lane] == RTC_INVALID_GEOMETRY_ID) {
        hits[i] = RayHit{};
        continue;
      }
      const auto [origin, direction] = ray_at(i);
      hits[i] = refined({.face = static_cast<int>(packet.hit.primID[lane]),
                         .u = packet.hit.u[lane],
                         .v = packet.hit.v[lane],
                         .distance = packet.ray.tfar[lane]},
                        origin,
                        direction);
    }
  }
}

MeshIndex::MeshIndex(const TriangleMesh& mesh) : scene_(std::make_unique<Scene>(mesh)) {}
MeshIndex::MeshIndex(MeshIndex&&) noexcept = default;
MeshIndex& MeshIndex::operator=(MeshIndex&&) noexcept = default;
MeshIndex::~MeshIndex() = default;

MeshIndex::RayHit MeshIndex::castRay(const Eigen::Vector3f& origin,
                                     const Eigen::Vector3f& direction) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit query{};
  query.ray.org_x = origin.x();
  query.ray.org_y = origin.y();
  query.ray.org_z = origin.z();
  query.ray.dir_x = direction.x();
  query.ray.dir_y = direction.y();
  query.ray.dir_z = direction.z();
  query.ray.tfar = std::numeric_limits<float>::infinity();
  query.ray.mask = ~0U;
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(scene_->scene, &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) {
    return {};
  }
  return scene_->refined({.face = static_cast<int>(query.hit.primID),
                          .u = query.hit.u,
                          .v = query.hit.v,
                          .distance = query.ray.tfar},
                         origin,
                         direction);
}

void MeshIndex::castRays(const Eigen::Vector3f& origin,
                         std::span<const Eigen::Vector3f> directions,
                         std::span<RayHit> hits) const {
  TARSUS_REQUIRE(directions.size() == hits.size(), "one hit for each direction");
  scene_->castPackets(
      [&](std::size_t i) {
        return std::pair<const Eigen::Vector3f&, const Eigen::Vector3f&>(origin, directions[i]);
      },
      hits);
}

void MeshIndex::castParallelRays(std::span<const Eigen::Vector3f> origins,
                                 const Eigen::Vector3f& direction,
                                 std::span<RayHit> hits) const {
  TARSUS_REQUIRE(origins.size() == hits.size(), "one hit for each origin");
  scene_->castPackets(
      [&](std::size_t i) {
        return std::pair<const Eigen::Vector3f&, const Eigen::Vector3f&>(origins[i], direction);
      },
      hits);
}

std::optional<MeshIndex::NearestPoint> MeshIndex::nearest(const Eigen::Vector3d& p,
                                                          double max_distance_mm) const {
  struct Search {
    const Scene* scene;
    Eigen::Vector3d p;
    double slack_mm;
    double best_squared;
    int face;
    Eigen::Vector3d barycentric;

    /// Embree prunes in single precision, so its radius is kept a little larger than ours.
    [[nodiscard]] float radius() const {
      return static_cast<float>(std::sqrt(best_squared) * (1.0 + 1e-5) + slack_mm);
    }
  };
  const double slack_mm = 1e-6 * p.cwiseAbs().maxCoeff() + 1e-6;
  Search search{
      scene_.get(), p, slack_mm, max_distance_mm * max_distance_mm, -1, Eigen::Vector3d::Zero()};
  RTCPointQuery query{};
  query.x = static_cast<float>(p.x());
  query.y = static_cast<float>(p.y());
  query.z = static_cast<float>(p.z());
  query.radius = search.radius();
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  const auto visit = [](RTCPointQueryFunctionArguments* arguments) {
    auto& s = *static_cast<Search*>(arguments->userPtr);
    const int face = static_cast<int>(arguments->primID);
    const auto triangle = s.scene->triangle(arguments->primID);
    const Eigen::Vector3d barycentric = nearestOnTriangle(triangle, s.p);
    const double squared = (triangle.at(barycentric) - s.p).squaredNorm();
    // Of equally near faces the first counts, so that the order of the visit does not matter.
    const bool nearer =
        squared < s.best_squared || (squared == s.best_squared && (s.face < 0 || face < s.face));
    if (!nearer) {
      return false;
    }
    s.best_squared = squared;
    s.face = face;
    s.barycentric = barycentric;
    arguments->query->radius = s.radius();
    return true;
  };
  rtcPointQuery(scene_->scene, &query, &context, visit, &search);
  if (search.face < 0) {
    return std::nullopt;
  }
  const auto face = static_cast<std::uint32_t>(search.face);
  return NearestPoint{.point = {.face = face, .barycentric = search.barycentric},
                      .position_mm = scene_->triangle(face).at(search.barycentric),
                      .distance_mm = std::sqrt(search.best_squared)};
}

}  // namespace tarsus
