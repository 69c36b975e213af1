import QtQuick
import QtQuick.Templates as T

// A line of text to type.
T.TextField {
    id: box
    implicitHeight: look.scale * 38
    implicitWidth: look.scale * 200
    leftPadding: 12
    rightPadding: 12
    verticalAlignment: TextInput.AlignVCenter
    color: look.text
    selectionColor: look.accent
    selectedTextColor: look.onAccent
    placeholderTextColor: look.dim
    font.family: look.family
    font.pixelSize: look.scale * 14
    selectByMouse: true
    activeFocusOnTab: true
    opacity: enabled ? 1 : 0.5
    Accessible.role: Accessible.EditableText
    Accessible.name: placeholderText
    background: Rectangle {
        radius: 7
        color: look.raised
        border.width: box.activeFocus ? 2 : 1
        border.color: box.activeFocus ? look.accent : look.edge
    }
    Say {
        x: box.leftPadding
        width: box.width - 2 * box.leftPadding
        anchors.verticalCenter: parent.verticalCenter
        visible: box.text === "" && box.preeditText === ""
        quiet: true
        text: box.placeholderText
        Accessible.ignored: true
    }
}
