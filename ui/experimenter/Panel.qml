import QtQuick

// A titled surface that groups what belongs together.
Rectangle {
    id: panel
    property string title
    property alias extra: extraText.text
    default property alias content: inner.data
    property int pad: 16
    color: look.panel
    radius: 10
    border.color: look.edge
    border.width: 1
    Say {
        id: heading
        x: panel.pad
        y: 12
        visible: panel.title !== ""
        text: panel.title
        quiet: true
        font.pixelSize: 12
        font.weight: Font.DemiBold
        font.letterSpacing: 0.4
    }
    Say {
        id: extraText
        anchors.right: parent.right
        anchors.rightMargin: panel.pad
        y: 12
        visible: text !== ""
        quiet: true
        font.pixelSize: 12
        font.family: look.digits
    }
    Item {
        id: inner
        anchors.fill: parent
        anchors.margins: panel.pad
        anchors.topMargin: panel.title === "" ? panel.pad : 38
    }
}
