import QtQuick
import QtQuick.Layouts
import "../controls"

// Somebody leaves: how and why; then, with what it does in sight, whether really.
Item {
    id: view
    property int scope: 0
    readonly property var state_: participants.leaving
    onVisibleChanged: if (visible) {
        scope = 0;
        reason.clear();
        typed.clear();
        backupToo.checked = true;
        first.forceActiveFocus(Qt.TabFocusReason);
    }
    ColumnLayout {
        anchors.left: parent.left
        anchors.right: parent.right
        visible: !view.state_.confirms
        spacing: 10
        Say {
            Layout.fillWidth: true
            text: qsTr("How does the part of %1 end?").arg(view.state_.code)
            font.pixelSize: look.scale * 20
            font.weight: Font.DemiBold
            wrapMode: Text.WordWrap
        }
        Heading {
            Layout.topMargin: 8
            text: qsTr("AT THEIR WISH")
        }
        RadioRow {
            id: first
            objectName: "scope0"
            Layout.fillWidth: true
            text: qsTr("Take part no more")
            meaning: qsTr("What is there stays and counts in the analysis.")
            checked: view.scope === 0
            onToggled: view.scope = 0
        }
        RadioRow {
            objectName: "scope1"
            Layout.fillWidth: true
            text: qsTr("Data is not to be used")
            meaning: qsTr("What is there stays and counts nowhere.")
            checked: view.scope === 1
            onToggled: view.scope = 1
        }
        RadioRow {
            objectName: "scope2"
            Layout.fillWidth: true
            text: qsTr("Erase everything")
            meaning: qsTr("No byte of this participant remains in the database.")
            checked: view.scope === 2
            onToggled: view.scope = 2
        }
        Heading {
            Layout.topMargin: 8
            text: qsTr("AT THE EXPERIMENTER'S DECISION")
        }
        RadioRow {
            objectName: "scope3"
            Layout.fillWidth: true
            text: qsTr("Exclude")
            meaning: qsTr("What is there stays and counts nowhere; this can be taken back.")
            checked: view.scope === 3
            onToggled: view.scope = 3
        }
        TextBox {
            id: reason
            objectName: "leavingReason"
            Layout.fillWidth: true
            Layout.topMargin: 8
            visible: view.scope !== 2
            placeholderText: qsTr("Reason, without names")
        }
    }
    ColumnLayout {
        anchors.left: parent.left
        anchors.right: parent.right
        visible: view.state_.confirms
        spacing: 12
        Say {
            Layout.fillWidth: true
            text: view.state_.erases ? qsTr("Erase %1?").arg(view.state_.code) : qsTr("%1 leaves the study?").arg(view.state_.code)
            font.pixelSize: look.scale * 20
            font.weight: Font.DemiBold
            wrapMode: Text.WordWrap
        }
        Repeater {
            model: view.state_.lines
            RowLayout {
                id: fact
                required property string modelData
                Layout.fillWidth: true
                spacing: 10
                Lamp {
                    Layout.alignment: Qt.AlignTop
                    Layout.topMargin: 3
                    tone: view.state_.erases ? "bad" : "wait"
                }
                Say {
                    Layout.fillWidth: true
                    wrapMode: Text.WordWrap
                    text: fact.modelData
                }
            }
        }
        Tick {
            id: backupToo
            objectName: "backupToo"
            visible: view.state_.erases && view.state_.hasBackup
            text: qsTr("In the backup as well")
            checked: true
        }
        TextBox {
            id: typed
            objectName: "typedCode"
            Layout.fillWidth: true
            visible: view.state_.erases
            font.family: look.digits
            placeholderText: qsTr("Type %1 to confirm").arg(view.state_.code)
        }
    }
    ColumnLayout {
        anchors.left: parent.left
        anchors.right: parent.right
        anchors.bottom: parent.bottom
        spacing: 8
        Say {
            Layout.fillWidth: true
            quiet: true
            font.pixelSize: look.scale * 12
            wrapMode: Text.WordWrap
            visible: text !== ""
            text: view.state_.confirms ? confirm.why : next.why
        }
        ActionButton {
            id: next
            objectName: "leavingNext"
            Layout.fillWidth: true
            visible: !view.state_.confirms
            tall: true
            text: qsTr("Continue …")
            why: view.state_.open ? participants.whyNotChoose(view.scope, reason.text) : ""
            onClicked: {
                participants.chooseLeaving(view.scope, reason.text);
                back.forceActiveFocus(Qt.TabFocusReason);
            }
        }
        ActionButton {
            id: confirm
            objectName: "leavingConfirm"
            Layout.fillWidth: true
            visible: view.state_.confirms
            tall: true
            kind: "stop"
            text: view.state_.erases ? qsTr("Erase for good") : qsTr("Yes, end their part")
            why: view.state_.confirms ? participants.whyNotConfirm(typed.text) : ""
            onClicked: participants.confirmLeaving(typed.text, backupToo.checked)
        }
        ActionButton {
            id: back
            objectName: "leavingBack"
            Layout.fillWidth: true
            text: view.state_.confirms ? qsTr("Back") : qsTr("Cancel")
            onClicked: view.state_.confirms ? participants.backLeaving() : participants.closeLeaving()
        }
    }
}
