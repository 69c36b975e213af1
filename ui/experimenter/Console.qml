import QtQuick
import QtQuick.Layouts
import QtQuick.Window
import "../controls"

// The experimenter's window.
Window {
    id: window
    objectName: "experimenter"
    title: "Passung"
    width: 1440
    height: 900
    minimumWidth: 960
    minimumHeight: 600
    color: look.ground
    property string page: app.page // "studies", "participants", "session", "data"
    onPageChanged: app.page = page
    property bool leaving: false // somebody closes the window while a session runs
    readonly property bool running: run.running
    onRunningChanged: if (!running)
        leaving = false
    onClosing: close => {
        close.accepted = !running;
        leaving = running;
        if (!running)
            Qt.quit();
    }

    Shortcut {
        sequence: "Esc"
        context: Qt.ApplicationShortcut
        onActivated: run.command("stop")
    }
    Shortcut {
        sequence: "F5"
        enabled: run.commands.start === ""
        onActivated: run.command("start")
    }
    Shortcut { // of a trial that the experimenter times
        sequence: "F6"
        enabled: run.commands.done === ""
        onActivated: run.command("done")
    }
    Shortcut {
        sequence: "F7"
        enabled: run.commands.failed === ""
        onActivated: run.command("failed")
    }
    Shortcut {
        sequence: "Ctrl+P"
        onActivated: {
            if (run.commands.continue === "")
                run.command("continue");
            else if (run.commands.pause === "")
                run.command("pause");
        }
    }
    Shortcut {
        sequence: "Ctrl+R"
        enabled: run.commands.repeat === ""
        onActivated: run.command("repeat")
    }
    Shortcut {
        sequence: "Ctrl+K"
        enabled: run.commands.skip === ""
        onActivated: run.command("skip")
    }
    Shortcut {
        sequence: "Ctrl+N"
        enabled: run.known
        onActivated: {
            window.page = "session";
            runPage.focusNote();
        }
    }

    ColumnLayout {
        anchors.fill: parent
        anchors.margins: 20
        spacing: 16

        RowLayout {
            Layout.fillWidth: true
            spacing: 8
            Item { // a peg in its hole
                implicitWidth: 30
                implicitHeight: 30
                Rectangle {
                    y: 12
                    width: 30
                    height: 18
                    radius: 3
                    color: look.dim
                }
                Rectangle {
                    x: 9
                    width: 12
                    height: 25
                    radius: 2
                    color: look.ground
                }
                Rectangle {
                    x: 10.5
                    y: -1
                    width: 9
                    height: 24
                    radius: 2
                    color: look.care
                }
            }
            Say {
                Layout.leftMargin: 4
                Layout.rightMargin: 24
                text: "Passung"
                font.pixelSize: 21
                font.weight: Font.DemiBold
            }
            Repeater {
                model: [["studies", qsTr("Studies")], ["participants", qsTr("Participants")], ["session", qsTr("Session")], ["data", qsTr("Data")]]
                ActionButton {
                    id: tab
                    required property var modelData
                    required property int index
                    readonly property bool current: window.page === modelData[0]
                    objectName: "page-" + modelData[0]
                    text: modelData[1]
                    Accessible.role: Accessible.PageTab
                    enabled: modelData[0] !== "session" || run.known
                    opacity: current ? 1 : 0.75
                    font.weight: current ? Font.DemiBold : Font.Normal
                    background: Rectangle {
                        radius: 7
                        color: tab.current ? look.raised : "transparent"
                        border.width: tab.visualFocus ? 2 : 0
                        border.color: look.accent
                    }
                    onClicked: window.page = modelData[0]
                    Shortcut {
                        sequence: "Ctrl+" + (tab.index + 1)
                        enabled: tab.enabled
                        onActivated: tab.clicked()
                    }
                }
            }
            Item {
                Layout.fillWidth: true
            }
            Lamp {
                tone: run.lamp
            }
            Say {
                Layout.rightMargin: 16
                visible: window.width >= look.scale * 900
                quiet: true
                text: run.lamp === "rest" ? qsTr("loop at rest") : run.rate.toFixed(0) + " Hz"
            }
            Picker {
                objectName: "participantScreen"
                visible: screenChoice.names.length > 0
                implicitWidth: look.scale * 200
                name: qsTr("Participant's screen")
                model: screenChoice.names
                currentIndex: screenChoice.chosen
                displayText: qsTr("Participant: %1").arg(currentText)
                onActivated: index => screenChoice.chosen = index
            }
            ActionButton {
                objectName: "language"
                text: app.language === "de" ? "English" : "Deutsch"
                onClicked: app.language = app.language === "de" ? "en" : "de"
            }
            ActionButton {
                objectName: "theme"
                text: look.dark ? qsTr("Light") : qsTr("Dark")
                onClicked: look.dark = !look.dark
            }
        }

        Item { // what a page would like to measure is nothing to the line above it
            Layout.fillWidth: true
            Layout.fillHeight: true

            StudiesPage {
                visible: window.page === "studies"
                anchors.fill: parent
                onBegun: window.page = "session"
            }
            ParticipantsPage {
                visible: window.page === "participants"
                anchors.fill: parent
                onBegun: window.page = "session"
            }
            DataPage {
                visible: window.page === "data"
                anchors.fill: parent
            }
            RunPage {
                id: runPage
                visible: window.page === "session"
                anchors.fill: parent
            }
        }
    }

    Question { // after a crash
        anchors.fill: parent
        visible: cutOff.question !== ""
        text: cutOff.question
        detail: qsTr("What was done is kept. The participant goes on with the trial or questionnaire that was cut off; of a questionnaire only what was handed in is kept.")
        yes: qsTr("Resume the session")
        no: qsTr("Not now")
        whyNotYes: cutOff.whyNot
        onAgreed: if (cutOff.resume(app.language))
            window.page = "session"
        onRefused: cutOff.leave()
    }
    Question {
        anchors.fill: parent
        visible: window.leaving
        text: qsTr("A session is running. Break it off and close?")
        detail: qsTr("What was done is kept, and the session can be resumed.")
        yes: qsTr("Break off and close")
        no: qsTr("Go on")
        grave: true
        onAgreed: Qt.quit()
        onRefused: window.leaving = false
    }
}
