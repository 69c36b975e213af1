import QtQuick
import Passung

// The last ten seconds of a signal, with its newest value.
Item {
    id: view
    property string name
    property string unit
    property color ink: look.accent
    property double value: 0
    property alias trace: item
    Say {
        id: label
        width: parent.width - number.width - 8
        wrapMode: Text.WordWrap
        text: view.name
        quiet: true
        font.pixelSize: look.scale * 12
    }
    Say {
        id: number
        anchors.right: parent.right
        text: view.value.toFixed(2) + " " + view.unit
        color: view.ink
        font.family: look.digits
        font.pixelSize: look.scale * 15
    }
    Item {
        id: field
        anchors.fill: parent
        anchors.topMargin: Math.max(label.height, number.height) + 6
        Repeater { // lines at whole, half and none
            model: 3
            Rectangle {
                y: index * (field.height - 1) / 2
                width: field.width
                height: 1
                color: look.edge
                opacity: index === 2 ? 1 : 0.6
            }
        }
        TraceItem {
            id: item
            anchors.fill: parent
            color: view.ink
            clip: true
        }
        Say {
            anchors.right: parent.right
            anchors.rightMargin: 4
            y: 2
            text: item.full
            quiet: true
            font.pixelSize: look.scale * 10
            font.family: look.digits
        }
    }
}
