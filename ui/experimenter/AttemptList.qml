import QtQuick
import "../controls"

// The attempts of the selected session; one that is opened is shown again.
ListView {
    id: list
    objectName: "attempts"
    clip: true
    activeFocusOnTab: true
    keyNavigationEnabled: true
    Keys.onReturnPressed: records.showAgain(currentIndex)
    model: records.attempts
    Accessible.role: Accessible.List
    Accessible.name: qsTr("Attempts")
    delegate: Rectangle {
        id: line
        required property var modelData
        required property int index
        objectName: "attempt-" + index
        width: list.width
        height: Math.max(look.scale * 40, words.height + 10)
        radius: 6
        color: ListView.isCurrentItem ? look.raised : "transparent"
        border.width: ListView.isCurrentItem && list.activeFocus ? 2 : 0
        border.color: look.accent
        readonly property color tint: modelData.tone === "good" ? look.good : modelData.tone === "wait" ? look.care : look.bad
        Accessible.role: Accessible.ListItem
        Accessible.name: modelData.trial + " " + modelData.condition + " " + modelData.word
        Say {
            x: 2
            width: 30
            anchors.verticalCenter: parent.verticalCenter
            horizontalAlignment: Text.AlignRight
            quiet: true
            font.family: look.digits
            font.pixelSize: look.scale * 13
            text: line.modelData.trial
        }
        Rectangle {
            x: 42
            width: 4
            height: look.scale * 24
            radius: 2
            anchors.verticalCenter: parent.verticalCenter
            color: line.tint
        }
        Column {
            id: words
            x: 56
            width: line.width - x - time.width - 14
            anchors.verticalCenter: parent.verticalCenter
            Say {
                width: parent.width
                font.pixelSize: look.scale * 13
                wrapMode: Text.Wrap
                text: line.modelData.condition
            }
            Say {
                width: parent.width
                quiet: true
                font.pixelSize: look.scale * 11
                wrapMode: Text.Wrap
                text: [line.modelData.block, line.modelData.attempt > 1 ? qsTr("attempt %1").arg(line.modelData.attempt) : "", line.modelData.word, line.modelData.reason].filter(s => s !== "").join(" · ")
            }
        }
        Say {
            id: time
            anchors.right: parent.right
            anchors.rightMargin: 8
            anchors.verticalCenter: parent.verticalCenter
            quiet: true
            font.family: look.digits
            font.pixelSize: look.scale * 13
            text: line.modelData.seconds >= 0 ? line.modelData.seconds.toFixed(1) + " s" : ""
        }
        MouseArea {
            anchors.fill: parent
            onClicked: {
                list.currentIndex = line.index;
                list.forceActiveFocus();
            }
            onDoubleClicked: records.showAgain(line.index)
        }
    }
}
