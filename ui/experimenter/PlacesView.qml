import QtQuick
import "../controls"

// The slots in the order in which they are taken, and how even the orders are so far.
Flickable {
    id: view
    contentHeight: sheet.height
    clip: true
    Column {
        id: sheet
        width: view.width
        spacing: 12
        Flow {
            width: parent.width
            spacing: 6
            Repeater {
                model: participants.places
                Rectangle {
                    id: place
                    required property var modelData
                    readonly property bool taken: modelData.owner !== ""
                    width: look.scale * 64
                    height: look.scale * 40
                    radius: 6
                    color: taken ? (modelData.done ? look.accent : look.raised) : "transparent"
                    border.width: taken && !modelData.done ? 2 : 1
                    border.color: taken ? look.accent : look.edge
                    readonly property color ink: modelData.done ? look.onAccent : look.text
                    Accessible.role: Accessible.StaticText
                    Accessible.name: qsTr("Place %1: %2").arg(modelData.name).arg(taken ? modelData.owner : qsTr("free"))
                    Say {
                        anchors.horizontalCenter: parent.horizontalCenter
                        y: look.scale * 4
                        text: place.taken ? place.modelData.owner : qsTr("free")
                        color: place.taken ? place.ink : look.dim
                        font.pixelSize: look.scale * 12
                        font.family: place.taken ? look.digits : look.family
                        font.weight: place.taken ? Font.DemiBold : Font.Normal
                        Accessible.ignored: true
                    }
                    Say {
                        anchors.horizontalCenter: parent.horizontalCenter
                        y: look.scale * 21
                        width: Math.min(implicitWidth, place.width - 6)
                        text: place.modelData.name + (place.modelData.group !== "" ? " · " + place.modelData.group : "")
                        color: place.taken ? place.ink : look.dim
                        opacity: 0.8
                        font.pixelSize: look.scale * 11
                        Accessible.ignored: true
                    }
                }
            }
        }
        Column {
            width: parent.width
            spacing: 3
            Repeater {
                model: participants.balance
                Say {
                    required property string modelData
                    width: sheet.width
                    quiet: true
                    font.pixelSize: look.scale * 12
                    text: modelData
                    wrapMode: Text.WordWrap
                }
            }
        }
    }
}
