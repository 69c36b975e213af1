import QtQuick
import QtQuick.Layouts
import "../controls"

// The stiffness of a condition as a share of what its device bears.
RowLayout {
    id: row
    property var wall
    readonly property real edge: wall.border > 0 ? wall.border : wall.most > 0 ? wall.most : Math.max(wall.stiffness, 1)
    readonly property color tint: !wall.known ? look.dim : wall.stable ? look.good : look.bad
    spacing: 14
    Accessible.role: Accessible.StaticText
    Accessible.name: wall.condition + ": " + verdict.text
    Column {
        Layout.preferredWidth: look.scale * 330
        Layout.maximumWidth: look.scale * 330
        Say {
            width: parent.width
            font.pixelSize: look.scale * 13
            text: row.wall.condition
        }
        Say {
            width: parent.width
            quiet: true
            font.pixelSize: look.scale * 11
            text: row.wall.device
        }
    }
    Rectangle {
        Layout.fillWidth: true
        implicitHeight: 16
        radius: 4
        color: look.raised
        border.color: look.edge
        Rectangle {
            x: 1
            y: 1
            height: parent.height - 2
            radius: 3
            width: Math.min(1, row.wall.stiffness / row.edge) * (parent.width - 2)
            color: row.tint
        }
        Rectangle {
            visible: row.wall.most > 0 && row.wall.most <= row.edge
            x: row.wall.most / row.edge * (parent.width - 2)
            y: -4
            width: 2
            height: parent.height + 8
            color: look.text
        }
    }
    Column {
        Layout.preferredWidth: look.scale * 230
        Layout.maximumWidth: look.scale * 230
        Say {
            width: parent.width
            font.family: look.digits
            font.pixelSize: look.scale * 13
            text: Math.round(row.wall.stiffness) + " N/m" + (row.wall.border > 0 ? qsTr(" of %1").arg(Math.round(row.wall.border)) : "")
        }
        Say {
            id: verdict
            width: parent.width
            color: row.tint
            font.pixelSize: look.scale * 11
            text: !row.wall.known ? qsTr("what the device bears is not known") : row.wall.stable ? qsTr("stable: %1 % of the border").arg(Math.round(100 * row.wall.stiffness / row.edge)) : qsTr("✕ unstable by the model")
        }
    }
}
