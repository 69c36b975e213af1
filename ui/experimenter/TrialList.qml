import QtQuick
import "../controls"

// The trials of a session, a line each.
ListView {
    id: trials
    objectName: "trials"
    clip: true
    activeFocusOnTab: true
    model: run.rows
    Accessible.role: Accessible.List
    Accessible.name: qsTr("Trials")
    onModelChanged: Qt.callLater(() => positionViewAtIndex(Math.max(0, run.currentRow), ListView.Contain))
    delegate: Rectangle {
        id: trial
        required property var modelData
        width: trials.width
        height: Math.max(look.scale * 42, words.height + 10)
        radius: 6
        color: modelData.tone === "go" ? look.raised : "transparent"
        readonly property color tint: modelData.tone === "good" ? look.good : modelData.tone === "bad" ? look.bad : modelData.tone === "wait" ? look.care : modelData.tone === "go" ? look.accent : look.dim
        Accessible.role: Accessible.ListItem
        Accessible.name: modelData.number + " " + modelData.condition + " " + modelData.word
        Say {
            x: 6
            width: 26
            anchors.verticalCenter: parent.verticalCenter
            horizontalAlignment: Text.AlignRight
            text: trial.modelData.number
            quiet: true
            font.family: look.digits
            font.pixelSize: look.scale * 13
        }
        Say {
            x: 38
            width: 20
            anchors.verticalCenter: parent.verticalCenter
            horizontalAlignment: Text.AlignHCenter
            text: trial.modelData.sign
            color: trial.tint
            font.pixelSize: look.scale * 15
        }
        Column {
            id: words
            x: 66
            width: trial.width - x - time.width - 12
            anchors.verticalCenter: parent.verticalCenter
            Say {
                width: parent.width
                text: trial.modelData.condition
                wrapMode: Text.Wrap
                font.pixelSize: look.scale * 13
            }
            Say {
                width: parent.width
                quiet: true
                font.pixelSize: look.scale * 11
                text: trial.modelData.phase + " · " + trial.modelData.word + (trial.modelData.attempts > 1 ? " · " + qsTr("Attempts: %1").arg(trial.modelData.attempts) : "")
            }
        }
        Say {
            id: time
            anchors.right: parent.right
            anchors.rightMargin: 6
            anchors.verticalCenter: parent.verticalCenter
            quiet: true
            font.family: look.digits
            font.pixelSize: look.scale * 13
            text: trial.modelData.seconds >= 0 ? trial.modelData.seconds.toFixed(1) + " s" : ""
        }
    }
}
