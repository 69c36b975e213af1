import QtQuick

// The steps of an assembly: a tick for what is done, an arrow for what may be next, a bar beside what a hint leads to. Of
// many those about the first that is not done.
Rectangle {
    id: list
    required property var steps // "name", "done", "next", "hinted"
    property string heading
    property int most: 12
    readonly property int open: steps.findIndex(step => !step.done)
    readonly property int first: Math.max(0, Math.min(steps.length - most, (open < 0 ? steps.length : open) - 2))

    width: Math.min(look.scale * 260, lines.implicitWidth + 28)
    height: lines.implicitHeight + 22
    radius: 10
    color: look.veil

    Column {
        id: lines
        x: 14
        y: 11
        spacing: 4
        Text {
            textFormat: Text.PlainText
            visible: text !== ""
            text: list.heading
            color: look.dim
            font.family: look.family
            font.pixelSize: look.scale * 14
            font.weight: Font.DemiBold
        }
        Repeater {
            model: list.steps.slice(list.first, list.first + list.most)
            Row {
                id: line
                required property var modelData
                spacing: 8
                Rectangle {
                    objectName: "hint"
                    visible: line.modelData.hinted === true
                    width: look.scale * 4
                    height: look.scale * 18
                    radius: 2
                    color: look.accent
                }
                Text {
                    textFormat: Text.PlainText
                    width: look.scale * 16
                    text: line.modelData.done ? "✓" : line.modelData.next ? "▸" : "·"
                    color: line.modelData.done ? look.good : line.modelData.next ? look.accent : look.dim
                    font.family: look.family
                    font.pixelSize: look.scale * 15
                    font.weight: Font.DemiBold
                }
                Text {
                    textFormat: Text.PlainText
                    width: Math.min(implicitWidth, look.scale * 205)
                    elide: Text.ElideRight
                    text: line.modelData.name
                    color: line.modelData.hinted === true ? look.accent : line.modelData.next ? look.text : look.dim
                    font.family: look.family
                    font.pixelSize: look.scale * 15
                    font.weight: line.modelData.next ? Font.DemiBold : Font.Normal
                    Accessible.role: Accessible.StaticText
                    Accessible.name: text
                }
            }
        }
    }
}
