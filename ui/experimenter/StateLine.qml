import QtQuick
import "../controls"

// What a session does, to be read from across the room.
Rectangle {
    property color tint: look.dim
    implicitHeight: look.scale * 92
    radius: 10
    color: look.panel
    border.color: look.edge
    clip: true
    Rectangle {
        width: 8
        height: parent.height
        color: parent.tint
    }
    Say {
        id: stateLine
        objectName: "stateLine"
        anchors.left: parent.left
        anchors.leftMargin: 32
        anchors.right: aside.left
        anchors.rightMargin: 20
        y: 14
        text: run.line
        font.pixelSize: look.scale * 30
        fontSizeMode: Text.HorizontalFit
        minimumPixelSize: 15
        font.weight: Font.DemiBold
    }
    Say {
        anchors.left: stateLine.left
        anchors.right: aside.left
        anchors.top: stateLine.bottom
        anchors.topMargin: 2
        quiet: true
        text: [run.detail, run.participant, run.study].filter(s => s !== "").join("  ·  ")
    }
    Row {
        id: aside
        anchors.right: parent.right
        anchors.rightMargin: 24
        anchors.verticalCenter: parent.verticalCenter
        spacing: 24
        ActionButton {
            objectName: "cancelBuild"
            visible: run.built >= 0
            text: qsTr("Cancel")
            onClicked: run.command("abort")
        }
        ActionButton {
            objectName: "openDisplay"
            visible: run.displayGone
            kind: "main"
            text: qsTr("Open the participant's window")
            onClicked: run.openDisplay()
        }
        Say {
            visible: run.running && run.seconds > 0 && run.built < 0 && !run.displayGone
            text: run.seconds.toFixed(1) + " s"
            font.family: look.digits
            font.pixelSize: look.scale * 34
        }
    }
    Rectangle {
        anchors.bottom: parent.bottom
        height: 4
        width: parent.width * (run.built >= 0 ? run.built : run.share)
        color: parent.tint
    }
}
