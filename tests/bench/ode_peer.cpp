#include <ode/ode.h>

#include <algorithm>
#include <array>

#include "tests/bench/method.h"
#include "tests/bench/stopwatch.h"

namespace passung::bench {

namespace {

constexpr int kMostContacts = 8192;

/// OPCODE prints a message when its table of contacts is full; the contacts found so far stay valid.
void ignoreMessage(int, const char*, va_list) {}

/// A mesh as ODE wants it; the arrays must outlive the geometry.
struct Trimesh {
    explicit Trimesh(const geometry::TriangleMesh& mesh) {
        for (const Vec3& v : mesh.vertices)
            vertices.push_back({static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())});
        for (const auto& t : mesh.triangles)
            triangles.push_back(
                {static_cast<dTriIndex>(t[0]), static_cast<dTriIndex>(t[1]), static_cast<dTriIndex>(t[2])});
        data = dGeomTriMeshDataCreate();
        dGeomTriMeshDataBuildSingle(data, vertices.data(), sizeof(vertices[0]), static_cast<int>(vertices.size()),
                                    triangles.data(), static_cast<int>(3 * triangles.size()), sizeof(triangles[0]));
        geometry = dCreateTriMesh(nullptr, data, nullptr, nullptr, nullptr);
        dGeomTriMeshEnableTC(geometry, dTriMeshClass, 0);
    }
    ~Trimesh() {
        dGeomDestroy(geometry);
        dGeomTriMeshDataDestroy(data);
    }
    Trimesh(const Trimesh&) = delete;
    Trimesh& operator=(const Trimesh&) = delete;

    std::vector<std::array<float, 3>> vertices;
    std::vector<std::array<dTriIndex, 3>> triangles;
    dTriMeshDataID data{};
    dGeomID geometry{};
};

class OdeContacts : public Method {
public:
    OdeContacts(const geometry::TriangleMesh& field, const geometry::TriangleMesh& shell)
        : field_(field), shell_(shell), contacts_(kMostContacts) {}

    Answer at(const Pose& X_FS) override {
        const dQuaternion q{static_cast<dReal>(X_FS.q.w()), static_cast<dReal>(X_FS.q.x()),
                            static_cast<dReal>(X_FS.q.y()), static_cast<dReal>(X_FS.q.z())};
        dGeomSetPosition(shell_.geometry, static_cast<dReal>(X_FS.p.x()), static_cast<dReal>(X_FS.p.y()),
                         static_cast<dReal>(X_FS.p.z()));
        dGeomSetQuaternion(shell_.geometry, q);
        const int n = dCollide(field_.geometry, shell_.geometry, kMostContacts, contacts_.data(), sizeof(dContactGeom));
        Answer answer;
        answer.contacts = n;
        dReal depth = 0;
        for (int i = 0; i < n; ++i) depth = std::max(depth, contacts_[static_cast<std::size_t>(i)].depth);
        if (n > 0) answer.signed_distance = -static_cast<double>(depth);
        return answer;
    }

private:
    Trimesh field_, shell_;
    std::vector<dContactGeom> contacts_;
};

}  // namespace

Candidate odeTrimesh(const geometry::TriangleMesh& field, const geometry::TriangleMesh& shell) {
    dInitODE2(0);
    dAllocateODEDataForThread(static_cast<unsigned>(dAllocateMaskAll));
    dSetMessageHandler(ignoreMessage);
    Candidate result{.name = "ODE trimesh", .settings = "OPCODE, all contacts, no temporal coherence"};
    const double before = heapBytes();
    const Stopwatch watch;
    result.method = std::make_unique<OdeContacts>(field, shell);
    result.build_s = watch.seconds();
    result.memory_bytes = heapBytes() - before;
    return result;
}

}  // namespace passung::bench
