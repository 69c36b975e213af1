import QtQuick
import QtQuick.Layouts
import "../controls"

// How far each step of a running assembly is; of many those about the first that is not done.
ListView {
    id: list
    clip: true
    spacing: 6
    boundsBehavior: Flickable.StopAtBounds
    model: run.steps
    currentIndex: run.steps.findIndex(step => step.tone !== "good")
    highlightRangeMode: ListView.ApplyRange
    preferredHighlightBegin: 0
    preferredHighlightEnd: height / 2
    delegate: RowLayout {
        id: line
        required property var modelData
        width: list.width
        spacing: 8
        Say {
            Layout.fillWidth: true
            elide: Text.ElideRight
            text: line.modelData.name
            quiet: line.modelData.tone === "good"
            font.pixelSize: look.scale * 13
        }
        Say {
            text: line.modelData.word
            color: line.modelData.tone === "go" ? look.accent : line.modelData.tone === "good" ? look.good : look.dim
            font.pixelSize: look.scale * 13
        }
    }
}
