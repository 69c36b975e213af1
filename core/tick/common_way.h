#pragma once

#include "core/tick/closed_form_proxy.h"
#include "core/tick/proxy.h"

namespace passung::tick {

/// Parts in different hands, between two ticks.
///
/// Why. Within a tick the hands take turns, and each way is free while all other parts rest. Who looks at two ticks
/// sees both parts go at once, each straight from where it was to where it is: along the diagonal of a rectangle, of
/// which the turns went along two sides. Where both go far, as when a part snaps off another's edge, the parts may meet
/// there.
///   So who moves later looks at that common way too, at as many places that no part goes farther between two of them
/// than kLongestPiece; where they meet by more than they did, it stays where it was when the tick began, and goes on in
/// the next one (kSuspended). There it is free: the other hand's way was, while it rested.
/// A straight way of turning parts is none for a point between them: what that may take of room, at most kMostBent, is
/// accepted. Not looked at are ways of which one is shorter than what is accepted: the diagonal is nowhere farther from
/// the sides.
/// Surfaces prove each look for that way, strictly and as either part sees the other (core/surface/common_way.cpp).
/// Limit case: both go together, the one way like the other → they stay as far apart as they are.
inline constexpr double kLongestPiece = 5e-4;   // [m]
inline constexpr int kMostPieces = 16;          // more: it stays
inline constexpr double kAcceptedOnWay = 5e-7;  // of closed forms [m]
inline constexpr double kMostBent = 1e-5;       // [m]

/// Stages, after all that moves the proxy. rt-safe.
void keepCommonWay(const HandModel& model, const ObstaclePoses& obstacles, Proxy& proxy, QueryMemory& memory,
                   Report& report) noexcept;
inline constexpr StageOf kCommonWay{
    keepCommonWay,
    {.name = "common way",
     .parameters = "",
     .cost = "where another hand's part has moved, a query of it for every half millimetre",
     .needs =
         [](const HandModel& model) {
             return model.hasFieldProxy() && model.contact.method != scene::ContactMethod::Penalty &&
                    model.meetsHands();
         },
     .reason =
         [](const HandModel&) { return "parts in different hands move in one tick: their common way is free too"; },
     .spared =
         [](const HandModel& model) {
             return model.meetsHands() ? contactInstead(model) : "no other hand holds a part";
         }}};

void keepCommonWayInClosedForm(const HandModel& model, const ObstaclePoses& obstacles, Proxy& proxy,
                               ClosedFormMemory& memory, Report& report) noexcept;
inline constexpr StageOf kClosedFormCommonWay{
    keepCommonWayInClosedForm,
    {.name = "closed-form common way",
     .parameters = "",
     .cost = "where another hand's part has moved, a look at its faces and edges for every half millimetre",
     .needs = [](const HandModel& model) { return model.hasClosedForm() && model.meetsHands(); },
     .reason =
         [](const HandModel&) { return "parts in different hands move in one tick: their common way is free too"; },
     .spared =
         [](const HandModel& model) {
             return model.meetsHands() ? contactInstead(model) : "no other hand holds a part";
         }}};

}  // namespace passung::tick
