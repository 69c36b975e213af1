import QtQuick

// A decision by sign and colour.
Rectangle {
    id: mark
    property string sign
    property string tone: "rest"
    readonly property color tint: tone === "good" ? look.good : tone === "wait" ? look.care : tone === "bad" ? look.bad : look.dim
    implicitWidth: look.scale * 20
    implicitHeight: look.scale * 20
    radius: 5
    color: "transparent"
    border.width: 1
    border.color: tint
    Say {
        anchors.centerIn: parent
        text: mark.sign
        color: mark.tint
        font.pixelSize: look.scale * 12
        font.weight: Font.DemiBold
        Accessible.ignored: true
    }
}
