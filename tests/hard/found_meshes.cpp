#include "tests/hard/found.h"
#include "tests/support/broken_mesh.h"
#include "tests/support/surface_cases.h"
#include "tests/support/thread_mesh.h"

namespace passung::hard {

namespace {

using test::SurfaceCase;

Result<FoundScene> from(const char* name, const SurfaceCase& made) {
    return meshScene(name, made.held, made.obstacle, made.hand);
}

template <SurfaceCase (*make)(std::uint64_t), std::uint64_t first>
Result<FoundScene> of(std::uint64_t seed) {
    const SurfaceCase made = make(pathSeed(first, seed));
    return from(made.name.c_str(), made);
}

template <int um>
Result<FoundScene> pin(std::uint64_t seed) {
    return from(("pin" + std::to_string(um)).c_str(), test::blockOnPin(pathSeed(1, seed), 1e-6 * um));
}

template <int mm, int n>
Result<FoundScene> scan(std::uint64_t seed) {
    return from(("scan" + std::to_string(mm)).c_str(), test::scanOnScan(1e-3 * mm, n, pathSeed(10, seed)));
}

Result<FoundScene> meshBar(std::uint64_t) { return from("bar", test::spinningBar()); }
Result<FoundScene> bolt(std::uint64_t seed) { return from("bolt", test::boltInNut(pathSeed(13, seed))); }

/// A scan of which every twentieth triangle is missing, on one that is whole.
Result<FoundScene> gaps(std::uint64_t seed) {
    SurfaceCase made = test::scanOnScan(.03, 60, pathSeed(14, seed));
    made.obstacle = test::withHole(made.obstacle, test::someOf(made.obstacle, 0.05, 1));
    return from("gaps", made);
}

}  // namespace

std::vector<Found> foundMeshes() {
    using namespace test;
    constexpr const char *kPin = "4900 um, recorded 0.25", *kFin = "4900 um, 0 N, 0 contacts";
    std::vector<Found> all{
        {.name = "pin_200um_mesh", .make = pin<200>, .was = {kPin}},
        {.name = "pin_1mm_mesh", .make = pin<1000>, .was = {kPin}},
        {.name = "fin_mesh", .make = of<blockOnFin, 2>, .was = {kFin}},
        {.name = "corner_mesh", .make = of<cubeOnCorner, 3>, .was = {"648 um, recorded 1.3"}},
        {.name = "slot_mesh", .make = of<needleInSlit, 4>, .was = {"450 um, recorded 1.25"}},
        {.name = "rings_mesh", .make = of<ringInRing, 5>, .was = {"125 um, recorded 4.0"}},
        {.name = "gear_mesh", .make = of<gearInGear, 6>, .seconds = 0.7},
        {.name = "dovetail_mesh", .make = of<dovetail, 7>, .was = {.time = "both ways 24 % of ticks > 1 ms"}},
        {.name = "bar_mesh",
         .make = meshBar,
         .was = {.time = "both ways 80 % of ticks > 1 ms"},
         .seconds = 1.0,
         .full_seconds = 10.0,
         .full_seeds = 1,
         .outruns = true},
        {.name = "sheet_mesh", .make = of<ballOnSheet, 8>},
        {.name = "seams_mesh", .make = of<blockOnSeams, 9>},
        {.name = "gaps_mesh", .make = gaps},
        {.name = "shaft_mesh", .make = of<keyedShaft, 11>},
        {.name = "d_peg_mesh", .make = of<dShaft, 12>},
        {.name = "scan_3mm_mesh", .make = scan<3, 60>, .was = {"421 um or more, recorded 0.5; both ways 25"}},
        {.name = "scan_10mm_mesh", .make = scan<10, 60>, .was = {"1508 um or more, recorded 0.5; both ways 60"}},
        {.name = "scan_30mm_mesh", .make = scan<30, 60>, .was = {"513 um or more, recorded 0.5; both ways 105"}},
        {.name = "scan_100mm_mesh",
         .make = scan<100, 110>,
         .was = {.overlap = "148 um or more, recorded 0.5; both ways 101", .time = "both ways 6.7 % of ticks > 1 ms"},
         .seconds = 0.8},
        {.name = "bolt_mesh",
         .make = bolt,
         .was = {.time = "60 % of ticks > 1 ms; both ways 99.7 %"},
         .seconds = 0.4,
         .full_seconds = 3.0,
         .full_seeds = 2,
         .may_be_suspended = true},
    };
    // Many triangles lie along each other there.
    constexpr std::size_t kSome = 5, kFew = 20;
    for (Found& found : all) {
        const std::string name = found.name;
        found.way_every = name == "gear_mesh" || name == "bolt_mesh" ? kFew : kSome;
    }
    return all;
}

}  // namespace passung::hard
