import QtQuick
import QtQuick.Layouts
import QtQuick.Templates as T
import "../controls"

// Something that is wrong, with its place: a click goes there.
T.AbstractButton {
    id: row
    property string message
    property string place
    property string tone
    implicitHeight: words.implicitHeight + 14
    enabled: place !== ""
    focusPolicy: enabled ? Qt.StrongFocus : Qt.NoFocus
    hoverEnabled: true
    Accessible.role: enabled ? Accessible.Link : Accessible.StaticText
    Accessible.name: (place !== "" ? place + ": " : "") + message
    Keys.onReturnPressed: clicked()
    background: Rectangle {
        radius: 6
        color: row.hovered || row.visualFocus ? look.raised : "transparent"
        border.width: row.visualFocus ? 2 : 0
        border.color: look.accent
    }
    contentItem: Item {
        RowLayout {
            id: words
            x: 0
            y: 7
            width: parent.width
            spacing: 10
            Lamp {
                Layout.alignment: Qt.AlignTop
                Layout.topMargin: 3
                tone: row.tone
            }
            Say {
                Layout.alignment: Qt.AlignTop
                visible: text !== ""
                text: row.place
                color: look.accent
                font.family: look.digits
                font.pixelSize: look.scale * 13
                font.underline: row.hovered
                Accessible.ignored: true
            }
            Say {
                Layout.fillWidth: true
                text: row.message
                wrapMode: Text.WordWrap
                Accessible.ignored: true
            }
        }
    }
}
