import QtQuick
import QtQuick.Layouts
import "../controls"

// The stages that some conditions share, each with a bar of its cost.
Column {
    id: list
    property var table
    property real whole: 1 // of the costliest table [µs]
    spacing: 6
    bottomPadding: 14
    RowLayout {
        width: parent.width
        spacing: 12
        Say {
            Layout.fillWidth: true
            text: list.table.conditions
            font.weight: Font.DemiBold
            font.pixelSize: look.scale * 13
        }
        Say {
            text: qsTr("%1 µs a tick").arg(list.table.sum.toFixed(1))
            font.family: look.digits
            font.pixelSize: look.scale * 13
        }
    }
    Repeater {
        model: list.table.rows
        RowLayout {
            id: stage
            required property var modelData
            width: list.width
            spacing: 14
            Accessible.role: Accessible.StaticText
            Accessible.name: qsTr("%1: %2 µs, 99 % below %3 µs; %4").arg(modelData.name).arg(modelData.median.toFixed(1)).arg(modelData.p99.toFixed(1)).arg(modelData.reason)
            Say {
                Layout.preferredWidth: look.scale * 170
                Layout.maximumWidth: look.scale * 170
                font.pixelSize: look.scale * 13
                text: stage.modelData.name
            }
            Rectangle {
                Layout.preferredWidth: look.scale * 160
                implicitHeight: 8
                radius: 3
                color: look.raised
                Rectangle { // 99 % of ticks
                    height: parent.height
                    radius: 3
                    width: Math.min(1, stage.modelData.p99 / list.whole) * parent.width
                    color: look.accent
                    opacity: 0.4
                }
                Rectangle {
                    height: parent.height
                    radius: 3
                    width: Math.max(1, Math.min(1, stage.modelData.median / list.whole) * parent.width)
                    color: look.accent
                }
            }
            Say {
                Layout.preferredWidth: look.scale * 120
                horizontalAlignment: Text.AlignRight
                font.family: look.digits
                font.pixelSize: look.scale * 12
                text: stage.modelData.median.toFixed(1) + " · " + stage.modelData.p99.toFixed(1) + " µs"
            }
            Say {
                Layout.fillWidth: true
                quiet: true
                font.pixelSize: look.scale * 12
                wrapMode: Text.WordWrap
                text: stage.modelData.reason
            }
        }
    }
}
