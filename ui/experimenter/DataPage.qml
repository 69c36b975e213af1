import QtQuick
import QtQuick.Layouts
import "../controls"

// What was recorded: sessions and their attempts, a quick look per condition, export.
ColumnLayout {
    id: page
    spacing: 16

    StudyBar {
        Layout.fillWidth: true
        told: records.told
        failed: records.failed
        Choice {
            objectName: "source"
            name: qsTr("Which data")
            options: [qsTr("Study"), qsTr("Try-outs"), qsTr("Other file")]
            chosen: records.source
            onPicked: index => records.source = index
        }
        TextBox {
            objectName: "file"
            visible: records.source === 2
            implicitWidth: look.scale * 300
            placeholderText: qsTr("Path of a database, then Enter")
            onAccepted: records.file = text.trim()
        }
    }

    Item {
        visible: !records.there && !replay.open
        Layout.fillWidth: true
        Layout.fillHeight: true
        Column {
            anchors.centerIn: parent
            spacing: 8
            Say {
                objectName: "noData"
                anchors.horizontalCenter: parent.horizontalCenter
                text: records.busy ? qsTr("Reading …") : qsTr("Nothing is recorded here yet.")
                font.pixelSize: look.scale * 20
                quiet: true
            }
            Say {
                anchors.horizontalCenter: parent.horizontalCenter
                quiet: true
                font.pixelSize: look.scale * 12
                text: records.database
            }
        }
    }

    ReplayView {
        visible: replay.open
        Layout.fillWidth: true
        Layout.fillHeight: true
    }
    RowLayout {
        visible: records.there && !replay.open
        Layout.fillWidth: true
        Layout.fillHeight: true
        spacing: 16
        ColumnLayout {
            Layout.preferredWidth: look.scale * 372
            Layout.maximumWidth: look.scale * 372
            Layout.fillHeight: true
            spacing: 16
            Panel {
                title: qsTr("SESSIONS")
                extra: records.sessions.length
                Layout.fillWidth: true
                Layout.fillHeight: true
                Layout.preferredHeight: 2
                SessionList {
                    anchors.fill: parent
                }
            }
            Panel {
                title: qsTr("ATTEMPTS")
                extra: records.attempts.length
                Layout.fillWidth: true
                Layout.fillHeight: true
                Layout.preferredHeight: 3
                AttemptList {
                    id: attempts
                    anchors.fill: parent
                    anchors.bottomMargin: again.height + 12
                }
                ActionButton {
                    id: again
                    objectName: "again"
                    anchors.bottom: parent.bottom
                    width: parent.width
                    text: qsTr("Replay the attempt")
                    keyName: qsTr("Enter")
                    why: attempts.currentIndex >= 0 ? "" : qsTr("Choose an attempt.")
                    onClicked: records.showAgain(attempts.currentIndex)
                }
            }
        }
        ColumnLayout {
            Layout.fillWidth: true
            Layout.fillHeight: true
            spacing: 16
            Panel {
                title: qsTr("QUICK LOOK")
                Layout.fillWidth: true
                Layout.fillHeight: true
                LookView {
                    anchors.fill: parent
                }
            }
            Panel {
                title: qsTr("EXPORT")
                Layout.fillWidth: true
                Layout.preferredHeight: look.scale * 148
                ExportView {
                    anchors.fill: parent
                }
            }
        }
    }
}
