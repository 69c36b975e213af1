#include "core/closed_form/pair_contacts.h"

#include <algorithm>
#include <limits>

namespace passung::closed_form {

/// Of the lines of one part: how the other part, S, sees them.
struct LineFrame {
    Mat3 R_WS;
    Vec3 p_WS;
    Pose X_SL;    // of the lines
    Vec3 origin;  // of the held part, in S
    double sign;  // of what a motion of the held part does to the gap: 1 if the line moves, -1 if the lump does
};

namespace {

constexpr double kLeastBend = 1e-8;  // f_tt of a minimum that is told from a flat place [m]

Mat3 crossMatrix(const Vec3& v) noexcept {
    Mat3 m;
    m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
    return m;
}

/// The line in the frame of the solid that it meets.
Curve moved(const Pose& X, const Curve& line) noexcept {
    Curve there = line;
    there.centre = X * line.centre;
    there.e1 = X.q * line.e1;
    if (line.kind == Curve::Kind::Circle || line.kind == Curve::Kind::Spiral) there.e2 = X.q * line.e2;
    if (line.kind == Curve::Kind::Spiral) there.e3 = X.q * line.e3;
    return there;
}

/// A line with the frame of its lump's part.
struct LineView : LineFrame {
    Curve line;  // in S
};

LineFrame frameOf(const SolidPair& pair, const Pose& X_WH, bool of_held) noexcept {
    if (of_held) {
        const Pose X_OH = pair.X_WO.inverse() * X_WH;
        return {pair.X_WO.q.toRotationMatrix(), pair.X_WO.p, X_OH, X_OH.p, 1.0};
    }
    return {X_WH.q.toRotationMatrix(), X_WH.p, X_WH.inverse() * pair.X_WO, Vec3::Zero(), -1.0};
}

LineView viewOf(const SolidPair& pair, const LineFrame& frame, const TouchName& name) noexcept {
    const SmoothSolid& lines = name.of_held ? *pair.held : *pair.obstacle;
    const Curve& line = name.core ? lines.cores[name.line] : lines.edges[name.line];
    return {frame, moved(frame.X_SL, line)};
}

LineView viewOf(const SolidPair& pair, const Pose& X_WH, const TouchName& name) noexcept {
    return viewOf(pair, frameOf(pair, X_WH, name.of_held), name);
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

/// To world axes and lengths.
motion::Motion inWorld(const LineView& view, double rho, const motion::Motion& m) noexcept {
    motion::Motion w;
    w << view.R_WS * m.head<3>(), view.R_WS * m.tail<3>() / rho;
    return w;
}

Contact contactOf(const SolidPair& pair, const LineView& view, const TouchName& name, const Touch& touch) noexcept {
    Contact contact;
    contact.name = name;
    contact.touch = touch;
    const std::vector<Face>& faces = lumpOf(pair, name).faces;
    const Vec3 p = pointOf(view.line, touch.t);
    Vec3 gradient = gradientOf(faces[touch.a], p);
    contact.gap = valueOf(faces[touch.a], p);
    if (touch.b != Touch::kNone) {
        gradient = touch.share * gradient + (1.0 - touch.share) * gradientOf(faces[touch.b], p);
        contact.gap = touch.share * contact.gap + (1.0 - touch.share) * valueOf(faces[touch.b], p);
    }
    contact.gap -= view.line.thickness;
    contact.point = view.R_WS * p + view.p_WS;
    contact.normal = view.R_WS * (view.sign * gradient);
    contact.a = inWorld(view, pair.metric_radius, slopeBy(view, p - view.origin, gradient));
    return contact;
}

/// Derivatives of one face's function on the line by the motion u and by t, in S.
struct OnLine {
    motion::Motion by_u = motion::Motion::Zero();
    MotionMatrix by_uu = MotionMatrix::Zero();
    motion::Motion by_tu = motion::Motion::Zero();
    double by_t = 0.0, by_tt = 0.0;
};

OnLine derivativesOn(const LineView& view, const Face& face, double t) noexcept {
    const Vec3 p = pointOf(view.line, t), slope = slopeOf(view.line, t), r = p - view.origin;
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
    d.by_tt = slope.dot(Kc) + g.dot(bendOf(view.line, t));
    return d;
}

MotionMatrix curvatureInS(const LineView& view, const std::vector<Face>& faces, const Touch& touch,
                          bool slides) noexcept {
    const OnLine a = derivativesOn(view, faces[touch.a], touch.t);
    if (touch.b == Touch::kNone) {
        if (!slides || touch.kind != Touch::Kind::Smooth || !(a.by_tt > kLeastBend)) return a.by_uu;
        return a.by_uu - a.by_tu * a.by_tu.transpose() / a.by_tt;
    }
    const OnLine b = derivativesOn(view, faces[touch.b], touch.t);
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
                for (std::size_t lump = 0; lump < lumps.lumps.size(); ++lump)
                    meetings_.push_back(
                        {.name = {of_held, core, static_cast<std::uint16_t>(line), static_cast<std::uint16_t>(lump)},
                         .piece = static_cast<std::uint16_t>(piece),
                         .of_thread = curve.kind == Curve::Kind::Spiral || hasFlank(lumps.lumps[lump])});
        }
    }
}

double ContactSearch::find(const Pose& X_WH, double reach, PairContacts& contacts) noexcept {
    way_ += (X_WH.p - X_last_.p).norm();
    turn_ += rotationVector(X_WH.q * X_last_.q.conjugate()).norm();
    X_last_ = X_WH;
    contacts.clear();
    sampled_ = nullptr;
    const LineFrame of_obstacle = frameOf(pair_, X_WH, false), of_held = frameOf(pair_, X_WH, true);
    double least = std::numeric_limits<double>::infinity();
    for (Meeting& meeting : meetings_) {
        if (!(boundOf(meeting) > reach)) look(meeting.name.of_held ? of_held : of_obstacle, reach, meeting, contacts);
        least = std::min(least, boundOf(meeting));
    }
    return least;
}

/// A function with a gradient of length 1 changes by no more than its point moves.
double ContactSearch::boundOf(const Meeting& meeting) const noexcept {
    const double way = way_ - meeting.way, turn = turn_ - meeting.turn;
    return meeting.bound - way - turn * (meeting.lever + way);
}

/// Its line's points were taken, for another lump.
bool ContactSearch::isSampled(const Meeting& meeting) const noexcept {
    if (sampled_ == nullptr || sampled_->piece != meeting.piece) return false;
    const TouchName &now = sampled_->name, &name = meeting.name;
    return now.of_held == name.of_held && now.core == name.core && now.line == name.line;
}

void ContactSearch::look(const LineFrame& frame, double reach, Meeting& meeting, PairContacts& contacts) noexcept {
    const TouchName& name = meeting.name;
    const LineView view = viewOf(pair_, frame, name);
    const Lump& lump = lumpOf(pair_, name);
    Touches touches;
    const LinePiece piece = pieceOf(view.line, meeting.piece);
    if (meeting.of_thread && !name.core) {
        if (!isSampled(meeting)) samples_.take(view.line, piece);
        sampled_ = &meeting;
        meeting.bound = searchAlongThread(view.line, piece, samples_, lump, reach, touches);
    } else {
        meeting.bound =
            name.core ? searchCore(view.line, lump, reach, touches) : searchEdge(view.line, lump, reach, touches);
    }
    meeting.lever = (piece.middle - view.origin).norm() + piece.extent;
    meeting.way = way_;
    meeting.turn = turn_;
    for (const Touch& touch : touches.all()) contacts.add(contactOf(pair_, view, name, touch));
    if (touches.full()) contacts.setFull();
}

Contact atPose(const SolidPair& pair, const Pose& X_WH, const Contact& contact) noexcept {
    return contactOf(pair, viewOf(pair, X_WH, contact.name), contact.name, contact.touch);
}

MotionMatrix curvatureOf(const SolidPair& pair, const Pose& X_WH, const Contact& contact, bool slides) noexcept {
    const LineView view = viewOf(pair, X_WH, contact.name);
    const MotionMatrix H = curvatureInS(view, lumpOf(pair, contact.name).faces, contact.touch, slides);
    MotionMatrix T = MotionMatrix::Zero();
    T.topLeftCorner<3, 3>() = view.R_WS;
    T.bottomRightCorner<3, 3>() = T.topLeftCorner<3, 3>() / pair.metric_radius;
    return T * H * T.transpose();
}

}  // namespace passung::closed_form
