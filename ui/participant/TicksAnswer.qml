import QtQuick

// A long scale between two anchors: with a mark for each answer, or without any.
Item {
    id: root
    required property var row
    signal placed(real value)
    implicitHeight: 66

    Item {
        id: field
        x: 14
        width: parent.width - 28
        height: 40
        readonly property real share: root.row.high > root.row.low ? (root.row.value - root.row.low) / (root.row.high - root.row.low) : 0
        Rectangle {
            y: 28
            width: parent.width
            height: 2
            color: look.dim
        }
        Repeater {
            model: root.row.ticks
            Rectangle {
                required property int index
                readonly property bool tall: index === 0 || index === root.row.ticks - 1 || 2 * index === root.row.ticks - 1
                x: index * field.width / (root.row.ticks - 1) - 1
                y: tall ? 12 : 19
                width: 2
                height: 30 - y
                color: tall ? look.dim : look.edge
            }
        }
        Rectangle { // the answer
            objectName: "mark"
            visible: root.row.answered
            x: field.share * field.width - width / 2
            y: 4
            width: 14
            height: 36
            radius: 7
            color: look.accent
        }
        MouseArea {
            objectName: "field"
            anchors.fill: parent
            anchors.margins: -14
            anchors.bottomMargin: -26
            hoverEnabled: true
            cursorShape: Qt.PointingHandCursor
            preventStealing: true
            function take(x) {
                root.placed(root.row.low + (x - 14) / field.width * (root.row.high - root.row.low));
            }
            onPressed: event => take(event.x)
            onPositionChanged: event => {
                if (pressed)
                    take(event.x);
            }
        }
    }
    Words {
        x: 6
        y: 42
        text: root.row.lowAnchor
        quiet: true
        font.pixelSize: look.scale * 14
    }
    Words {
        anchors.right: parent.right
        anchors.rightMargin: 6
        y: 42
        text: root.row.highAnchor
        quiet: true
        font.pixelSize: look.scale * 14
    }
}
