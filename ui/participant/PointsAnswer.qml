import QtQuick

// A rating of few points between two anchors: circles to be picked.
Item {
    id: root
    required property var row
    signal picked(int label)
    readonly property bool outside: width < 520 // anchors below the points
    readonly property real side: outside ? 0 : Math.min(150, width * 0.24)
    implicitHeight: outside ? 84 : 52

    Words {
        id: low
        x: 0
        y: root.outside ? 52 : 0
        width: root.outside ? parent.width / 2 - 8 : root.side
        height: root.outside ? 32 : parent.height
        verticalAlignment: Text.AlignVCenter
        horizontalAlignment: root.outside ? Text.AlignLeft : Text.AlignRight
        text: root.row.lowAnchor
        font.pixelSize: look.scale * 15
    }
    Words {
        x: parent.width - width
        y: low.y
        width: low.width
        height: low.height
        verticalAlignment: Text.AlignVCenter
        horizontalAlignment: root.outside ? Text.AlignRight : Text.AlignLeft
        text: root.row.highAnchor
        font.pixelSize: look.scale * 15
    }
    Item {
        id: points
        x: root.side + 14
        width: parent.width - 2 * x
        height: 52
        readonly property real pitch: width / Math.max(1, root.row.labels.length)
        readonly property real size: Math.min(42, pitch - 4)
        Rectangle {
            x: points.pitch / 2
            width: parent.width - points.pitch
            anchors.verticalCenter: parent.verticalCenter
            height: 2
            color: look.edge
        }
        Repeater {
            model: root.row.labels.length
            Rectangle {
                id: point
                required property int index
                readonly property bool on: root.row.picked === index
                objectName: "label" + index
                x: (index + 0.5) * points.pitch - width / 2
                anchors.verticalCenter: parent.verticalCenter
                width: points.size
                height: width
                radius: width / 2
                color: on ? look.accent : area.containsMouse ? look.raised : look.panel
                border.width: on ? 0 : 2
                border.color: area.containsMouse ? look.accent : look.edge
                Accessible.role: Accessible.RadioButton
                Accessible.name: root.row.labels[index]
                Accessible.checked: on
                Accessible.onPressAction: root.picked(index)
                Text {
                    textFormat: Text.PlainText
                    anchors.centerIn: parent
                    text: root.row.labels[point.index] ?? ""
                    color: point.on ? look.onAccent : look.dim
                    font.family: look.family
                    font.pixelSize: look.scale * 15
                    font.weight: point.on ? Font.DemiBold : Font.Normal
                }
                MouseArea {
                    id: area
                    anchors.centerIn: parent
                    width: points.pitch
                    height: points.height
                    hoverEnabled: true
                    onClicked: root.picked(point.index)
                }
            }
        }
    }
}
