import QtQuick
import QtQuick.Templates as T

// A command: its word, its key, and when it cannot be given, why.
T.Button {
    id: button
    property string keyName
    property string why // not; empty: possible
    property string kind: "plain" // "main", "stop"
    property bool tall: false
    enabled: why === ""
    implicitHeight: look.scale * (tall ? 52 : 38)
    readonly property real keyRoom: keyName === "" ? 0 : keyText.implicitWidth + row.spacing
    implicitWidth: Math.max(96, word.implicitWidth + keyRoom + 32)
    focusPolicy: Qt.StrongFocus
    hoverEnabled: true
    font.family: look.family
    font.pixelSize: look.scale * (tall ? 17 : 14)
    font.weight: kind === "plain" ? Font.Medium : Font.DemiBold
    Accessible.role: Accessible.Button
    Accessible.name: text
    Accessible.description: why
    Keys.onReturnPressed: clicked()

    readonly property color base: kind === "main" ? look.accent : kind === "stop" ? (look.dark ? "#c9481a" : "#c04a00") : look.raised
    readonly property color ink: kind === "main" ? look.onAccent : kind === "stop" ? "#ffffff" : look.text

    background: Rectangle {
        radius: 7
        color: button.down ? Qt.darker(button.base, 1.15) : button.hovered && button.enabled ? Qt.lighter(button.base, look.dark ? 1.15 : 1.03) : button.base
        opacity: button.enabled ? 1 : 0.45
        border.width: button.visualFocus ? 2 : 1
        border.color: button.visualFocus ? look.accent : button.kind === "plain" ? look.edge : "transparent"
        Rectangle { // the focus of a filled button
            anchors.fill: parent
            anchors.margins: -4
            radius: 10
            color: "transparent"
            border.width: 2
            border.color: look.accent
            visible: button.visualFocus && button.kind !== "plain"
        }
    }
    contentItem: Item {
        implicitWidth: row.implicitWidth
        implicitHeight: row.implicitHeight
        Row {
            id: row
            anchors.centerIn: parent
            spacing: 10
            Text {
                textFormat: Text.PlainText
                id: word
                text: button.text
                font: button.font
                color: button.ink
                opacity: button.enabled ? 1 : 0.5
            }
            Text {
                textFormat: Text.PlainText
                id: keyText
                anchors.verticalCenter: parent.verticalCenter
                visible: button.keyName !== "" && word.implicitWidth + button.keyRoom + 12 <= button.width
                text: button.keyName
                font.family: look.family
                font.pixelSize: look.scale * 11
                color: button.ink
                opacity: button.enabled ? 0.62 : 0.35
            }
        }
    }
}
