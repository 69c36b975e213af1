import QtQuick
import QtQuick.Layouts
import "../controls"

// Enrols the next participant: which kind, and the code that is proposed.
RowLayout {
    id: form
    property bool pilot: false
    property bool typed: false // the code is somebody's own
    readonly property string why: participants.known ? (participants.people, participants.whyNotEnrol(code.text, pilot)) : ""
    spacing: 12
    height: look.scale * 38

    function propose() {
        typed = false;
        code.text = participants.proposedCode(pilot);
    }

    Connections {
        target: participants
        function onChanged() {
            if (!form.typed)
                code.text = participants.proposedCode(form.pilot);
        }
    }
    Component.onCompleted: propose()

    Choice {
        objectName: "kind"
        name: qsTr("Kind")
        options: [qsTr("Person"), qsTr("Pilot")]
        chosen: form.pilot ? 1 : 0
        onPicked: index => {
            form.pilot = index === 1;
            form.propose();
        }
    }
    TextBox {
        id: code
        objectName: "code"
        implicitWidth: look.scale * 130
        placeholderText: qsTr("Code")
        font.family: look.digits
        maximumLength: 32
        onTextEdited: form.typed = true
        onAccepted: enrol.clicked()
    }
    ActionButton {
        id: enrol
        objectName: "enrol"
        text: qsTr("Enrol")
        kind: "main"
        why: !participants.known || participants.busy ? qsTr("Reading …") : form.why
        onClicked: if (why === "") {
            participants.enrol(code.text, form.pilot);
            form.typed = false;
        }
    }
    Say {
        objectName: "whyNotEnrol"
        Layout.fillWidth: true
        quiet: true
        font.pixelSize: look.scale * 12
        wrapMode: Text.WordWrap
        maximumLineCount: 2
        text: form.why
    }
}
