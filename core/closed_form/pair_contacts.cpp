#include "core/closed_form/pair_contacts.h"

#include <algorithm>
#include <limits>

namespace passung::closed_form {

namespace {

constexpr double kLeastBend = 1e-8;  // f_tt of a minimum that is told from a flat place [m]

Mat3 crossMatrix(const Vec3& v) noexcept {
    Mat3 m;
    m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
    return m;
}

/// The line in the frame of the solid that it meets, without its faces.
Curve moved(const Pose& X, const Curve& line) noexcept {
    Curve there{.kind = line.kind,
                .centre = X * line.centre,
                .e1 = X.q * line.e1,
                .end = line.end,
                .thickness = line.thickness};
    if (line.kind == Curve::Kind::Circle || line.kind == Curve::Kind::Spiral) there.e2 = X.q * line.e2;
    if (line.kind != Curve::Kind::Spiral) return there;
    there.e3 = X.q * line.e3;
    there.begin = line.begin;
    there.radius = line.radius;
    there.widening = line.widening;
    there.climb = line.climb;
    return there;
}

/// Of a contact: the frame of its lump's part.
struct LineView {
    Mat3 R_WS;  // the lump's part
    Vec3 p_WS;
    Curve line;   // in S
    Vec3 origin;  // where the held part is held, in S
    Vec3 axis;    // of the held part's metric, world
    double sign;  // of what a motion of the held part does to the gap: 1 if the line moves, -1 if the lump does
    Quat line_q;  // of the line's part, in S
};

const Curve& lineOf(const SolidPair& pair, const TouchName& name) noexcept {
    const SmoothSolid& lines = name.of_held ? *pair.held : *pair.obstacle;
    return name.core ? lines.cores[name.line] : lines.edges[name.line];
}

LineView viewOf(const SolidPair& pair, const Pose& X_WH, const TouchName& name) noexcept {
    const Curve& line = lineOf(pair, name);
    const Vec3 axis = pair.metric.at(X_WH).axis;
    if (name.of_held) {
        const Pose X_OH = pair.X_WO.inverse() * X_WH;
        return {.R_WS = pair.X_WO.q.toRotationMatrix(),
                .p_WS = pair.X_WO.p,
                .line = moved(X_OH, line),
                .origin = pair.metric.centre(X_OH),
                .axis = axis,
                .sign = 1.0,
                .line_q = X_OH.q};
    }
    const Pose X_HO = X_WH.inverse() * pair.X_WO;
    return {.R_WS = X_WH.q.toRotationMatrix(),
            .p_WS = X_WH.p,
            .line = moved(X_HO, line),
            .origin = pair.metric.p_GC,
            .axis = axis,
            .sign = -1.0,
            .line_q = X_HO.q};
}

const Lump& lumpOf(const SolidPair& pair, const TouchName& name) noexcept {
    return (name.of_held ? *pair.obstacle : *pair.held).lumps[name.lump];
}

/// The gap's first derivatives by the motion, in the axes of S and without ρ.
motion::Motion slopeBy(const LineView& view, const Vec3& lever, const Vec3& gradient) noexcept {
    motion::Motion a;
    a << view.sign * gradient, view.sign * lever.cross(gradient);
    return a;
}

/// Without its centre: levers are about `origin`.
motion::PlacedMetric metricOf(const LineView& view, const motion::Metric& metric) noexcept {
    motion::PlacedMetric placed;
    placed.radius = metric.radius;
    placed.across = metric.across;
    placed.axis = view.axis;
    // S is the lump's part: the held one, or that in which the line's is turned by line_q.
    if (metric.whole) metric.turnInto(placed, view.sign > 0.0 ? Mat3(view.R_WS * view.line_q) : view.R_WS);
    return placed;
}

/// To world axes and lengths.
motion::Motion inWorld(const LineView& view, const motion::Metric& metric, const motion::Motion& m) noexcept {
    motion::Motion w;
    w << view.R_WS * m.head<3>(), metricOf(view, metric).perTurn(view.R_WS * m.tail<3>());
    return w;
}

/// An edge of a convex piece touches with normals between those of its two sides, its end with those between three
/// faces. A place on it that something else would have to hold lies in the other part's way, but what touches there is
/// another line: the edge's own row is implied by that one's, and where two edges are nearly parallel its normal is
/// any. `line_q`: of the line's frame, in that of the gradient, against which would have to be between them.
double leanOf(const Curve& own, const Touch& touch, const LinePlace& at, const Quat& line_q,
              const Vec3& gradient) noexcept {
    if (!own.sides || own.kind == Curve::Kind::Point) return 0.0;
    const Vec3 outward = Vec3(line_q.conjugate() * Vec3(-gradient)).normalized();
    const EdgeFrame frame = touch.fixed < own.fixed.size() ? own.fixed[touch.fixed] : frameOf(own, at);
    const Vec3 &t = frame.way, &a = frame.a, &b = frame.b;
    const double turn = frame.turn;
    Vec3 n = outward, c = t;
    double beyond = 0.0;  // of the third face
    if (own.kind == Curve::Kind::Straight && touch.kind == Touch::Kind::Fixed) {
        const bool low = touch.t <= -own.end, at_end = low || touch.t >= own.end;
        const std::optional<Face>& cap = own.caps[low ? 0 : 1];
        if (at_end && !cap) return 0.0;
        if (at_end) {
            c = gradientOf(*cap, pointOf(own, at));
            beyond = -t.dot(n) / t.dot(c);
        }
    }
    n -= t.dot(n) / t.dot(c) * c;
    // n = α a + β b.
    const double alpha = n.cross(b).dot(t) / turn, beta = a.cross(n).dot(t) / turn;
    return std::max({0.0, -alpha * std::abs(turn), -beta * std::abs(turn), beyond});
}

double gapOf(const LineView& view, const std::vector<Face>& faces, const Touch& touch) noexcept {
    const Vec3 p = pointOf(view.line, touch.on(view.line));
    double gap = valueOf(faces[touch.a], p);
    if (touch.b != Touch::kNone) gap = touch.share * gap + (1.0 - touch.share) * valueOf(faces[touch.b], p);
    return gap - view.line.thickness;
}

/// Of one that leans more than `most_lean` gap and lean alone.
Contact contactOf(const SolidPair& pair, const LineView& view, const TouchName& name, const Touch& touch,
                  double most_lean) noexcept {
    Contact contact;
    contact.name = name;
    contact.touch = touch;
    const std::vector<Face>& faces = lumpOf(pair, name).faces;
    const LinePlace at = touch.on(view.line);
    const Vec3 p = pointOf(view.line, at);
    const Jet of_a = slopedValueOf(faces[touch.a], p);
    Vec3 gradient = of_a.gradient;
    contact.gap = of_a.value;
    if (touch.b != Touch::kNone) {
        const Jet of_b = slopedValueOf(faces[touch.b], p);
        gradient = touch.share * gradient + (1.0 - touch.share) * of_b.gradient;
        contact.gap = touch.share * contact.gap + (1.0 - touch.share) * of_b.value;
    }
    contact.gap -= view.line.thickness;
    if (!name.core) {
        const SmoothSolid& lines = name.of_held ? *pair.held : *pair.obstacle;
        contact.lean = leanOf(lines.edges[name.line], touch, at, view.line_q, gradient);
        if (contact.lean > most_lean) return contact;
    }
    contact.point = view.R_WS * p + view.p_WS;
    contact.normal = view.R_WS * (view.sign * gradient);
    contact.a = inWorld(view, pair.metric, slopeBy(view, p - view.origin, gradient));
    return contact;
}

constexpr double kTied = 1e-7;     // [m], above what a look leaves of overlap
constexpr double kTiedGap = 1e-6;  // [m]

/// Of a contact whose line could not touch with its normal: those of other faces that are as high there. Where faces of
/// both parts lie in one plane, as sides of equal boxes do that meet face to face, rounding says which of the planes a
/// corner is the farthest from; along the others nothing holds, and the one that does must not be missed.
void addTied(const SolidPair& pair, const LineView& view, const Contact& contact, double most_lean,
             PairContacts& contacts) noexcept {
    if (contact.name.core) return;
    const std::vector<Face>& faces = lumpOf(pair, contact.name).faces;
    const Vec3 p = pointOf(view.line, contact.touch.on(view.line));
    for (std::size_t i = 0; i < faces.size(); ++i) {
        if (i == contact.touch.a || valueOf(faces[i], p) - view.line.thickness < contact.gap - kTied) continue;
        Touch touch = contact.touch;
        touch.kind = Touch::Kind::Fixed;
        touch.a = static_cast<std::uint8_t>(i);
        touch.b = Touch::kNone;
        touch.share = 1.0;
        const Contact tied = contactOf(pair, view, contact.name, touch, most_lean);
        if (!(tied.lean > most_lean)) contacts.add(tied);
    }
}

/// Derivatives of one face's function on the line by the motion u and by t, in S.
struct OnLine {
    motion::Motion by_u = motion::Motion::Zero();
    MotionMatrix by_uu = MotionMatrix::Zero();
    motion::Motion by_tu = motion::Motion::Zero();
    double by_t = 0.0, by_tt = 0.0;
};

OnLine derivativesOn(const LineView& view, const Face& face, const LinePlace& at) noexcept {
    const Vec3 p = pointOf(view.line, at), slope = slopeOf(view.line, at), r = p - view.origin;
    const Jet jet = jetOf(face, p);
    const Vec3& g = jet.gradient;
    const Mat3& K = jet.hessian;
    const Mat3 rx = crossMatrix(r);
    OnLine d;
    d.by_u = slopeBy(view, r, g);
    // uᵀ Jᵀ K J u with J = (1, -[r]x), and what the rotation bends.
    d.by_uu.topLeftCorner<3, 3>() = K;
    d.by_uu.topRightCorner<3, 3>() = -K * rx;
    d.by_uu.bottomLeftCorner<3, 3>() = rx * K;
    d.by_uu.bottomRightCorner<3, 3>() =
        -rx * K * rx + 0.5 * (r * g.transpose() + g * r.transpose()) - r.dot(g) * Mat3::Identity();
    if (view.sign < 0.0) {
        d.by_uu.topRightCorner<3, 3>() += crossMatrix(g);
        d.by_uu.bottomLeftCorner<3, 3>() -= crossMatrix(g);
    }
    const Vec3 Kc = K * slope;
    d.by_tu << view.sign * Kc, view.sign * (r.cross(Kc) + slope.cross(g));
    d.by_t = g.dot(slope);
    d.by_tt = slope.dot(Kc) + g.dot(bendOf(view.line, at));
    return d;
}

MotionMatrix curvatureInS(const LineView& view, const std::vector<Face>& faces, const Touch& touch,
                          bool slides) noexcept {
    const LinePlace at = touch.on(view.line);
    const OnLine a = derivativesOn(view, faces[touch.a], at);
    if (touch.b == Touch::kNone) {
        if (!slides || touch.kind != Touch::Kind::Smooth || !(a.by_tt > kLeastBend)) return a.by_uu;
        return a.by_uu - a.by_tu * a.by_tu.transpose() / a.by_tt;
    }
    const OnLine b = derivativesOn(view, faces[touch.b], at);
    const double mu = touch.share, nu = 1.0 - mu;
    MotionMatrix H = mu * a.by_uu + nu * b.by_uu;
    const double cross = a.by_t - b.by_t;
    if (!slides || !(std::abs(cross) > kLeastBend)) return H;
    const motion::Motion by_tu = mu * a.by_tu + nu * b.by_tu, by_mu_u = a.by_u - b.by_u;
    const double by_tt = mu * a.by_tt + nu * b.by_tt;
    // The inverse of [[by_tt, cross], [cross, 0]].
    const double tm = 1.0 / cross, mm = -by_tt / (cross * cross);
    return H - (tm * (by_tu * by_mu_u.transpose() + by_mu_u * by_tu.transpose()) + mm * by_mu_u * by_mu_u.transpose());
}

}  // namespace

double overlapOf(const PairContacts& contacts) noexcept {
    double most = 0.0;
    for (const Contact& contact : contacts.all()) most = std::max(most, -contact.gap);
    return most;
}

struct PlacedPair {
    PlacedPair(const SolidPair& of, const Pose& X_WHeld) noexcept
        : pair(of),
          X_WH(X_WHeld),
          X_OH(of.X_WO.inverse() * X_WHeld),
          X_HO(X_WHeld.inverse() * of.X_WO),
          axis(of.metric.at(X_WHeld).axis),
          R_WH(X_WHeld.q.toRotationMatrix()),
          R_WO(of.X_WO.q.toRotationMatrix()) {}

    /// The line's view is kept: the next one is mostly of the same line.
    const LineView& view(const TouchName& name) noexcept {
        const Curve& line = lineOf(pair, name);
        if (&line == seen) return last;
        seen = &line;
        if (name.of_held)
            last = {R_WO, pair.X_WO.p, moved(X_OH, line), pair.metric.centre(X_OH), axis, 1.0, X_OH.q};
        else
            last = {R_WH, X_WH.p, moved(X_HO, line), pair.metric.p_GC, axis, -1.0, X_HO.q};
        return last;
    }

    const SolidPair& pair;
    Pose X_WH, X_OH, X_HO;
    Vec3 axis;
    Mat3 R_WH, R_WO;

private:
    LineView last;
    const Curve* seen = nullptr;  // whose view that is
};

ContactSearch::ContactSearch(const SolidPair& pair) : pair_(pair) {
    addMeetings(true);
    addMeetings(false);
}

void ContactSearch::addMeetings(bool of_held) {
    const SmoothSolid& lines = of_held ? *pair_.held : *pair_.obstacle;
    const SmoothSolid& lumps = of_held ? *pair_.obstacle : *pair_.held;
    for (const bool core : {false, true}) {
        const std::size_t count = core ? lines.cores.size() : lines.edges.size();
        for (std::size_t line = 0; line < count; ++line) {
            const Curve& curve = (core ? lines.cores : lines.edges)[line];
            for (std::size_t piece = 0; piece < piecesOf(curve); ++piece)
                for (std::size_t at = 0; at < lumps.lumps.size(); ++at) {
                    const Lump& lump = lumps.lumps[at];
                    meetings_.push_back(
                        {.name = {of_held, core, static_cast<std::uint16_t>(line), static_cast<std::uint16_t>(at)},
                         .piece = static_cast<std::uint16_t>(piece),
                         .of_thread = !core && (curve.kind == Curve::Kind::Spiral || hasFlank(lump)),
                         .touches = !core || canTouch(curve, lump)});
                }
        }
    }
}

std::size_t ContactSearch::meetings() const noexcept {
    return static_cast<std::size_t>(
        std::count_if(meetings_.begin(), meetings_.end(), [](const Meeting& meeting) { return !meeting.of_thread; }));
}

void ContactSearch::moveTo(const Pose& X_WH) noexcept {
    way_ += (X_WH.p - X_last_.p).norm();
    turn_ += rotationVector(X_WH.q * X_last_.q.conjugate()).norm();
    X_last_ = X_WH;
    sampled_ = nullptr;
}

bool ContactSearch::place(const Pose& X_WO) noexcept {
    if (X_WO.p == pair_.X_WO.p && X_WO.q.coeffs() == pair_.X_WO.q.coeffs()) return false;
    const Pose back = pair_.X_WO * X_WO.inverse();
    way_ += (back * X_last_.p - X_last_.p).norm();
    turn_ += rotationVector(back.q).norm();
    pair_.X_WO = X_WO;
    sampled_ = nullptr;
    return true;
}

double ContactSearch::find(const Pose& X_WH, double reach, PairContacts& contacts) noexcept {
    SearchMemory memory;
    return find(X_WH, reach, contacts, memory);
}

double ContactSearch::find(const Pose& X_WH, double reach, PairContacts& contacts, SearchMemory& memory,
                           double most_lean) noexcept {
    moveTo(X_WH);
    contacts.clear();
    overlap_ = 0.0;
    PlacedPair placed(pair_, X_WH);
    double least = std::numeric_limits<double>::infinity();
    for (Meeting& meeting : meetings_) {
        if (!(boundOf(meeting) > reach)) {
            look(placed, reach, false, meeting, memory, [&](const LineView& view, const Touch& touch) {
                const Contact contact = contactOf(pair_, view, meeting.name, touch, most_lean);
                overlap_ = std::max(overlap_, -contact.gap);
                if (!(contact.lean > most_lean))
                    contacts.add(contact);
                else if (contact.gap < kTiedGap)
                    addTied(pair_, view, contact, most_lean, contacts);
            });
            if (memory.touches.full()) contacts.setFull();
        }
        least = std::min(least, boundOf(meeting));
    }
    return least;
}

/// Begins with the meeting that was the deepest before: few others have to be looked at then.
ContactSearch::Overlap ContactSearch::overlapAt(const Pose& X_WH, SearchMemory& memory) noexcept {
    constexpr double kRounding = 1e-12;  // [m] between a touch's gap and its contact's
    moveTo(X_WH);
    PlacedPair placed(pair_, X_WH);
    Overlap overlap;
    const auto lookAt = [&](std::size_t at) {
        const Meeting& meeting = meetings_[at];
        const double reach = std::min(0.0, kRounding - overlap.depth);
        if (!meeting.touches || boundOf(meeting) > (meeting.of_thread ? std::max(reach, meeting.reach) : reach)) return;
        look(placed, reach, true, meetings_[at], memory, [&](const LineView& view, const Touch& touch) {
            const double gap = gapOf(view, lumpOf(pair_, meetings_[at].name).faces, touch);
            if (!(-gap > overlap.depth)) return;
            overlap.depth = -gap;
            deepest_ = at;
        });
        overlap.full = overlap.full || memory.touches.full();
    };
    const std::size_t first = deepest_;
    if (first < meetings_.size()) lookAt(first);
    for (std::size_t at = 0; at < meetings_.size(); ++at)
        if (at != first) lookAt(at);
    return overlap;
}

ContactSearch::Overlap ContactSearch::overlapAt(const Pose& X_WH) noexcept {
    SearchMemory memory;
    return overlapAt(X_WH, memory);
}

/// A function with a gradient of length 1 changes by no more than its point moves.
double ContactSearch::boundOf(const Meeting& meeting) const noexcept {
    const double way = way_ - meeting.way, turn = turn_ - meeting.turn;
    return meeting.bound - way - turn * (meeting.lever + way);
}

/// Its line's points were taken at this pose, for another lump.
bool ContactSearch::isSampled(const Meeting& meeting) const noexcept {
    if (sampled_ == nullptr || sampled_->piece != meeting.piece) return false;
    const TouchName &now = sampled_->name, &name = meeting.name;
    return now.of_held == name.of_held && now.line == name.line;
}

template <class Take>
void ContactSearch::look(PlacedPair& placed, double reach, bool closely, Meeting& meeting, SearchMemory& memory,
                         Take take) noexcept {
    Touches& touches = memory.touches;
    touches.clear();
    const TouchName& name = meeting.name;
    const LineView& view = placed.view(name);
    const Lump& lump = lumpOf(pair_, name);
    const LinePiece piece = pieceOf(view.line, meeting.piece);
    double closer = -std::numeric_limits<double>::infinity();
    if (meeting.of_thread) {
        if (!isSampled(meeting)) memory.samples.take(view.line, piece);
        sampled_ = &meeting;
        meeting.bound = searchAlongThread(view.line, piece, memory.samples, lump, reach, touches);
    } else {
        meeting.bound = name.core ? searchCore(view.line, lump, reach, touches)
                                  : searchEdge(view.line, lump, reach, touches, closely ? &closer : nullptr);
    }
    meeting.bound = std::max(meeting.bound, closer);
    meeting.reach = std::min(reach, 0.0);
    meeting.lever = (piece.middle - view.origin).norm() + piece.extent + pair_.metric.distance();
    meeting.way = way_;
    meeting.turn = turn_;
    for (const Touch& touch : touches.all()) take(view, touch);
}

std::optional<Contact> keptAt(const SolidPair& pair, const Pose& X_WH, const Contact& contact) noexcept {
    constexpr double kEqual = 1e-9;        // [m]
    constexpr double kSameNormal = 0.005;  // [rad]
    const LineView view = viewOf(pair, X_WH, contact.name);
    const Lump& lump = lumpOf(pair, contact.name);
    const Vec3 p = pointOf(view.line, contact.touch.on(view.line));
    Touch touch = contact.touch;
    if (touch.b != Touch::kNone) {
        if (valueOf(lump.faces[touch.b], p) > valueOf(lump.faces[touch.a], p)) touch.a = touch.b;
        touch.b = Touch::kNone;
        touch.share = 1.0;
        touch.kind = Touch::Kind::Fixed;
    }
    if (valueOf(lump, p) > valueOf(lump.faces[touch.a], p) + kEqual) return std::nullopt;
    const Contact now = contactOf(pair, view, contact.name, touch, std::numeric_limits<double>::infinity());
    if (contact.touch.b != Touch::kNone && (now.normal - contact.normal).norm() > kSameNormal) return std::nullopt;
    return now;
}

MotionMatrix curvatureOf(const SolidPair& pair, const Pose& X_WH, const Contact& contact, bool slides) noexcept {
    const LineView view = viewOf(pair, X_WH, contact.name);
    const MotionMatrix H = curvatureInS(view, lumpOf(pair, contact.name).faces, contact.touch, slides);
    MotionMatrix T = MotionMatrix::Zero();
    T.topLeftCorner<3, 3>() = view.R_WS;
    const motion::PlacedMetric metric = metricOf(view, pair.metric);
    for (int axis = 0; axis < 3; ++axis) T.block<3, 1>(3, 3 + axis) = metric.perTurn(view.R_WS.col(axis));
    return T * H * T.transpose();
}

}  // namespace passung::closed_form
