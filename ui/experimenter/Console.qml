import QtQuick
import QtQuick.Layouts
import QtQuick.Window

// The experimenter's window.
Window {
    id: window
    objectName: "experimenter"
    title: "Passung"
    width: 1440
    height: 900
    minimumWidth: 1180
    minimumHeight: 760
    color: look.ground
    property int page: 0
    onClosing: Qt.quit()

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
            window.page = 1;
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
                model: [qsTr("Studies"), qsTr("Session")]
                ActionButton {
                    required property string modelData
                    required property int index
                    objectName: "page" + index
                    text: modelData
                    enabled: index === 0 || run.known
                    opacity: window.page === index ? 1 : 0.75
                    font.weight: window.page === index ? Font.DemiBold : Font.Normal
                    background: Rectangle {
                        radius: 7
                        color: window.page === parent.index ? look.raised : "transparent"
                        border.width: parent.visualFocus ? 2 : 0
                        border.color: look.accent
                    }
                    onClicked: window.page = index
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
                quiet: true
                text: run.lamp === "rest" ? qsTr("loop at rest") : run.rate.toFixed(0) + " Hz"
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

        StudiesPage {
            id: studiesPage
            visible: window.page === 0
            Layout.fillWidth: true
            Layout.fillHeight: true
            onBegun: window.page = 1
        }
        RunPage {
            id: runPage
            visible: window.page === 1
            Layout.fillWidth: true
            Layout.fillHeight: true
        }
    }
}
