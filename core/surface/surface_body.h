#pragma once

#include <vector>

#include "core/motion/friction.h"
#include "core/surface/approach.h"
#include "core/surface/enclosure.h"
#include "core/surface/hull_distance.h"

namespace passung::surface {

/// How a body's triangles rub on the held part, from `first_triangle` on to the next.
struct RubbingSurface {
    std::uint32_t first_triangle = 0;
    motion::Friction friction;
};

/// What the held part must not meet: a tree, and where its frame lies in the world.
struct SurfaceBody {
    const ClusterTree* tree = nullptr;
    Pose X_WB;
    std::vector<RubbingSurface> rubbing = {};  // from triangle 0 on, ascending; empty: none does
};

/// What must not be met, and what is known of it.
struct KnownBody {
    const ClusterTree* tree;
    Pose X_WB;
    Placement to_world;
    bool is_world = false;  // its frame is the world's
    bool in_reach = false;
    bool moved = false;   // near pairs are those of P_known
    bool behind = false;  // of those asleep some may be due
    bool asks = true;     // whether something lies wholly within the other part
    EnclosureSearch enclosure;
    std::vector<std::uint32_t> first_triangles;  // of its surfaces that rub, which are numbered
    std::size_t first_surface = 0;               // from here on
    double clear = 0.0;                          // out of reach: the way travelled up to which it stays so [m]

    Placement P, P_known;  // the held part; before the body moved
    PerClass settled{};    // keys of all that are not near are no less [m]
    PerClass usual{};      // the most of late: who may be due soon stays awake
    PerClass sleeps{};     // pairs that are set apart by that may sleep
    // Of the look that was begun.
    Placement P_next;
    Mat3 turn = Mat3::Zero();  // R1 - R0
    Vec3 move = Vec3::Zero();  // p1 - p0
    PerClass nearer{};         // by the look
    PerClass ahead{};          // by what may come of it, and in the next one

    // In another hand: the way that both go at once, from where they were when the tick began (common_way.cpp).
    struct Common {
        bool shared = false;
        bool crossed = false;      // in this tick no way is free
        Placement begin;           // the held part then, seen from it then
        PerClass back{};           // nearer, if the part went back there
        Mat3 turn = Mat3::Zero();  // R_begin - R_next
        Vec3 move = Vec3::Zero();  // p_begin - p_next
        double bent = 0.0;         // which a plane has to leave besides [m]
    } common;

    KnownBody(const ClusterTree& held, const SurfaceBody& body) : tree(body.tree), enclosure(held, *body.tree) {
        put(body.X_WB);
    }
    void put(const Pose& X) noexcept;
    /// What has to be left of pairs asleep that come nearer by `way`, of class c.
    double due(double way, std::size_t c) const noexcept {
        return common.shared ? std::max(way, common.back[c]) + common.bent : way;
    }
    bool sleepsWith(const Vec3& n, double s) const noexcept { return s >= sleeps[NormalClass::of(n)]; }
    /// From the world to its frame.
    Placement seen(const Placement& X) const noexcept;
    /// The same if that were `frame`.
    Placement seenFrom(const Pose& frame, const Placement& X) const noexcept;
    Vec3 direction(const Vec3& in_world) const noexcept {
        return is_world ? in_world : Vec3(to_world.R.transpose() * in_world);
    }
    Vec3 directionInWorld(const Vec3& d) const noexcept { return is_world ? d : Vec3(to_world.R * d); }
    Vec3 inWorld(const Vec3& p) const noexcept { return is_world ? p : to_world * p; }
};

}  // namespace passung::surface
