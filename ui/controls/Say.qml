import QtQuick

// Text as the console sets it.
Text {
    textFormat: Text.PlainText
    property bool quiet: false
    color: quiet ? look.dim : look.text
    font.family: look.family
    font.pixelSize: look.scale * 14
    elide: Text.ElideRight
    Accessible.role: Accessible.StaticText
    Accessible.name: text
}
