import QtQuick

// A measured number with its name and unit.
Column {
    property string name
    property string value
    property string unit
    spacing: 1
    Say {
        text: parent.name
        quiet: true
        font.pixelSize: look.scale * 12
    }
    Row {
        spacing: 5
        Say {
            text: parent.parent.value
            font.family: look.digits
            font.pixelSize: look.scale * 19
        }
        Say {
            anchors.baseline: parent.children[0].baseline
            text: parent.parent.unit
            quiet: true
            font.pixelSize: look.scale * 12
        }
    }
}
