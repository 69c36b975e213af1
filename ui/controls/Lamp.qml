import QtQuick

// A state by colour and, for who cannot tell colours, by its fill: full is good, half is doubtful, a ring is off.
Item {
    property string tone: "rest"
    implicitWidth: 14
    implicitHeight: 14
    readonly property color tint: tone === "good" || tone === "go" ? look.good : tone === "wait" ? look.care : tone === "bad" ? look.bad : look.dim
    Rectangle {
        anchors.fill: parent
        radius: width / 2
        color: "transparent"
        border.width: 2
        border.color: parent.tint
    }
    Rectangle {
        anchors.centerIn: parent
        width: parent.tone === "rest" ? 0 : parent.tone === "wait" ? 6 : 14
        height: width
        radius: parent.tone === "bad" ? 2 : width / 2
        color: parent.tint
    }
}
