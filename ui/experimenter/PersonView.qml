import QtQuick
import QtQuick.Layouts
import "../controls"

// The selected participant: what they did and agreed to, and what may be done now.
Item {
    id: view
    signal begun
    readonly property var who: participants.person
    readonly property bool there: who.code !== undefined

    Say {
        anchors.centerIn: parent
        visible: !view.there
        quiet: true
        width: parent.width
        horizontalAlignment: Text.AlignHCenter
        wrapMode: Text.WordWrap
        text: qsTr("Choose a participant to see sessions and consent.")
    }
    Flickable {
        anchors.fill: parent
        anchors.bottomMargin: actions.height + 16
        visible: view.there
        contentHeight: sheet.height
        clip: true
        Column {
            id: sheet
            width: parent.width
            spacing: 18
            Column {
                width: parent.width
                spacing: 4
                Say {
                    objectName: "personCode"
                    text: view.there ? view.who.code : ""
                    font.family: look.digits
                    font.pixelSize: look.scale * 30
                    font.weight: Font.DemiBold
                }
                Say {
                    width: parent.width
                    quiet: true
                    wrapMode: Text.WordWrap
                    text: view.there ? [view.who.kind, view.who.standing, qsTr("enrolled %1").arg(view.who.enrolled)].join(" · ") : ""
                }
                Say {
                    width: parent.width
                    visible: view.there && !view.who.takesPart && view.who.reason !== ""
                    quiet: true
                    wrapMode: Text.WordWrap
                    text: view.there ? view.who.reason : ""
                }
            }
            Column {
                width: parent.width
                spacing: 8
                Heading {
                    text: qsTr("SESSIONS")
                }
                Repeater {
                    model: view.there ? view.who.sessions : []
                    RowLayout {
                        id: session
                        required property var modelData
                        width: sheet.width
                        spacing: 10
                        Lamp {
                            tone: session.modelData.tone
                        }
                        Say {
                            text: qsTr("Session %1").arg(session.modelData.name)
                        }
                        Say {
                            Layout.fillWidth: true
                            quiet: true
                            font.pixelSize: look.scale * 12
                            text: session.modelData.word + " · " + session.modelData.date
                        }
                        Say {
                            font.family: look.digits
                            font.pixelSize: look.scale * 13
                            text: session.modelData.trials
                            Accessible.name: qsTr("valid attempts of planned trials: %1").arg(text)
                        }
                    }
                }
                Say {
                    visible: view.there && view.who.sessions.length === 0
                    quiet: true
                    text: qsTr("none yet")
                }
            }
            Column {
                width: parent.width
                spacing: 10
                visible: participants.clauses.length > 0
                Heading {
                    text: qsTr("CONSENT")
                }
                Repeater {
                    model: view.there ? view.who.consent : []
                    ColumnLayout {
                        id: clause
                        required property var modelData
                        required property int index
                        width: sheet.width
                        spacing: 6
                        RowLayout {
                            Layout.fillWidth: true
                            spacing: 10
                            Mark {
                                sign: clause.modelData.sign
                                tone: clause.modelData.tone
                            }
                            Say {
                                Layout.fillWidth: true
                                text: participants.clauses[clause.index]
                            }
                            Say {
                                quiet: true
                                font.pixelSize: look.scale * 12
                                text: clause.modelData.word
                            }
                        }
                        RowLayout {
                            visible: view.there && view.who.takesPart
                            spacing: 6
                            Repeater {
                                model: [["yes", qsTr("Agreed")], ["no", qsTr("Declined")], ["withdrawn", qsTr("Withdrawn")]]
                                ActionButton {
                                    required property var modelData
                                    implicitHeight: look.scale * 30
                                    font.pixelSize: look.scale * 12
                                    text: modelData[1]
                                    objectName: "consent-" + clause.index + "-" + modelData[0]
                                    Accessible.name: participants.clauses[clause.index] + ": " + text
                                    why: run.running ? qsTr("A session is running.") : participants.busy ? qsTr("Reading …") : ""
                                    onClicked: participants.decide(clause.index, modelData[0])
                                }
                            }
                        }
                    }
                }
                Say {
                    width: parent.width
                    quiet: true
                    font.pixelSize: look.scale * 12
                    wrapMode: Text.WordWrap
                    visible: view.there && view.who.takesPart
                    text: qsTr("Record here what was signed on paper; who has not been asked is asked when the session begins.")
                }
            }
            Column {
                width: parent.width
                spacing: 10
                visible: view.there && view.who.excluded
                Heading {
                    text: qsTr("TAKE BACK THE EXCLUSION")
                }
                RowLayout {
                    width: parent.width
                    spacing: 8
                    TextBox {
                        id: reason
                        objectName: "readmitReason"
                        Layout.fillWidth: true
                        placeholderText: qsTr("Reason")
                    }
                    ActionButton {
                        objectName: "readmit"
                        text: qsTr("Readmit")
                        why: (participants.person, participants.whyNotReadmit(reason.text))
                        onClicked: {
                            participants.readmit(reason.text);
                            reason.clear();
                        }
                    }
                }
            }
        }
    }
    ColumnLayout {
        id: actions
        anchors.left: parent.left
        anchors.right: parent.right
        anchors.bottom: parent.bottom
        visible: view.there
        spacing: 8
        Say {
            Layout.fillWidth: true
            visible: text !== ""
            quiet: true
            font.pixelSize: look.scale * 12
            wrapMode: Text.WordWrap
            text: view.there ? (view.who.canResume ? view.who.whyNotResume : view.who.whyNotStart) : ""
        }
        ActionButton {
            objectName: "resume"
            Layout.fillWidth: true
            visible: view.there && view.who.canResume
            tall: true
            kind: "main"
            text: qsTr("Resume the session")
            why: view.there ? view.who.whyNotResume : ""
            onClicked: if (participants.start(true, app.language))
                view.begun()
        }
        ActionButton {
            objectName: "startSession"
            Layout.fillWidth: true
            tall: !view.there || !view.who.canResume
            kind: tall ? "main" : "plain"
            text: view.there && view.who.canResume ? qsTr("Start a new session instead") : qsTr("Start the session")
            why: view.there ? view.who.whyNotStart : ""
            onClicked: if (participants.start(false, app.language))
                view.begun()
        }
        ActionButton {
            objectName: "leave"
            Layout.fillWidth: true
            text: qsTr("End their part …")
            why: run.running ? qsTr("A session is running.") : ""
            onClicked: participants.openLeaving()
        }
    }
}
