# awk -f architecture.awk tests/rooms.cmake SOURCE...: an SVG of the rooms and the arrows between them, on standard output.
#
# A room is a name of the table in rooms.cmake that a source or an include lies in; an arrow is an include.
# Layers:   a room stands just below the lowest room that includes it; no arrow points upward.
# Arrows:   one that follows from two others is left out. The title of a box names all rooms that it includes.
# A slab:   the room that all others stand on is drawn once, under everything, without its arrows.
# Order:    in a layer rooms of one top folder stand together; an arrow that passes a layer gets a place in it.

function roomOf(path,    i, best) {
    best = ""
    for (i = 1; i <= table_size; i++)
        if (index(path, table[i] "/") == 1 && length(table[i]) > length(best)) best = table[i]
    return best
}

function addRoom(name,    at) {
    if (name in known) return
    known[name] = 1
    at = ++room_count
    # Kept in alphabetical order, so that the picture does not depend on that of the files.
    while (at > 1 && rooms[at - 1] > name) {
        rooms[at] = rooms[at - 1]
        at--
    }
    rooms[at] = name
}

# Every awk walks its arrays in an order of its own: all loops go through rooms[] and places[].
FNR == 1 { source = roomOf(FILENAME); in_table = 0 }
FILENAME ~ /rooms\.cmake$/ {
    if ($0 ~ /^set\(rooms/) in_table = 1
    if (in_table && match($0, /"[a-z][a-z_\/]* *\|/)) {
        name = substr($0, RSTART + 1, RLENGTH - 2)
        sub(/ +$/, "", name)
        table[++table_size] = name
    }
    if (in_table && /"\)/) in_table = 0
    next
}
/^[ \t]*#[ \t]*include[ \t]*"/ {
    split($0, parts, "\"")
    target = roomOf(parts[2])
    if (source == "" || target == "" || source == "tests" || target == "tests") next
    addRoom(source)
    addRoom(target)
    if (source != target) arrow[source, target] = 1
}

# The length of the longest way down from a room; a circle ends the drawing.
function heightOf(room,    i, h) {
    if (room in height) return height[room]
    if (room in open) fail("the rooms include each other in a circle at " room)
    open[room] = 1
    h = 0
    for (i = 1; i <= room_count; i++)
        if ((room, rooms[i]) in arrow && heightOf(rooms[i]) + 1 > h) h = height[rooms[i]] + 1
    delete open[room]
    return height[room] = h
}

function fail(message) {
    print "architecture: " message > "/dev/stderr"
    failed = 1
    exit 1
}

function reaches(from, to,    i) {
    if ((from, to) in reach) return reach[from, to]
    reach[from, to] = 0
    for (i = 1; i <= room_count && !reach[from, to]; i++)
        if ((from, rooms[i]) in arrow && (rooms[i] == to || reaches(rooms[i], to))) reach[from, to] = 1
    return reach[from, to]
}

function isNeeded(from, to,    i) {
    for (i = 1; i <= room_count; i++)
        if (rooms[i] != to && (from, rooms[i]) in arrow && reaches(rooms[i], to)) return 0
    return 1
}

# The layer just below the lowest room that includes this one; its height if none does.
function layerOf(room,    i, below, lowest) {
    if (room in layer) return layer[room]
    lowest = room_count
    for (i = 1; i <= room_count; i++) {
        if (!((rooms[i], room) in arrow)) continue
        below = layerOf(rooms[i]) - 1
        if (below < lowest) lowest = below
    }
    return layer[room] = lowest == room_count ? height[room] : lowest
}

function folderOf(room) {
    sub(/\/.*/, "", room)
    return room
}

# A place in a layer: a room, or the bend of an arrow that passes.
function addPlace(name, in_layer, folder_rank, wide) {
    places[++place_count] = name
    layer[name] = in_layer
    rank[name] = folder_rank
    width[name] = wide
    row[in_layer, ++row_size[in_layer]] = name
}

function connect(above, below) {
    down[above, ++down_count[above]] = below
    up[below, ++up_count[below]] = above
}

# The mean x of a place's neighbours above and below; its own x if it has none.
function wantedX(name,    i, sum, n) {
    for (i = 1; i <= up_count[name]; i++) { sum += x[up[name, i]]; n++ }
    for (i = 1; i <= down_count[name]; i++) { sum += x[down[name, i]]; n++ }
    return n ? sum / n : x[name]
}

function comesBefore(a, b) {
    if (rank[a] != rank[b]) return rank[a] < rank[b]
    if (wanted[a] != wanted[b]) return wanted[a] < wanted[b]
    return a < b
}

# Sorts a layer by folder, then by what its places want.
function sortLayer(l,    i, j, name) {
    for (i = 1; i <= row_size[l]; i++) wanted[row[l, i]] = wantedX(row[l, i])
    for (i = 2; i <= row_size[l]; i++) {
        name = row[l, i]
        for (j = i - 1; j >= 1 && comesBefore(name, row[l, j]); j--) row[l, j + 1] = row[l, j]
        row[l, j + 1] = name
    }
}

function apart(a, b) { return (width[a] + width[b]) / 2 + kGapX }

# Puts every place where it wants to be, as far as its neighbours in the layer leave room: the mean of the leftmost and
# the rightmost layout that keep the order.
function spreadLayer(l,    i, name, limit) {
    for (i = 1; i <= row_size[l]; i++) {
        name = row[l, i]
        wanted[name] = wantedX(name)
        left[name] = wanted[name]
        if (i > 1 && left[name] < left[row[l, i - 1]] + apart(row[l, i - 1], name))
            left[name] = left[row[l, i - 1]] + apart(row[l, i - 1], name)
    }
    for (i = row_size[l]; i >= 1; i--) {
        name = row[l, i]
        limit = wanted[name]
        if (i < row_size[l] && limit > x[row[l, i + 1]] - apart(name, row[l, i + 1]))
            limit = x[row[l, i + 1]] - apart(name, row[l, i + 1])
        x[name] = limit
    }
    for (i = 1; i <= row_size[l]; i++) x[row[l, i]] = (x[row[l, i]] + left[row[l, i]]) / 2
}

# Where an arrow touches a box: those of one side share its middle evenly, in the order of their other ends.
function portX(name, other, outgoing,    i, n, before, place) {
    if (!(name in known)) return x[name]
    n = outgoing ? down_count[name] : up_count[name]
    for (i = 1; i <= n; i++) {
        place = outgoing ? down[name, i] : up[name, i]
        if (x[place] < x[other] || (x[place] == x[other] && place < other)) before++
    }
    return x[name] + (before - (n - 1) / 2) * (n > 1 ? kBoxWidth * 0.6 / (n - 1 > 3 ? n - 1 : 3) : 0)
}

function topOf(l) { return kMargin + (top_layer - l) * kLayerHeight }

function number(value) {
    value = sprintf("%.1f", value)
    sub(/\.0$/, "", value)
    return value == "-0" ? "0" : value
}

function drawBox(name, left_x, top_y, wide, note,    i, title, fill, n) {
    title = ""
    for (i = 1; i <= room_count; i++) if ((name, rooms[i]) in arrow) title = title (title == "" ? "" : ", ") rooms[i]
    fill = colour[folderOf(name)]
    n = index(name, "/")
    printf "<g><title>%s %s</title>", name, title == "" ? "includes no other room" : "includes " title
    printf "<rect x=\"%s\" y=\"%s\" width=\"%s\" height=\"%d\" rx=\"7\" fill=\"%s\"/>", number(left_x), number(top_y),
        number(wide), kBoxHeight, fill
    printf "<text x=\"%s\" y=\"%s\">", number(left_x + wide / 2), number(top_y + kBoxHeight / 2 + 5)
    if (n) printf "<tspan class=\"folder\">%s</tspan>", substr(name, 1, n)
    printf "<tspan class=\"room\">%s</tspan>", substr(name, n + 1)
    if (note != "") printf "<tspan class=\"folder\">%s</tspan>", note
    print "</text></g>"
}

END {
    if (failed) exit 1
    if (room_count == 0) fail("no includes between rooms")
    for (i = 1; i <= room_count; i++) if (length(rooms[i]) > longest) longest = length(rooms[i])
    kBoxWidth = 8 * longest; kBoxHeight = 34; kBendWidth = 8; kGapX = 18; kLayerHeight = 72; kMargin = 12
    # Light enough for dark text, dark enough to stand on white: the boxes carry their own ground in light and dark pages.
    palette_size = split("#9ecae9 #f2b880 #a8d5a2 #d7b5e0 #f4a6a6 #e6d58a #9fd6cf #c9c9c9", palette, " ")
    folder_count = 0
    for (i = 1; i <= table_size; i++) {
        folder = folderOf(table[i])
        if (folder == "tests" || folder in folder_rank) continue
        folder_rank[folder] = ++folder_count
        colour[folder] = palette[(folder_count - 1) % palette_size + 1]
    }

    for (i = 1; i <= room_count; i++) heightOf(rooms[i])
    top_layer = 0
    for (i = 1; i <= room_count; i++) if (layerOf(rooms[i]) > top_layer) top_layer = layer[rooms[i]]
    slab = ""
    for (i = 1; i <= room_count; i++) {
        standing = 0
        for (j = 1; j <= room_count; j++) if (reaches(rooms[j], rooms[i])) standing++
        if (standing == room_count - 1) slab = rooms[i]
    }

    for (i = 1; i <= room_count; i++)
        if (rooms[i] != slab) addPlace(rooms[i], layer[rooms[i]], folder_rank[folderOf(rooms[i])], kBoxWidth)
    for (i = 1; i <= room_count; i++)
        for (j = 1; j <= room_count; j++) {
            from = rooms[i]
            to = rooms[j]
            if (to == slab || !((from, to) in arrow) || !isNeeded(from, to)) continue
            ends[++end_count] = from SUBSEP to
            above = from
            for (l = layer[from] - 1; l > layer[to]; l--) {
                bend = from ">" to ">" l
                share = (layer[from] - l) / (layer[from] - layer[to])
                addPlace(bend, l, rank[from] + share * (rank[to] - rank[from]), kBendWidth)
                connect(above, bend)
                above = bend
            }
            connect(above, to)
        }

    for (l = 0; l <= top_layer; l++) {
        at = 0
        for (i = 1; i <= row_size[l]; i++) {
            x[row[l, i]] = at + width[row[l, i]] / 2
            at += width[row[l, i]] + kGapX
        }
    }
    for (round = 1; round <= 12; round++)
        for (l = 0; l <= top_layer; l++) {
            sortLayer(l)
            spreadLayer(l)
        }
    for (round = 1; round <= 30; round++) {
        for (l = 0; l <= top_layer; l++) spreadLayer(l)
        for (l = top_layer; l >= 0; l--) spreadLayer(l)
    }

    leftmost = 1e9
    rightmost = -1e9
    for (i = 1; i <= place_count; i++) {
        name = places[i]
        if (x[name] - width[name] / 2 < leftmost) leftmost = x[name] - width[name] / 2
        if (x[name] + width[name] / 2 > rightmost) rightmost = x[name] + width[name] / 2
    }
    for (i = 1; i <= place_count; i++) x[places[i]] += kMargin - leftmost
    total_width = rightmost - leftmost + 2 * kMargin
    total_height = topOf(0) + kBoxHeight + kMargin

    printf "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %s %s\" role=\"img\">\n", number(total_width),
        number(total_height)
    print "<title>The rooms of Passung and what they include</title>"
    print "<!-- Drawn from the includes by ./dev architecture; an arrow that follows from two others is left out. -->"
    print "<style>text{font-family:Inter,'Helvetica Neue',Arial,sans-serif;font-size:14px;text-anchor:middle;fill:#16202a}" \
        ".folder{fill:#46535f}.room{font-weight:600}path{fill:none;stroke:#808a94;stroke-width:1.4}</style>"
    print "<defs><marker id=\"tip\" viewBox=\"0 0 8 8\" refX=\"7\" refY=\"4\" markerWidth=\"7\" markerHeight=\"7\" " \
        "orient=\"auto\"><path d=\"M0 0L8 4L0 8z\" style=\"fill:#808a94;stroke:none\"/></marker></defs>"
    for (i = 1; i <= end_count; i++) {
        split(ends[i], pair, SUBSEP)
        from = pair[1]
        to = pair[2]
        above = from
        line = ""
        for (l = layer[from] - 1; l >= layer[to]; l--) {
            below = l > layer[to] ? from ">" to ">" l : to
            x0 = portX(above, below, 1)
            x1 = portX(below, above, 0)
            y0 = topOf(l + 1) + kBoxHeight
            y1 = topOf(l) - (below == to ? 2 : 0)
            middle = (y0 + y1) / 2
            if (line == "") line = "M" number(x0) " " number(y0)
            line = line "C" number(x0) " " number(middle) " " number(x1) " " number(middle) " " number(x1) " " number(y1)
            if (below != to) line = line "V" number(y1 + kBoxHeight)
            above = below
        }
        printf "<path d=\"%s\" marker-end=\"url(#tip)\"><title>%s includes %s</title></path>\n", line, from, to
    }
    for (i = 1; i <= room_count; i++) {
        name = rooms[i]
        if (name == slab)
            drawBox(name, kMargin, topOf(0), total_width - 2 * kMargin, ", which every room stands on")
        else
            drawBox(name, x[name] - kBoxWidth / 2, topOf(layer[name]), kBoxWidth, "")
    }
    print "</svg>"
}
