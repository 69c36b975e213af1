import QtQuick

// Labelled answers, one of which is picked: side by side where they are short, large cards for a pair or a decision.
Grid {
    id: grid
    required property var row
    property bool cards: false
    property int current: -1 // where keys are
    signal picked(int label)
    readonly property int count: row.labels.length
    readonly property bool across: cards ? width > 560 : row.beside && width > 420
    columns: across ? Math.max(1, count) : 1
    spacing: cards ? 20 : 8
    readonly property real cell: (width - (columns - 1) * spacing) / columns

    Repeater {
        model: grid.count
        Rectangle {
            id: option
            required property int index
            readonly property bool on: grid.row.picked === index
            objectName: "label" + index
            width: grid.cell
            height: grid.cards ? Math.max(96, words.implicitHeight + 48) : Math.max(44, words.implicitHeight + 18)
            radius: grid.cards ? 14 : 9
            color: on ? look.accent : area.containsMouse ? look.raised : look.panel
            border.width: on ? 0 : grid.cards ? 2 : 1
            border.color: area.containsMouse ? look.accent : look.edge
            Accessible.role: Accessible.RadioButton
            Accessible.name: words.text
            Accessible.checked: on
            Accessible.onPressAction: grid.picked(index)
            Text {
                textFormat: Text.PlainText
                id: words
                anchors.verticalCenter: parent.verticalCenter
                x: grid.cards ? 24 : 10
                width: parent.width - 2 * x
                text: grid.row.labels[option.index] ?? ""
                wrapMode: Text.WordWrap
                horizontalAlignment: grid.across ? Text.AlignHCenter : Text.AlignLeft
                color: option.on ? look.onAccent : look.text
                font.family: look.family
                font.pixelSize: look.scale * (grid.cards ? 21 : 16)
                font.weight: option.on ? Font.DemiBold : Font.Normal
            }
            Text { // the key
                textFormat: Text.PlainText
                anchors.right: parent.right
                anchors.bottom: parent.bottom
                anchors.margins: 10
                visible: grid.cards
                text: option.index + 1
                color: option.on ? look.onAccent : look.dim
                font.family: look.digits
                font.pixelSize: look.scale * 13
            }
            MouseArea {
                id: area
                anchors.fill: parent
                hoverEnabled: true
                onClicked: grid.picked(option.index)
            }
        }
    }
}
