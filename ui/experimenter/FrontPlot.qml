import QtQuick
import "../controls"

// Error over processor time, both logarithmic: a mark with its bars for each setting, a line along the front.
FocusScope {
    id: plot
    property var points: []
    property string errorName
    readonly property real inset: look.scale * 62
    readonly property real low: look.scale * 40
    readonly property real wide: width - inset - 14
    readonly property real high: height - low - 8
    readonly property var front: points.filter(point => point.front)
    activeFocusOnTab: true
    Accessible.role: Accessible.Graphic
    Accessible.name: qsTr("%1 over the processor time of a tick, of every measured setting").arg(errorName)
    Keys.onLeftPressed: accuracy.step(-1)
    Keys.onRightPressed: accuracy.step(1)
    Keys.onUpPressed: accuracy.step(-1)
    Keys.onDownPressed: accuracy.step(1)
    function xOf(share) {
        return inset + share * wide;
    }
    function yOf(share) {
        return 8 + (1 - share) * high;
    }
    function nearest(x, y) {
        let best = -1, least = 22;
        for (let i = 0; i < points.length; ++i) {
            const away = Math.hypot(xOf(points[i].x) - x, yOf(points[i].y) - y);
            if (away < least) {
                least = away;
                best = i;
            }
        }
        return best;
    }

    Rectangle {
        x: plot.inset
        y: 8
        width: plot.wide
        height: plot.high
        color: "transparent"
        border.width: plot.activeFocus ? 2 : 1
        border.color: plot.activeFocus ? look.accent : look.edge
    }
    Repeater {
        model: accuracy.front.time !== undefined ? accuracy.front.time.ticks : []
        Rectangle {
            required property var modelData
            x: plot.xOf(modelData.at)
            y: 8
            width: 1
            height: plot.high
            color: look.edge
            Say {
                anchors.horizontalCenter: parent.horizontalCenter
                y: parent.height + 4
                quiet: true
                font.pixelSize: look.scale * 11
                font.family: look.digits
                text: parent.modelData.text
            }
        }
    }
    Repeater {
        model: accuracy.front.error !== undefined ? accuracy.front.error.ticks : []
        Rectangle {
            required property var modelData
            x: plot.inset
            y: plot.yOf(modelData.at)
            width: plot.wide
            height: 1
            color: look.edge
            Say {
                anchors.verticalCenter: parent.verticalCenter
                x: -width - 8
                quiet: true
                font.pixelSize: look.scale * 11
                font.family: look.digits
                text: parent.modelData.text
            }
        }
    }
    Repeater { // the front's line
        model: Math.max(0, plot.front.length - 1)
        Rectangle {
            required property int index
            readonly property real dx: plot.xOf(plot.front[index + 1].x) - plot.xOf(plot.front[index].x)
            readonly property real dy: plot.yOf(plot.front[index + 1].y) - plot.yOf(plot.front[index].y)
            x: plot.xOf(plot.front[index].x)
            y: plot.yOf(plot.front[index].y) - 1
            width: Math.hypot(dx, dy)
            height: 2
            transformOrigin: Item.Left
            rotation: Math.atan2(dy, dx) * 180 / Math.PI
            antialiasing: true
            color: look.dim
        }
    }
    Repeater {
        model: plot.points
        Item {
            id: dot
            required property var modelData
            required property int index
            readonly property bool chosen: index === accuracy.chosen
            objectName: "point-" + index
            x: plot.xOf(modelData.x)
            y: plot.yOf(modelData.y)
            Rectangle {
                x: plot.xOf(dot.modelData.xLow) - dot.x
                width: -x
                height: 1
                color: mark.hue
                opacity: mark.opacity
            }
            Rectangle {
                y: 0
                width: 1
                height: plot.yOf(dot.modelData.yLow) - dot.y
                color: mark.hue
                opacity: mark.opacity
            }
            FrontMark {
                id: mark
                x: -width / 2
                y: -height / 2
                size: dot.modelData.front ? 13 : 9
                method: dot.modelData.method
                geometry: dot.modelData.geometry
                strong: dot.modelData.front || dot.chosen
            }
            Rectangle { // the study's own
                visible: dot.modelData.inStudy
                anchors.centerIn: mark
                width: 24
                height: 24
                radius: 12
                color: "transparent"
                border.width: 2
                border.color: look.text
            }
            Rectangle {
                visible: dot.chosen
                anchors.centerIn: mark
                width: 30
                height: 30
                radius: 6
                color: "transparent"
                border.width: 2
                border.color: look.accent
            }
        }
    }
    Say {
        anchors.bottom: parent.bottom
        x: plot.inset + (plot.wide - width) / 2
        quiet: true
        font.pixelSize: look.scale * 12
        text: qsTr("processor time of a tick, 99.9 % below [µs]")
    }
    Say {
        rotation: -90
        x: -width / 2 + 8
        y: 8 + plot.high / 2 - height / 2
        quiet: true
        font.pixelSize: look.scale * 12
        text: plot.errorName
    }
    Say {
        visible: text !== ""
        x: plot.inset + 16
        y: 24
        width: plot.wide - 32
        wrapMode: Text.WordWrap
        text: accuracy.front.none !== undefined ? accuracy.front.none : ""
    }
    MouseArea {
        anchors.fill: parent
        onClicked: mouse => {
            const point = plot.nearest(mouse.x, mouse.y);
            if (point >= 0)
                accuracy.chosen = point;
            plot.forceActiveFocus();
        }
    }
}
