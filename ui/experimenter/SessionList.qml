import QtQuick
import "../controls"

// The sessions of a database.
ListView {
    id: list
    objectName: "sessions"
    clip: true
    activeFocusOnTab: true
    model: records.sessions
    Accessible.role: Accessible.List
    Accessible.name: qsTr("Sessions")
    onModelChanged: currentIndex = records.sessions.findIndex(s => s.id === records.session)
    Keys.onUpPressed: pick(Math.max(0, currentIndex - 1))
    Keys.onDownPressed: pick(Math.min(count - 1, currentIndex + 1))
    function pick(index) {
        if (index < 0 || index >= count)
            return;
        records.session = records.sessions[index].id;
        forceActiveFocus();
    }
    delegate: Rectangle {
        id: line
        required property var modelData
        required property int index
        readonly property bool chosen: modelData.id === records.session
        objectName: "session-" + modelData.participant + "-" + modelData.ordinal
        width: list.width
        height: Math.max(look.scale * 46, words.height + 10)
        radius: 6
        color: chosen ? look.raised : "transparent"
        border.width: chosen && list.activeFocus ? 2 : 0
        border.color: look.accent
        Accessible.role: Accessible.ListItem
        Accessible.name: [modelData.participant, modelData.kind, qsTr("Session %1").arg(modelData.ordinal), modelData.word].join(", ")
        Lamp {
            x: 8
            anchors.verticalCenter: parent.verticalCenter
            tone: line.modelData.tone
        }
        Column {
            id: words
            x: 34
            width: line.width - x - trials.width - 18
            anchors.verticalCenter: parent.verticalCenter
            Say {
                width: parent.width
                text: line.modelData.participant + "  ·  " + qsTr("Session %1").arg(line.modelData.ordinal)
                font.weight: Font.Medium
            }
            Say {
                width: parent.width
                quiet: true
                font.pixelSize: look.scale * 11
                wrapMode: Text.Wrap
                text: [line.modelData.kind, line.modelData.word, line.modelData.date].filter(s => s !== "").join(" · ")
            }
        }
        Say {
            id: trials
            anchors.right: parent.right
            anchors.rightMargin: 8
            anchors.verticalCenter: parent.verticalCenter
            quiet: true
            font.family: look.digits
            font.pixelSize: look.scale * 13
            text: line.modelData.trials
        }
        MouseArea {
            anchors.fill: parent
            onClicked: list.pick(line.index)
        }
    }
}
