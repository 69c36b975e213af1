import QtQuick
import QtQuick.Layouts

// The studies that there are, and what the chosen one consists of.
RowLayout {
    id: page
    property int chosen: 0
    readonly property var cards: studies.cards
    readonly property var card: cards.length > chosen ? cards[chosen] : null
    signal begun
    spacing: 16

    Panel {
        title: qsTr("STUDIES")
        extra: page.cards.length
        Layout.preferredWidth: 372
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
                page.chosen = currentIndex
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
                        font.pixelSize: 15
                        font.weight: Font.DemiBold
                        wrapMode: Text.WordWrap
                    }
                    Say {
                        width: parent.width
                        quiet: true
                        font.pixelSize: 12
                        text: cardItem.modelData.sound ? qsTr("%1 conditions · %2 trials · %3 participants").arg(cardItem.modelData.conditions).arg(cardItem.modelData.trials).arg(cardItem.modelData.participants) : qsTr("Problems: %1").arg(cardItem.modelData.problems.length)
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
                        page.chosen = cardItem.index;
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
        Flickable {
            anchors.fill: parent
            anchors.bottomMargin: actions.height + 24
            contentHeight: sheet.height
            clip: true
            visible: page.card !== null
            Column {
                id: sheet
                width: parent.width
                spacing: 22
                Column {
                    width: parent.width
                    spacing: 6
                    Say {
                        width: parent.width
                        text: page.card ? page.card.title : ""
                        font.pixelSize: 28
                        font.weight: Font.DemiBold
                        wrapMode: Text.WordWrap
                    }
                    Say {
                        width: parent.width
                        quiet: true
                        text: page.card && page.card.sound ? qsTr("%1, version %2 · %3").arg(page.card.name).arg(page.card.version).arg(page.card.device) : ""
                    }
                }
                Row {
                    visible: page.card && page.card.sound
                    spacing: 44
                    Figure {
                        name: qsTr("Conditions")
                        value: page.card ? page.card.conditions : ""
                    }
                    Figure {
                        name: qsTr("Trials")
                        value: page.card ? page.card.trials : ""
                        unit: page.card && page.card.sessions > 1 ? qsTr("in the first of %1 sessions").arg(page.card.sessions) : ""
                    }
                    Figure {
                        name: qsTr("At most")
                        value: page.card ? page.card.minutes : ""
                        unit: qsTr("min")
                    }
                    Figure {
                        name: qsTr("Participants")
                        value: page.card ? page.card.participants : ""
                    }
                }
                Column {
                    visible: page.card && page.card.factors.length > 0
                    width: parent.width
                    spacing: 12
                    Say {
                        text: qsTr("WHAT IS VARIED")
                        quiet: true
                        font.pixelSize: 12
                        font.weight: Font.DemiBold
                        font.letterSpacing: 0.4
                    }
                    Repeater {
                        model: page.card ? page.card.factors : []
                        RowLayout {
                            id: factorRow
                            required property var modelData
                            width: sheet.width
                            spacing: 8
                            Say {
                                Layout.preferredWidth: 170
                                Layout.alignment: Qt.AlignTop
                                Layout.topMargin: 4
                                text: factorRow.modelData.name
                            }
                            Flow {
                                Layout.fillWidth: true
                                spacing: 8
                                Repeater {
                                    model: factorRow.modelData.levels
                                    Chip {
                                        required property string modelData
                                        text: modelData
                                    }
                                }
                            }
                        }
                    }
                }
                Column {
                    visible: page.card && page.card.questionnaires.length > 0
                    width: parent.width
                    spacing: 12
                    Say {
                        text: qsTr("WHAT IS ASKED")
                        quiet: true
                        font.pixelSize: 12
                        font.weight: Font.DemiBold
                        font.letterSpacing: 0.4
                    }
                    Flow {
                        width: parent.width
                        spacing: 8
                        Repeater {
                            model: page.card ? page.card.questionnaires : []
                            Chip {
                                required property string modelData
                                text: modelData
                            }
                        }
                    }
                }
                Repeater { // what is wrong, and what should be known
                    model: page.card ? page.card.problems.concat(page.card.warnings) : []
                    RowLayout {
                        required property string modelData
                        required property int index
                        width: sheet.width
                        spacing: 10
                        Lamp {
                            Layout.alignment: Qt.AlignTop
                            Layout.topMargin: 3
                            tone: parent.index < page.card.problems.length ? "bad" : "wait"
                        }
                        Say {
                            Layout.fillWidth: true
                            text: parent.modelData
                            wrapMode: Text.WordWrap
                        }
                    }
                }
            }
        }
        Row {
            id: actions
            anchors.bottom: parent.bottom
            spacing: 12
            ActionButton {
                objectName: "tryOut"
                kind: "main"
                tall: true
                text: qsTr("Try it with the mouse")
                why: !page.card || !page.card.sound ? qsTr("The study has problems.") : run.running ? qsTr("A session is running.") : ""
                onClicked: {
                    studies.tryOut(page.chosen, false);
                    page.begun();
                }
            }
            ActionButton {
                objectName: "watch"
                tall: true
                text: qsTr("Watch a simulated participant")
                why: !page.card || !page.card.sound ? qsTr("The study has problems.") : run.running ? qsTr("A session is running.") : ""
                onClicked: {
                    studies.tryOut(page.chosen, true);
                    page.begun();
                }
            }
        }
    }
}
