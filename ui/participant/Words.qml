import QtQuick

// Text as the participant's window sets it.
Text {
    textFormat: Text.PlainText
    property bool quiet: false
    color: quiet ? look.dim : look.text
    font.family: look.family
    font.pixelSize: look.scale * 18
    wrapMode: Text.WordWrap
    Accessible.role: Accessible.StaticText
    Accessible.name: text
}
