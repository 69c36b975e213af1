import QtQuick
import QtQuick.Templates as T

// A large target for mouse, finger and keyboard.
T.Button {
    id: button
    property bool main: false
    implicitHeight: 56
    implicitWidth: Math.max(150, label.implicitWidth + 56)
    focusPolicy: Qt.StrongFocus
    hoverEnabled: true
    font.family: look.family
    font.pixelSize: look.scale * 19
    font.weight: Font.DemiBold
    Accessible.role: Accessible.Button
    Accessible.name: text
    Keys.onReturnPressed: clicked()
    Keys.onEnterPressed: clicked()

    readonly property color base: main ? look.accent : look.panel
    background: Rectangle {
        radius: 10
        color: button.down ? Qt.darker(button.base, 1.15) : button.hovered ? Qt.lighter(button.base, look.dark ? 1.15 : 1.03) : button.base
        border.width: button.main ? 0 : 1
        border.color: look.edge
        Rectangle {
            anchors.fill: parent
            anchors.margins: -5
            radius: 14
            color: "transparent"
            border.width: 3
            border.color: look.accent
            visible: button.activeFocus
        }
    }
    contentItem: Text {
        textFormat: Text.PlainText
        id: label
        text: button.text
        font: button.font
        color: button.main ? look.onAccent : look.text
        horizontalAlignment: Text.AlignHCenter
        verticalAlignment: Text.AlignVCenter
    }
}
