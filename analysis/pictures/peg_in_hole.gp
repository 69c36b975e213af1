# The picture of `draw`, which sets `work` and `picture`. Lengths in mm.

load work."/variables.gp"

set terminal pngcairo size 1600,840 font "Inter,15" background "#ffffff" rounded
set output picture
set encoding utf8

# Colours of Okabe and Ito: distinct for every kind of colour vision.
hand = "#d55e00"; proxy = "#0072b2"; ink = "#222222"; faint = "#8a8a8a"; metal = "#c9ced3"; edge = "#6d747b"
searching = "#f6efdc"; inserting = "#e4eef4"

# The plate 60 x 30 with a bore of 20.2, 25 deep, and the peg 20 x 50; 45 degree chamfers of 0.5 at mouth and tip.
# Half-width of the bore in the section at y.
half(y) = sqrt(10.1**2 - y**2)
array plate_u[10]; array plate_v[10]
plate(y) = sum [i=1:10] ( \
    plate_u[i] = plate_x + (i==1||i==10 ? -30 : i==2 ? -half(y)-0.5 : i==3||i==4 ? -half(y) : \
                 i==5||i==6 ? half(y) : i==7 ? half(y)+0.5 : 30), \
    plate_v[i] = i==3||i==6 ? -0.5 : i==4||i==5 ? -25 : i==9||i==10 ? -30 : 0, 0)
array peg_u[7] = [-9.5, 9.5, 10, 10, -10, -10, -9.5]
array peg_v[7] = [0, 0, 0.5, 50, 50, 0.5, 0]
x_of(i, x, tilt) = x + peg_u[i]*cos(tilt) + peg_v[i]*sin(tilt)
z_of(i, z, tilt) = z - peg_u[i]*sin(tilt) + peg_v[i]*cos(tilt)

set multiplot

# ---- a: the section, to scale ----
set lmargin at screen 0.012; set rmargin at screen 0.367
set bmargin at screen 0.380; set tmargin at screen 0.925
unset border; unset tics; unset key
set size ratio -1
set xrange [-38:48]; set yrange [-33:38]
set label 1 "{/:Bold a}   Section through plate and peg, to scale" at screen 0.012, screen 0.965 left textcolor rgb ink
set label 2 "{/*0.87 10 mm}" at 42,-25.5 center textcolor rgb ink
set arrow 1 from 37,-29 to 47,-29 nohead lw 2.5 lc rgb ink front
set label 3 "{/*0.87 start}" at 20,34 center textcolor rgb "#6d747b" front
set label 4 "{/*0.87 peg during}" at -16.5,30 right textcolor rgb "#6d747b" front
set label 10 "{/*0.87 the search}" at -16.5,26.5 right textcolor rgb "#6d747b" front
set label 5 "{/*0.87 hole}" at -12,-11 right textcolor rgb ink front
set label 6 "{/*0.87 as drawn}" at -12,-14.5 right textcolor rgb ink front
set label 7 "{/*0.87 path of the tip:}" at 21,17 left textcolor rgb ink
set label 8 "{/*0.87 penalty}" at 21,13.4 left textcolor rgb hand
set label 9 "{/*0.87 god object}" at 21,9.8 left textcolor rgb proxy
dummy = plate(0)
plot plate_u using (plate_u[$1]):(plate_v[$1]) with filledcurves closed fc rgb metal, \
     plate_u using (plate_u[$1]):(plate_v[$1]) every ::0::9 with lines lw 1.2 lc rgb edge, \
     '+' using (-10.1):(-25 + 25.0*$0/99) with lines dt (10,7) lw 1.6 lc rgb ink, \
     '+' using ( 10.1):(-25 + 25.0*$0/99) with lines dt (10,7) lw 1.6 lc rgb ink, \
     peg_u using (x_of($1,20,0)):(z_of($1,30,0)) with lines dt (6,5) lw 1.4 lc rgb faint, \
     peg_u using (x_of($1,god_proxy_x,god_proxy_tilt)):(z_of($1,god_proxy_z,god_proxy_tilt)) \
         with filledcurves closed fc rgb "#e9edf0" fs transparent solid 0.55 noborder, \
     peg_u using (x_of($1,god_proxy_x,god_proxy_tilt)):(z_of($1,god_proxy_z,god_proxy_tilt)) with lines lw 1.6 lc rgb edge, \
     work."/penalty.txt" using 2:3 with lines lw 2.2 lc rgb hand, \
     work."/god.txt" using 4:5 with lines lw 2.2 lc rgb proxy
do for [i=1:10] { unset label i }
unset arrow 1

# ---- b, c: the peg's rim a third into the search ----
do for [panel=1:2] {
    is_penalty = panel == 1
    x_hand = is_penalty ? penalty_hand_x : god_hand_x; z_hand = is_penalty ? penalty_hand_z : god_hand_z
    tilt_hand = is_penalty ? penalty_hand_tilt : god_hand_tilt
    x_proxy = is_penalty ? penalty_proxy_x : god_proxy_x; z_proxy = is_penalty ? penalty_proxy_z : god_proxy_z
    tilt_proxy = is_penalty ? penalty_proxy_tilt : god_proxy_tilt
    left = is_penalty ? 0.012 : 0.196
    set lmargin at screen left; set rmargin at screen left + 0.171
    set bmargin at screen 0.055; set tmargin at screen 0.290
    set xrange [x_proxy-11.8:x_proxy-6.8]; set yrange [-1.7:1.91]
    set label 1 (is_penalty ? "{/:Bold b}   Penalty, enlarged" : "{/:Bold c}   God object, enlarged") \
        at screen left, screen 0.325 left textcolor rgb ink
    set label 2 sprintf("{/*0.87 %.2f mm}", (is_penalty ? penalty_um : god_um)/1000) \
        at x_proxy-10.32, -0.42 right textcolor rgb hand front
    set label 3 (is_penalty ? "{/*0.87 peg = hand}" : "{/*0.87 peg shown}") \
        at x_proxy-9.3, 0.85 left textcolor rgb (is_penalty ? hand : proxy) front
    set label 4 (is_penalty ? "" : "{/*0.87 hand}") at x_proxy-7.7, -0.86 right textcolor rgb hand front
    set label 5 "{/*0.87 plate}" at x_proxy-11.65, -1.4 left textcolor rgb edge front
    set arrow 1 from x_proxy-10.2, 0 to x_proxy-10.2, z_of(1,z_hand,tilt_hand) heads size 0.12,25 filled lw 1.6 lc rgb hand front
    set object 1 rectangle from graph 0,0 to graph 1,1 fs empty border lc rgb "#bbbbbb" lw 1 front
    y_plane = is_penalty ? penalty_y : god_y
    dummy = plate(y_plane)
    # The part of the peg within the frame, cut here because filled curves are cut wrongly at a corner of the frame.
    right = x_proxy - 6.8; slope = -tan(tilt_proxy)
    x2 = x_of(1,x_proxy,tilt_proxy); z2 = z_of(1,z_proxy,tilt_proxy)
    x3 = x_of(6,x_proxy,tilt_proxy); z3 = z_of(6,z_proxy,tilt_proxy)
    set object 2 polygon from right,z2+slope*(right-x2) to x2,z2 to x3,z3 to x3,1.91 to right,1.91 \
        to right,z2+slope*(right-x2) fc rgb (is_penalty ? hand : proxy) fs transparent solid 0.13 noborder front
    plot plate_u using (plate_u[$1]):(plate_v[$1]) with filledcurves closed fc rgb metal, \
         plate_u using (plate_u[$1]):(plate_v[$1]) with lines lw 1.2 lc rgb edge, \
         peg_u using (x_of($1,x_proxy,tilt_proxy)):(z_of($1,z_proxy,tilt_proxy)) with lines lw 2.6 \
             lc rgb (is_penalty ? hand : proxy), \
         peg_u using (x_of($1,x_hand,tilt_hand)):(z_of($1,z_hand,tilt_hand)) with lines dt (9,5) lw 2 lc rgb hand
}
do for [i=1:5] { unset label i }
unset arrow 1; unset object 1; unset object 2
set size noratio

# ---- d to g: over time ----
do for [panel=1:4] {
    is_penalty = panel % 2; is_overlap = panel <= 2
    file = work.(is_penalty ? "/penalty.txt" : "/god.txt")
    approach = is_penalty ? penalty_approach : god_approach
    engaged = is_penalty ? penalty_engaged : god_engaged
    end = is_penalty ? penalty_end : god_end
    set lmargin at screen is_penalty ? 0.452 : 0.735
    set rmargin at screen is_penalty ? 0.708 : 0.991
    set tmargin at screen is_overlap ? 0.880 : 0.395
    set bmargin at screen is_overlap ? 0.445 : 0.095
    set border 3 lc rgb faint lw 1
    set xrange [0.8:8.0]; set xtics 1,1,8 nomirror scale 0.5 textcolor rgb ink offset 0,0.2
    if (is_overlap) {
        set format x ""; unset xlabel
        set logscale y; set yrange [1:3000]
        set ytics ("1 µm" 1, "10 µm" 10, "0.1 mm" 100, "1 mm" 1000) nomirror scale 0.5 textcolor rgb ink
    } else {
        set format x "%g"; set xlabel "time from the start of the trial [s]" textcolor rgb ink offset 0,0.3
        unset logscale y; set yrange [0:8]
        set ytics 0,2,8 nomirror scale 0.5 textcolor rgb ink; set format y "%g"
    }
    set grid ytics lc rgb "#dddddd" lw 1 lt 1, lc rgb "#dddddd" lw 1 lt 1
    if (!is_penalty) {
        if (is_overlap) { set ytics ("" 1, "" 10, "" 100, "" 1000) } else { set format y "" }
    } else {
        set label 9 (is_overlap ? "overlap with the plate" : "force [N]") \
            at screen 0.387, screen (is_overlap ? 0.6625 : 0.245) center rotate by 90 textcolor rgb ink
    }
    top = is_overlap ? 3000 : 8; bottom = is_overlap ? 1 : 0
    set object 1 rectangle from approach,bottom to engaged,top fc rgb searching fs solid noborder behind
    set object 2 rectangle from engaged,bottom to (end < 8 ? end : 8),top fc rgb inserting fs solid noborder behind
    if (is_overlap) {
        set label 1 (is_penalty ? "{/:Bold d}   Penalty" : "{/:Bold e}   God object") at graph 0, screen 0.965 left textcolor rgb ink
        set label 2 "{/*0.87 approach}" at 0.5*(0.8+approach), screen 0.905 center textcolor rgb faint
        set label 3 "{/*0.87 search}" at 0.5*(approach+engaged), screen 0.905 center textcolor rgb "#9a7b1f"
        set label 4 "{/*0.87 insertion}" at 0.5*(engaged+end), screen 0.905 center textcolor rgb "#3b6f8f"
        if (is_penalty) {
            set label 5 "{/*0.87 hand = peg}" at 6.1, 900 left textcolor rgb hand front
            set label 6 sprintf("{/*0.87 at most %.2f mm}", penalty_largest_hand/1000) \
                at 6.1, 550 left textcolor rgb hand front
        } else {
            set label 5 sprintf("{/*0.87 hand: %.2f mm}", god_largest_hand/1000) \
                at 5.6, 900 left textcolor rgb hand front
            set label 6 "{/*0.87 shown peg}" at 5.6, 8 left textcolor rgb proxy front
            set label 7 sprintf("{/*0.87 at most %.0f µm}", god_largest_proxy) \
                at 5.6, 4.9 left textcolor rgb proxy front
        }
        if (is_penalty) {
            plot file using 1:6 with lines lw 1.8 lc rgb hand
        } else {
            plot file using 1:7 with lines lw 1.8 lc rgb proxy, file using 1:6 with lines lw 1.8 lc rgb hand
        }
    } else {
        do for [i=2:7] { unset label i }
        set label 1 (is_penalty ? "{/:Bold f}" : "{/:Bold g}") at graph 0.02, graph 0.93 left textcolor rgb ink front
        plot file using 1:8 with lines lw 1.6 lc rgb ink
    }
    unset label 9
}
unset multiplot
