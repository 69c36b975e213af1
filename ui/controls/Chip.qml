import QtQuick

// A value in a frame.
Rectangle {
    property alias text: word.text
    property color ink: look.text
    implicitWidth: word.implicitWidth + 18
    implicitHeight: look.scale * 26
    radius: height / 2
    color: look.raised
    border.color: look.edge
    Say {
        id: word
        anchors.centerIn: parent
        font.pixelSize: look.scale * 13
        color: parent.ink
    }
}
