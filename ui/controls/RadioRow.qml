import QtQuick
import QtQuick.Templates as T

// One of several decisions, each with what it means.
T.RadioButton {
    id: option
    property string meaning
    implicitHeight: words.implicitHeight + 16
    focusPolicy: Qt.StrongFocus
    Accessible.role: Accessible.RadioButton
    Accessible.name: text
    Accessible.description: meaning
    Keys.onReturnPressed: toggle()
    background: Rectangle {
        radius: 8
        color: option.checked ? look.raised : "transparent"
        border.width: option.visualFocus ? 2 : 1
        border.color: option.visualFocus ? look.accent : look.edge
    }
    contentItem: Item {
        Rectangle {
            x: 14
            y: 10
            width: 16
            height: 16
            radius: 8
            color: "transparent"
            border.width: 2
            border.color: option.checked ? look.accent : look.dim
            Rectangle {
                anchors.centerIn: parent
                width: 8
                height: 8
                radius: 4
                visible: option.checked
                color: look.accent
            }
        }
        Column {
            id: words
            x: 42
            y: 8
            width: parent.width - 56
            spacing: 1
            Say {
                width: parent.width
                text: option.text
                font.weight: Font.DemiBold
                Accessible.ignored: true
            }
            Say {
                width: parent.width
                quiet: true
                font.pixelSize: look.scale * 12
                wrapMode: Text.WordWrap
                text: option.meaning
                Accessible.ignored: true
            }
        }
    }
}
