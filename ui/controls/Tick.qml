import QtQuick
import QtQuick.Templates as T

// Something to be or not.
T.CheckBox {
    id: tick
    implicitHeight: look.scale * 38
    implicitWidth: word.implicitWidth + 34
    focusPolicy: Qt.StrongFocus
    Accessible.role: Accessible.CheckBox
    Accessible.name: text
    Keys.onReturnPressed: toggle()
    indicator: Rectangle {
        anchors.verticalCenter: parent.verticalCenter
        width: 20
        height: look.scale * 20
        radius: 5
        color: look.raised
        border.width: tick.visualFocus ? 2 : 1
        border.color: tick.visualFocus ? look.accent : look.dim
        Say {
            anchors.centerIn: parent
            visible: tick.checked
            text: "✓"
            color: look.accent
            font.weight: Font.DemiBold
            Accessible.ignored: true
        }
    }
    contentItem: Item {
        Say {
            id: word
            x: 28
            anchors.verticalCenter: parent.verticalCenter
            text: tick.text
            Accessible.ignored: true
        }
    }
}
