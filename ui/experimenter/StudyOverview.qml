import QtQuick
import QtQuick.Layouts
import "../controls"

// What a study consists of, what is wrong with it, and whether this machine keeps up.
Flickable {
    id: view
    property var card
    signal issueOpened(int index)
    contentHeight: sheet.height
    clip: true
    Column {
        id: sheet
        width: view.width
        spacing: 24
        Row {
            visible: view.card && view.card.sound
            spacing: 44
            Figure {
                name: qsTr("Conditions")
                value: view.card ? view.card.conditions : ""
            }
            Figure {
                name: qsTr("Trials")
                value: view.card ? view.card.trials : ""
                unit: view.card && view.card.sessions > 1 ? qsTr("in the first of %1 sessions").arg(view.card.sessions) : ""
            }
            Figure {
                name: qsTr("About")
                value: view.card ? view.card.minutes : ""
                unit: qsTr("min")
            }
            Figure {
                name: qsTr("Participants")
                value: view.card ? view.card.participants : ""
            }
        }
        Column {
            width: parent.width
            spacing: 8
            Heading {
                text: qsTr("CHECKS")
            }
            RowLayout {
                visible: view.card && view.card.sound && details.issues.length === 0
                spacing: 10
                Lamp {
                    tone: "good"
                }
                Say {
                    text: qsTr("The protocol is sound.")
                }
            }
            Repeater {
                model: details.issues
                IssueRow {
                    required property var modelData
                    required property int index
                    objectName: "issue-" + index
                    width: sheet.width
                    message: modelData.text
                    place: modelData.place
                    tone: modelData.tone
                    onClicked: view.issueOpened(index)
                }
            }
            RowLayout {
                width: parent.width
                spacing: 10
                Lamp {
                    tone: details.loop.tone
                }
                Say {
                    Layout.fillWidth: true
                    objectName: "loopLine"
                    wrapMode: Text.WordWrap
                    text: details.loop.checking ? qsTr("The loop runs for ten seconds …") : details.loop.known ? qsTr("Loop on this machine: %1").arg(details.loop.verdict) : qsTr("Whether this machine keeps 1 kHz has not been checked.")
                }
                ActionButton {
                    objectName: "checkLoop"
                    text: qsTr("Check the loop")
                    why: details.loop.why
                    onClicked: details.checkLoop()
                }
            }
            Row {
                visible: details.loop.known
                spacing: 36
                Repeater {
                    model: details.loop.known ? [[qsTr("Cycle late by, median"), details.loop.p50], ["99 %", details.loop.p99], ["99.9 %", details.loop.p999], [qsTr("worst"), details.loop.most]] : []
                    Figure {
                        required property var modelData
                        name: modelData[0]
                        value: Number(modelData[1]).toFixed(modelData[1] < 10 ? 1 : 0)
                        unit: "µs"
                    }
                }
                Figure {
                    name: qsTr("Cycles missed")
                    value: details.loop.known ? details.loop.missed : ""
                    unit: details.loop.known ? qsTr("of %1").arg(details.loop.ticks + details.loop.missed) : ""
                }
            }
        }
        Column {
            visible: view.card && view.card.factors.length > 0
            width: parent.width
            spacing: 12
            Heading {
                text: qsTr("WHAT IS VARIED")
            }
            Repeater {
                model: view.card ? view.card.factors : []
                RowLayout {
                    id: factorRow
                    required property var modelData
                    width: sheet.width
                    spacing: 8
                    Say {
                        Layout.preferredWidth: look.scale * 170
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
            visible: view.card && view.card.questionnaires.length > 0
            width: parent.width
            spacing: 12
            Heading {
                text: qsTr("WHAT IS ASKED")
            }
            Flow {
                width: parent.width
                spacing: 8
                Repeater {
                    model: view.card ? view.card.questionnaires : []
                    Chip {
                        required property string modelData
                        text: modelData
                    }
                }
            }
        }
    }
}
