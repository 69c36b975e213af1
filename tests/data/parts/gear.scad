// A spur gear: axis z, body from z = 0 up, a tooth on +x (or, with half = 1, a gap). Lengths in mm.
use <MCAD/involute_gears.scad>
teeth = 20;
module_mm = 2;
width = 8;
bore = 8;
backlash = 0.1;
half = 0;
rotate([0, 0, half * 180 / teeth])
gear(number_of_teeth = teeth, circular_pitch = 180 * module_mm, gear_thickness = width, rim_thickness = width,
     hub_thickness = width, hub_diameter = bore + 6, bore_diameter = bore, backlash = backlash, clearance = 0.3,
     involute_facets = 8, circles = 0);
