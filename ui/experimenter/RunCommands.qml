import QtQuick
import QtQuick.Layouts
import "../controls"

// What may be done about a running session, and the note or reason that goes with it.
ColumnLayout {
    spacing: 8

    function focusNote() {
        note.forceActiveFocus();
    }

    GridLayout {
        Layout.fillWidth: true
        columns: 2
        rowSpacing: 8
        columnSpacing: 8
        ActionButton {
            objectName: "repeat"
            Layout.fillWidth: true
            text: qsTr("Repeat")
            keyName: qsTr("Ctrl+R")
            why: run.commands.repeat
            onClicked: run.command("repeat", note.take())
        }
        ActionButton {
            objectName: "skip"
            Layout.fillWidth: true
            text: qsTr("Leave out")
            keyName: qsTr("Ctrl+K")
            why: run.commands.skip
            onClicked: run.command("skip", note.take())
        }
        ActionButton { // of a trial that the experimenter times
            objectName: "done"
            visible: run.byHand
            Layout.fillWidth: true
            kind: "main"
            text: qsTr("Succeeded")
            keyName: "F6"
            why: run.commands.done
            onClicked: run.command("done")
        }
        ActionButton {
            objectName: "failed"
            visible: run.byHand
            Layout.fillWidth: true
            text: qsTr("Failed")
            keyName: "F7"
            why: run.commands.failed
            onClicked: run.command("failed")
        }
    }
    TextBox {
        id: note
        objectName: "noteText"
        Layout.fillWidth: true
        placeholderText: qsTr("Note or reason")
        function take() {
            const words = text;
            text = "";
            return words;
        }
        onAccepted: noteButton.clicked()
    }
    GridLayout {
        Layout.fillWidth: true
        columns: 2
        rowSpacing: 8
        columnSpacing: 8
        ActionButton {
            id: noteButton
            objectName: "note"
            Layout.fillWidth: true
            Layout.preferredWidth: 1
            text: qsTr("Keep note")
            why: run.commands.note !== "" ? run.commands.note : note.text.trim() === "" ? qsTr("Write it first.") : ""
            onClicked: if (enabled)
                run.command("note", note.take())
        }
        ActionButton {
            objectName: "invalidate"
            Layout.fillWidth: true
            Layout.preferredWidth: 1
            text: qsTr("Does not count")
            why: run.commands.invalidate !== "" ? run.commands.invalidate : note.text.trim() === "" ? qsTr("Write the reason first.") : ""
            onClicked: run.command("invalidate", note.take())
        }
        ActionButton {
            objectName: "abort"
            Layout.columnSpan: 2
            Layout.fillWidth: true
            property bool armed: false
            text: armed ? qsTr("Really end the session?") : qsTr("End the session")
            why: run.commands.abort
            onClicked: {
                if (armed)
                    run.command("abort", note.take());
                armed = !armed;
            }
            onActiveFocusChanged: if (!activeFocus)
                armed = false
        }
    }
}
