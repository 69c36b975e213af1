import QtQuick
import QtQuick.Templates as T

// A number or a text that is typed.
Item {
    id: typed
    required property var row
    signal edited(string text)
    signal entered
    signal taken // the focus
    readonly property bool number: row.look === "number"
    implicitHeight: (number ? 48 : 92) + (fault.visible ? 24 : 0)
    function take() {
        (number ? line : lines).forceActiveFocus(Qt.TabFocusReason);
    }

    component Frame: Rectangle {
        property bool current
        radius: 9
        color: look.ground
        border.width: current ? 2 : 1
        border.color: current ? look.accent : typed.row.fault !== "" ? look.bad : look.edge
    }

    T.TextField {
        id: line
        objectName: "typed"
        visible: typed.number
        width: Math.min(parent.width, 170)
        height: 48
        leftPadding: 14
        rightPadding: 14
        verticalAlignment: TextInput.AlignVCenter
        color: look.text
        font.family: look.family
        font.pixelSize: look.scale * 19
        selectByMouse: true
        inputMethodHints: Qt.ImhFormattedNumbersOnly
        text: typed.number ? typed.row.typed : ""
        Accessible.role: Accessible.EditableText
        Accessible.name: typed.row.text
        onTextEdited: typed.edited(text)
        onActiveFocusChanged: if (activeFocus)
            typed.taken()
        Keys.onReturnPressed: typed.entered()
        Keys.onEnterPressed: typed.entered()
        background: Frame {
            current: line.activeFocus
        }
    }
    Words {
        visible: typed.number
        anchors.left: line.right
        anchors.leftMargin: 14
        anchors.verticalCenter: line.verticalCenter
        text: typed.row.range
        quiet: true
        font.pixelSize: look.scale * 15
    }
    T.TextArea {
        id: lines
        objectName: "typed"
        visible: !typed.number
        width: parent.width
        height: 92
        padding: 14
        color: look.text
        font.family: look.family
        font.pixelSize: look.scale * 17
        wrapMode: TextEdit.Wrap
        selectByMouse: true
        text: typed.number ? "" : typed.row.typed
        Accessible.role: Accessible.EditableText
        Accessible.name: typed.row.text
        onTextChanged: if (activeFocus)
            typed.edited(text)
        onActiveFocusChanged: if (activeFocus)
            typed.taken()
        Keys.onTabPressed: nextItemInFocusChain(true).forceActiveFocus(Qt.TabFocusReason)
        Keys.onBacktabPressed: nextItemInFocusChain(false).forceActiveFocus(Qt.BacktabFocusReason)
        background: Frame {
            current: lines.activeFocus
        }
    }
    Words {
        id: fault
        anchors.bottom: parent.bottom
        visible: text !== ""
        text: typed.row.fault
        color: look.bad
        font.pixelSize: look.scale * 15
    }
}
