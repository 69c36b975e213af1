import QtQuick
import "../controls"

// The participants, a line each.
Item {
    id: roll
    readonly property var widths: [92, 84, 170, 96, 84].map(w => look.scale * w) // code, kind, sessions, consent, place
    Row {
        id: head
        x: 30
        visible: participants.people.length > 0
        Repeater {
            model: [qsTr("Code"), qsTr("Kind"), qsTr("Sessions"), qsTr("Consent"), qsTr("Place"), qsTr("State")]
            Say {
                required property string modelData
                required property int index
                width: index < roll.widths.length ? roll.widths[index] : 200
                quiet: true
                font.pixelSize: look.scale * 12
                text: modelData
            }
        }
    }
    ListView {
        id: list
        objectName: "participants"
        anchors.fill: parent
        anchors.topMargin: look.scale * 24
        anchors.leftMargin: -6
        anchors.rightMargin: -6
        clip: true
        activeFocusOnTab: true
        keyNavigationEnabled: true
        model: participants.people
        Accessible.role: Accessible.List
        Accessible.name: qsTr("Participants")
        onModelChanged: currentIndex = participants.people.findIndex(p => p.code === participants.selected)
        Keys.onUpPressed: pick(Math.max(0, currentIndex - 1))
        Keys.onDownPressed: pick(Math.min(count - 1, currentIndex + 1))
        function pick(index) {
            if (index < 0 || index >= count)
                return;
            participants.selected = participants.people[index].code;
            forceActiveFocus();
        }
        delegate: Rectangle {
            id: line
            required property var modelData
            required property int index
            readonly property bool chosen: modelData.code === participants.selected
            objectName: "person-" + modelData.code
            width: list.width
            height: look.scale * 40
            radius: 6
            color: chosen ? look.raised : "transparent"
            border.width: chosen && list.activeFocus ? 2 : 0
            border.color: look.accent
            opacity: modelData.takesPart ? 1 : 0.6
            Accessible.role: Accessible.ListItem
            Accessible.name: [modelData.code, modelData.kind, modelData.standing, qsTr("%1 of %2 sessions").arg(modelData.complete).arg(modelData.of)].join(", ")
            Lamp {
                x: 10
                anchors.verticalCenter: parent.verticalCenter
                tone: !line.modelData.takesPart ? "bad" : line.modelData.complete >= line.modelData.of ? "good" : line.modelData.interrupted > 0 ? "wait" : "rest"
            }
            Row {
                x: 36
                Say {
                    width: roll.widths[0]
                    height: line.height
                    verticalAlignment: Text.AlignVCenter
                    text: line.modelData.code
                    font.family: look.digits
                    font.pixelSize: look.scale * 15
                    font.weight: Font.DemiBold
                }
                Say {
                    width: roll.widths[1]
                    height: line.height
                    verticalAlignment: Text.AlignVCenter
                    text: line.modelData.kind
                    font.pixelSize: look.scale * 13
                }
                Say {
                    width: roll.widths[2]
                    height: line.height
                    verticalAlignment: Text.AlignVCenter
                    font.pixelSize: look.scale * 13
                    text: qsTr("%1 of %2").arg(line.modelData.complete).arg(line.modelData.of) + (line.modelData.interrupted > 0 ? " · " + qsTr("%1 broken off").arg(line.modelData.interrupted) : "")
                }
                Row {
                    width: roll.widths[3]
                    anchors.verticalCenter: parent.verticalCenter
                    spacing: 4
                    Repeater {
                        model: line.modelData.consent
                        Mark {
                            required property var modelData
                            sign: modelData.sign
                            tone: modelData.tone
                        }
                    }
                    Say {
                        visible: line.modelData.consent.length === 0
                        quiet: true
                        text: "–"
                    }
                }
                Say {
                    width: roll.widths[4]
                    height: line.height
                    verticalAlignment: Text.AlignVCenter
                    font.pixelSize: look.scale * 13
                    font.family: look.digits
                    quiet: line.modelData.place === ""
                    text: line.modelData.place === "" ? "–" : line.modelData.place
                }
                Say {
                    width: Math.max(0, line.width - 46 - roll.widths.reduce((sum, w) => sum + w, 0))
                    height: line.height
                    verticalAlignment: Text.AlignVCenter
                    font.pixelSize: look.scale * 13
                    quiet: true
                    text: line.modelData.standing + (!line.modelData.takesPart && line.modelData.reason !== "" ? " · " + line.modelData.reason : "")
                }
            }
            MouseArea {
                anchors.fill: parent
                onClicked: list.pick(line.index)
            }
        }
    }
    Say {
        objectName: "nobody"
        anchors.centerIn: parent
        visible: participants.known && participants.people.length === 0
        quiet: true
        font.pixelSize: look.scale * 16
        text: qsTr("Nobody is enrolled yet.")
    }
}
