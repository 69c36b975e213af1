import QtQuick

// The name of a section.
Say {
    quiet: true
    font.pixelSize: look.scale * 12
    font.weight: Font.DemiBold
    font.letterSpacing: 0.4
    Accessible.role: Accessible.Heading
}
