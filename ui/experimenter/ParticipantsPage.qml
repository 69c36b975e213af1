import QtQuick
import QtQuick.Layouts
import "../controls"

// Who takes part in the chosen study: places, sessions, consent; enrolling, starting, leaving.
ColumnLayout {
    id: page
    signal begun
    spacing: 16

    StudyBar {
        Layout.fillWidth: true
        told: participants.told
        failed: participants.failed
        Say {
            anchors.verticalCenter: parent.verticalCenter
            quiet: true
            text: qsTr("Experimenter")
            Accessible.ignored: true
        }
        TextBox {
            objectName: "experimenter"
            implicitWidth: look.scale * 130
            placeholderText: qsTr("Initials")
            Accessible.name: qsTr("Experimenter (initials)")
            text: participants.experimenter
            maximumLength: 40
            onTextEdited: participants.experimenter = text
        }
    }

    RowLayout {
        Layout.fillWidth: true
        Layout.fillHeight: true
        spacing: 16
        ColumnLayout {
            Layout.fillWidth: true
            Layout.fillHeight: true
            spacing: 16
            Panel {
                title: qsTr("PARTICIPANTS")
                extra: participants.people.length
                Layout.fillWidth: true
                Layout.fillHeight: true
                ParticipantList {
                    anchors.fill: parent
                    anchors.bottomMargin: enrolment.height + 12
                }
                Enrolment {
                    id: enrolment
                    anchors.left: parent.left
                    anchors.right: parent.right
                    anchors.bottom: parent.bottom
                }
            }
            Panel {
                title: qsTr("PLACES IN THE DESIGN")
                extra: qsTr("%1 of %2 taken").arg(participants.places.filter(p => p.owner !== "").length).arg(participants.places.length)
                Layout.fillWidth: true
                Layout.preferredHeight: look.scale * 178
                PlacesView {
                    anchors.fill: parent
                }
            }
        }
        Panel {
            Layout.preferredWidth: look.scale * 420
            Layout.maximumWidth: look.scale * 420
            Layout.fillHeight: true
            pad: 22
            PersonView {
                anchors.fill: parent
                visible: !participants.leaving.open
                onBegun: page.begun()
            }
            LeavingView {
                anchors.fill: parent
                visible: participants.leaving.open
            }
        }
    }
}
