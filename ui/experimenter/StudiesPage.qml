import QtQuick
import QtQuick.Layouts
import "../controls"

// The studies that there are, and what the chosen one consists of.
RowLayout {
    id: page
    readonly property int chosen: studies.chosen
    readonly property var cards: studies.cards
    readonly property var card: cards.length > chosen ? cards[chosen] : null
    property int part: 0
    readonly property string whyNotByHand: whyNotRun !== "" || !card || card.forPeople ? whyNotRun : qsTr("The study has a cue that nothing here can give to a person: watch a simulated participant.")
    readonly property string whyNotRun: !card || !card.sound ? qsTr("The study has problems.") : run.running ? qsTr("A session is running.") : ""
    signal begun
    spacing: 16
    onChosenChanged: if (part === 4)
        part = 0

    Panel {
        title: qsTr("STUDIES")
        extra: page.cards.length
        Layout.preferredWidth: look.scale * 372
        Layout.fillHeight: true
        ListView {
            id: list
            objectName: "studies"
            anchors.fill: parent
            clip: true
            spacing: 8
            model: page.cards
            currentIndex: page.chosen
            activeFocusOnTab: true
            keyNavigationEnabled: true
            onCurrentIndexChanged: if (currentIndex >= 0)
                studies.chosen = currentIndex
            delegate: Rectangle {
                id: cardItem
                required property var modelData
                required property int index
                objectName: "study-" + modelData.name
                width: list.width
                height: words.height + 24
                radius: 8
                color: index === page.chosen ? look.raised : "transparent"
                border.width: index === page.chosen ? (list.activeFocus ? 2 : 1) : 0
                border.color: list.activeFocus ? look.accent : look.edge
                Accessible.role: Accessible.ListItem
                Accessible.name: modelData.title
                Column {
                    id: words
                    anchors.left: parent.left
                    anchors.right: lamp.left
                    anchors.margins: 14
                    y: 12
                    spacing: 4
                    Say {
                        width: parent.width
                        text: cardItem.modelData.title
                        font.pixelSize: look.scale * 15
                        font.weight: Font.DemiBold
                        wrapMode: Text.WordWrap
                    }
                    Say {
                        width: parent.width
                        quiet: true
                        wrapMode: Text.Wrap
                        font.pixelSize: look.scale * 12
                        text: cardItem.modelData.sound ? qsTr("Conditions: %1 · trials: %2 · participants: %3").arg(cardItem.modelData.conditions).arg(cardItem.modelData.trials).arg(cardItem.modelData.participants) : qsTr("Problems: %1").arg(cardItem.modelData.problems.length)
                    }
                }
                Lamp {
                    id: lamp
                    anchors.right: parent.right
                    anchors.rightMargin: 14
                    y: 15
                    tone: !cardItem.modelData.sound ? "bad" : cardItem.modelData.warnings.length > 0 ? "wait" : "good"
                }
                MouseArea {
                    anchors.fill: parent
                    onClicked: {
                        studies.chosen = cardItem.index;
                        list.currentIndex = cardItem.index;
                        list.forceActiveFocus();
                    }
                }
            }
        }
    }

    Panel {
        Layout.fillWidth: true
        Layout.fillHeight: true
        pad: 28
        ColumnLayout {
            anchors.fill: parent
            spacing: 20
            visible: page.card !== null
            RowLayout {
                Layout.fillWidth: true
                spacing: 16
                Column {
                    Layout.fillWidth: true
                    spacing: 6
                    Say {
                        width: parent.width
                        text: page.card ? page.card.title : ""
                        font.pixelSize: look.scale * 28
                        font.weight: Font.DemiBold
                        wrapMode: Text.WordWrap
                    }
                    Say {
                        width: parent.width
                        quiet: true
                        text: page.card && page.card.sound ? qsTr("%1, version %2 · %3").arg(page.card.name).arg(page.card.version).arg(page.card.device) : ""
                    }
                }
                ActionButton {
                    objectName: "reload"
                    Layout.alignment: Qt.AlignTop
                    text: qsTr("Read again")
                    keyName: qsTr("Ctrl+L")
                    onClicked: studies.reload()
                    Shortcut {
                        sequence: "Ctrl+L"
                        enabled: page.visible
                        onActivated: studies.reload()
                    }
                }
            }
            Choice {
                objectName: "part"
                name: qsTr("Part of the study")
                options: [qsTr("Overview"), qsTr("Design"), qsTr("Tick and stiffness"), qsTr("Accuracy"), qsTr("Protocol")]
                chosen: page.part
                onPicked: index => page.part = index
            }
            Item {
                Layout.fillWidth: true
                Layout.fillHeight: true
                StudyOverview {
                    anchors.fill: parent
                    visible: page.part === 0
                    card: page.card
                    onIssueOpened: index => {
                        details.openIssue(index);
                        page.part = 4;
                    }
                }
                DesignView {
                    anchors.fill: parent
                    visible: page.part === 1
                }
                TickView {
                    anchors.fill: parent
                    visible: page.part === 2
                }
                AccuracyView {
                    anchors.fill: parent
                    visible: page.part === 3
                }
                SourceView {
                    anchors.fill: parent
                    visible: page.part === 4
                }
            }
            RowLayout { // accuracy has a command of its own, and needs the room
                spacing: 12
                visible: page.part !== 3
                ActionButton {
                    objectName: "tryOut"
                    kind: "main"
                    tall: true
                    text: qsTr("Try it with the mouse")
                    why: page.whyNotByHand
                    onClicked: {
                        studies.tryOut(page.chosen, false, app.language);
                        page.begun();
                    }
                }
                ActionButton {
                    objectName: "watch"
                    tall: true
                    text: qsTr("Watch a simulated participant")
                    why: page.whyNotRun
                    onClicked: {
                        studies.tryOut(page.chosen, true, app.language);
                        page.begun();
                    }
                }
            }
            ColumnLayout { // below the buttons, where words have the whole width
                spacing: 6
                visible: page.part !== 3
                Say {
                    objectName: "leftOut"
                    Layout.fillWidth: true
                    quiet: true
                    wrapMode: Text.WordWrap
                    font.pixelSize: look.scale * 12
                    text: qsTr("Both show the trials only: consent, instructions and questionnaires are left out.")
                }
                Say {
                    objectName: "whyNotByHand"
                    Layout.fillWidth: true
                    visible: text !== ""
                    quiet: true
                    wrapMode: Text.WordWrap
                    font.pixelSize: look.scale * 12
                    text: page.whyNotByHand
                }
            }
        }
    }
}
