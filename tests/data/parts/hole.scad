// A block with the hole for such a peg: origin in the middle of the hole's mouth, body below z = 0. Lengths in mm.
// Round holes are polygons whose flats touch the circle: there the play is `play` at least, whichever way it is turned.
kind = "round";
size = 8;
other = 8;
play = 0.1;       // total: the hole is so much wider
depth = 30;       // right through a block of this height
mouth = 0;        // 45 degree chamfer of the mouth
corners = 96;
flat = 0.25;

module outline(more) {
    if (kind == "round") circle(d = (size + play + 2 * more) / cos(180 / corners), $fn = corners);
    if (kind == "rect") square([size + play + 2 * more, other + play + 2 * more], center = true);
    if (kind == "d") intersection() {
        circle(d = (size + play + 2 * more) / cos(180 / corners), $fn = corners);
        translate([-size, -2 * size]) square([1.5 * size - flat * size + play / 2 + more, 4 * size]);
    }
}
difference() {
    translate([-size - 10, -size - 10, -depth]) cube([2 * size + 20, 2 * size + 20, depth]);
    translate([0, 0, -depth - 1]) linear_extrude(depth + 2) outline(0);
    if (mouth > 0) translate([0, 0, -mouth]) linear_extrude(mouth, scale = 1 + 2 * mouth / (size + play)) outline(0);
}
