// A thread of ISO 68-1 by the cut at right angles to its axis, twisted: right-handed, axis z. Lengths in mm.
// A bolt, or (nut = true) a round nut; wider by `play` all around.
pitch = 2;
diameter = 16;
low = -4;
high = 4;
nut = false;
play = 0;
outer = 24;
around = 32;      // corners of the cut
slices = 16;      // a turn

depth = 0.54127 * pitch;
crest = diameter / 2 + play;
// Over a pitch: crest 1/8, flank, root 1/4, flank.
function radius(s) = s <= 0.125 ? crest : s <= 0.4375 ? crest - depth * (s - 0.125) / 0.3125
    : s <= 0.6875 ? crest - depth : crest - depth * (1 - s) / 0.3125;
function share(x) = x - floor(x);
module cut() polygon([for (i = [0 : around - 1]) radius(share(low / pitch - i / around))
                      * [cos(360 * i / around), sin(360 * i / around)]]);
translate([0, 0, low])
    linear_extrude(high - low, twist = -360 * (high - low) / pitch, slices = slices * (high - low) / pitch)
        if (nut) difference() { circle(d = outer, $fn = around); cut(); } else cut();
