#include <algorithm>

#include "core/path/room_contacts.h"

namespace passung::path {

namespace {

bool isSame(const Pose& a, const Pose& b) { return a.p == b.p && a.q.coeffs() == b.q.coeffs(); }

class ClosedFormContacts final : public FreeRoom::Contacts {
public:
    ClosedFormContacts(const scene::Part& moving, const std::vector<RestingPart>& standing,
                       const motion::Metric& metric)
        : held_(*closed_form::solidOf(*moving.shape)), held_reach_(closed_form::reachOf(held_)) {
        solids_.reserve(standing.size());
        for (const RestingPart& one : standing) {
            solids_.push_back(*closed_form::solidOf(*one.part->shape));
            reaches_.push_back(closed_form::reachOf(solids_.back()));
            pairs_.push_back({&held_, &solids_.back(), one.X_WO, metric});
            searches_.emplace_back(pairs_.back());
        }
        solver_ = std::make_unique<closed_form::PoseSolver>(pairs_);
        found_ = std::make_unique<closed_form::PairContacts>();
    }

    Nearness clearanceAt(const Pose& X, double within) override {
        Nearness least{.distance = within, .bound = within, .standing = {}};
        for (std::size_t i = 0; i < searches_.size(); ++i) {
            if ((X.p - pairs_[i].X_WO.p).norm() - held_reach_ - reaches_[i] >= least.distance) continue;
            found_->clear();
            searches_[i].find(X, within, *found_);
            for (const closed_form::Contact& contact : found_->all()) {
                if (contact.gap >= least.distance) continue;
                least.distance = contact.gap;
                least.standing = i;
                least.where = contact.point;
            }
        }
        least.bound = least.distance;
        return least;
    }

    void begin(const Pose&) override { memory_ = {}; }

    void pull(const Pose& X_WH, std::vector<Pose>& way) override {
        const closed_form::ConstrainedPose found = solver_->solve(way.back(), X_WH, memory_);
        for (const Pose& X : solver_->way())
            if (!isSame(X, way.back())) way.push_back(X);
        if (!isSame(found.X_WG, way.back())) way.push_back(found.X_WG);
    }

private:
    closed_form::SmoothSolid held_;
    double held_reach_;
    std::vector<closed_form::SmoothSolid> solids_;
    std::vector<double> reaches_;  // [m]
    std::vector<closed_form::SolidPair> pairs_;
    std::vector<closed_form::ContactSearch> searches_;
    std::unique_ptr<closed_form::PoseSolver> solver_;
    std::unique_ptr<closed_form::PairContacts> found_;
    closed_form::PoseMemory memory_;
};

}  // namespace

std::unique_ptr<FreeRoom::Contacts> closedFormContacts(const scene::Part& moving,
                                                       const std::vector<RestingPart>& standing,
                                                       const motion::Metric& metric) {
    return std::make_unique<ClosedFormContacts>(moving, standing, metric);
}

}  // namespace passung::path
