import QtQuick

// A titled surface that groups what belongs together.
Rectangle {
    id: panel
    property string title
    property string lamp // tone of a lamp beside the title; empty: none
    property alias extra: extraText.text
    default property alias content: inner.data
    property int pad: 16
    readonly property real begins: title === "" ? pad : look.scale * 22 + pad // of what is in it
    readonly property real fitting: begins + inner.childrenRect.height + pad // height, if its content has one of its own
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
        font.pixelSize: look.scale * 12
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
        font.pixelSize: look.scale * 12
        font.family: look.digits
    }
    Lamp {
        anchors.right: parent.right
        anchors.rightMargin: panel.pad
        anchors.verticalCenter: heading.verticalCenter
        visible: panel.lamp !== ""
        tone: panel.lamp
    }
    Item {
        id: inner
        anchors.fill: parent
        anchors.margins: panel.pad
        anchors.topMargin: panel.begins
    }
}
