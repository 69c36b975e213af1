#include <algorithm>

#include "core/path/room_contacts.h"
#include "core/surface/nearest_faces.h"
#include "core/surface/surface_proxy.h"

namespace passung::path {

namespace {

constexpr double kGap = 1e-6;    // held while it slides [m]
constexpr int kBudget = 400000;  // of a tick: nobody waits for it

std::vector<surface::SurfaceBody> bodiesOf(const std::vector<RestingPart>& standing) {
    std::vector<surface::SurfaceBody> bodies;
    for (const RestingPart& one : standing) bodies.push_back({one.part->clusters.get(), one.X_WO});
    return bodies;
}

class SurfaceContacts final : public FreeRoom::Contacts {
public:
    SurfaceContacts(const scene::Part& moving, const std::vector<RestingPart>& standing, const motion::Metric& metric)
        : moving_(moving),
          standing_(standing),
          proxy_(*moving.clusters, bodiesOf(standing), {.metric = metric, .gap = kGap, .budget = kBudget}) {}

    Nearness clearanceAt(const Pose& X, double within) override {
        Nearness least{.distance = within, .bound = within, .standing = {}};
        for (std::size_t i = 0; i < standing_.size(); ++i) {
            const RestingPart& one = standing_[i];
            const surface::NearestHulls now =
                surface::nearestFaces(*moving_.clusters, *one.part->clusters, one.X_WO.inverse() * X, least.distance);
            const double chords = moving_.chord_error + one.part->chord_error;
            const bool nearer = now.distance < least.distance;
            least.bound = std::min(least.bound, (nearer ? now.separation : least.distance) - chords);
            if (!nearer) continue;
            least.distance = now.distance;
            least.standing = i;
            least.where = one.X_WO * now.on_obstacle;
        }
        return least;
    }

    void begin(const Pose& X) override {
        proxy_.place(X);
        proxy_.prepare();
    }

    void pull(const Pose& X_WH, std::vector<Pose>& way) override {
        proxy_.advance(X_WH);
        for (const Pose& X : proxy_.chain()) way.push_back(X);
        way.push_back(proxy_.pose());
    }

private:
    const scene::Part& moving_;
    std::vector<RestingPart> standing_;
    surface::SurfaceProxy proxy_;
};

}  // namespace

std::unique_ptr<FreeRoom::Contacts> surfaceContacts(const scene::Part& moving, const std::vector<RestingPart>& standing,
                                                    const motion::Metric& metric) {
    return std::make_unique<SurfaceContacts>(moving, standing, metric);
}

}  // namespace passung::path
