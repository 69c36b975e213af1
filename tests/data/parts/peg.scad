// A peg: origin in the middle of its tip, body along +z. Lengths in mm.
// Round ones are polygons whose corners lie on the circle: `size` is the diameter over corners.
kind = "round";   // "round", "rect", "d"
size = 8;         // diameter, or edge along x
other = 8;        // edge along y of a rectangular one
length = 50;
chamfer = 0.5;
corners = 96;
flat = 0.25;      // of the diameter that a D lacks on +x

module outline(less) {
    if (kind == "round") circle(d = size - 2 * less, $fn = corners);
    if (kind == "rect") square([size - 2 * less, other - 2 * less], center = true);
    if (kind == "d") intersection() {
        circle(d = size - 2 * less, $fn = corners);
        translate([-size, -size]) square([1.5 * size - flat * size - less, 2 * size]);
    }
}
if (kind == "d") hull() {
    linear_extrude(0.001) outline(chamfer);
    translate([0, 0, chamfer]) linear_extrude(length - chamfer) outline(0);
} else union() {
    narrow = [1 - 2 * chamfer / size, 1 - 2 * chamfer / (kind == "rect" ? other : size)];
    rotate([180, 0, 0]) translate([0, 0, -chamfer]) linear_extrude(chamfer, scale = narrow) outline(0);
    translate([0, 0, chamfer]) linear_extrude(length - chamfer) outline(0);
}
