import QtQuick
import QtQuick.Layouts
import QtQuick.Templates as T
import "../participant"

// A running session: what happens, how well, and what may be done about it.
ColumnLayout {
    id: page
    spacing: 16
    readonly property color toneColor: run.tone === "go" ? look.accent : run.tone === "good" ? look.good : run.tone === "wait" ? look.care : run.tone === "bad" ? look.bad : look.dim

    function focusNote() {
        note.forceActiveFocus();
    }

    // The state, to be read from across the room.
    Rectangle {
        Layout.fillWidth: true
        implicitHeight: look.scale * 92
        radius: 10
        color: look.panel
        border.color: look.edge
        clip: true
        Rectangle {
            width: 8
            height: parent.height
            color: page.toneColor
        }
        Say {
            id: stateLine
            objectName: "stateLine"
            anchors.left: parent.left
            anchors.leftMargin: 32
            anchors.right: aside.left
            anchors.rightMargin: 20
            y: 14
            text: run.line
            font.pixelSize: look.scale * 30
            fontSizeMode: Text.HorizontalFit
            minimumPixelSize: 15
            font.weight: Font.DemiBold
        }
        Say {
            anchors.left: stateLine.left
            anchors.right: aside.left
            anchors.top: stateLine.bottom
            anchors.topMargin: 2
            quiet: true
            text: [run.detail, run.participant, run.study].filter(s => s !== "").join("  ·  ")
        }
        Row {
            id: aside
            anchors.right: parent.right
            anchors.rightMargin: 24
            anchors.verticalCenter: parent.verticalCenter
            spacing: 24
            ActionButton {
                objectName: "cancelBuild"
                visible: run.built >= 0
                text: qsTr("Cancel")
                onClicked: run.command("abort")
            }
            ActionButton {
                objectName: "openDisplay"
                visible: run.displayGone
                kind: "main"
                text: qsTr("Open the participant's window")
                onClicked: run.openDisplay()
            }
            Say {
                visible: run.running && run.built < 0 && !run.displayGone
                text: run.seconds.toFixed(1) + " s"
                font.family: look.digits
                font.pixelSize: look.scale * 34
            }
        }
        Rectangle {
            anchors.bottom: parent.bottom
            height: 4
            width: parent.width * (run.built >= 0 ? run.built : run.share)
            color: page.toneColor
        }
    }

    RowLayout {
        Layout.fillWidth: true
        Layout.fillHeight: true
        spacing: 16

        Panel {
            title: qsTr("TRIALS")
            extra: run.known ? Math.round(100 * run.share) + " %" : ""
            Layout.preferredWidth: look.scale * 330
            Layout.fillHeight: true
            ListView {
                id: trials
                objectName: "trials"
                anchors.fill: parent
                anchors.leftMargin: -6
                anchors.rightMargin: -6
                clip: true
                activeFocusOnTab: true
                model: run.rows
                Accessible.role: Accessible.List
                Accessible.name: qsTr("Trials")
                onModelChanged: Qt.callLater(() => positionViewAtIndex(Math.max(0, run.currentRow), ListView.Contain))
                delegate: Rectangle {
                    id: trial
                    required property var modelData
                    width: trials.width
                    height: Math.max(look.scale * 42, words.height + 10)
                    radius: 6
                    color: modelData.tone === "go" ? look.raised : "transparent"
                    readonly property color tint: modelData.tone === "good" ? look.good : modelData.tone === "bad" ? look.bad : modelData.tone === "wait" ? look.care : modelData.tone === "go" ? look.accent : look.dim
                    Accessible.role: Accessible.ListItem
                    Accessible.name: modelData.number + " " + modelData.condition + " " + modelData.word
                    Say {
                        x: 6
                        width: 26
                        anchors.verticalCenter: parent.verticalCenter
                        horizontalAlignment: Text.AlignRight
                        text: trial.modelData.number
                        quiet: true
                        font.family: look.digits
                        font.pixelSize: look.scale * 13
                    }
                    Say {
                        x: 38
                        width: 20
                        anchors.verticalCenter: parent.verticalCenter
                        horizontalAlignment: Text.AlignHCenter
                        text: trial.modelData.sign
                        color: trial.tint
                        font.pixelSize: look.scale * 15
                    }
                    Column {
                        id: words
                        x: 66
                        width: trial.width - x - time.width - 12
                        anchors.verticalCenter: parent.verticalCenter
                        Say {
                            width: parent.width
                            text: trial.modelData.condition
                            wrapMode: Text.Wrap
                            font.pixelSize: look.scale * 13
                        }
                        Say {
                            width: parent.width
                            quiet: true
                            font.pixelSize: look.scale * 11
                            text: trial.modelData.phase + " · " + trial.modelData.word + (trial.modelData.attempts > 1 ? " · " + qsTr("Attempts: %1").arg(trial.modelData.attempts) : "")
                        }
                    }
                    Say {
                        id: time
                        anchors.right: parent.right
                        anchors.rightMargin: 6
                        anchors.verticalCenter: parent.verticalCenter
                        quiet: true
                        font.family: look.digits
                        font.pixelSize: look.scale * 13
                        text: trial.modelData.seconds >= 0 ? trial.modelData.seconds.toFixed(1) + " s" : ""
                    }
                }
            }
        }

        ColumnLayout {
            Layout.fillWidth: true
            Layout.fillHeight: true
            spacing: 16
            Rectangle {
                Layout.fillWidth: true
                Layout.fillHeight: true
                Layout.minimumHeight: 160
                radius: 10
                clip: true
                color: look.panel
                border.color: look.edge
                Scene3D {
                    id: mirror
                    objectName: "mirror"
                    anchors.fill: parent
                    anchors.margins: 6
                    visible: mirrorView.drawn
                    scene: mirrorView
                    shadows: false
                }
                Say {
                    x: 18
                    y: 14
                    text: qsTr("PARTICIPANT'S VIEW")
                    quiet: true
                    font.pixelSize: look.scale * 12
                    font.weight: Font.DemiBold
                    font.letterSpacing: 0.4
                }
            }
            Panel {
                title: qsTr("LAST TEN SECONDS")
                Layout.fillWidth: true
                Layout.preferredHeight: look.scale * 240
                RowLayout {
                    anchors.fill: parent
                    spacing: 24
                    TraceView {
                        id: forceView
                        Layout.fillWidth: true
                        Layout.fillHeight: true
                        name: qsTr("Force on the hand")
                        unit: "N"
                        ink: look.accent
                        value: run.force
                    }
                    TraceView {
                        id: depthView
                        Layout.fillWidth: true
                        Layout.fillHeight: true
                        name: qsTr("Depth of the hand in the material")
                        unit: "mm"
                        ink: look.care
                        value: run.depth
                    }
                }
                Connections {
                    target: run
                    function onMeasured() {
                        run.showTraces(forceView.trace, depthView.trace);
                    }
                }
            }
        }

        ColumnLayout {
            Layout.preferredWidth: look.scale * 330
            Layout.maximumWidth: look.scale * 330
            Layout.fillHeight: true
            spacing: 16
            Panel {
                title: qsTr("SESSION")
                Layout.fillWidth: true
                Layout.preferredHeight: fitting
                ColumnLayout {
                    anchors.left: parent.left
                    anchors.right: parent.right
                    spacing: 8
                    GridLayout {
                        Layout.fillWidth: true
                        columns: 2
                        rowSpacing: 8
                        columnSpacing: 8
                        ActionButton {
                            objectName: "start"
                            Layout.fillWidth: true
                            text: qsTr("Start")
                            keyName: "F5"
                            why: run.commands.start
                            onClicked: run.command("start")
                        }
                        ActionButton {
                            objectName: "pause"
                            Layout.fillWidth: true
                            readonly property bool paused: run.commands.continue === ""
                            kind: paused ? "main" : "plain"
                            text: paused ? qsTr("Continue") : qsTr("Pause")
                            keyName: qsTr("Ctrl+P")
                            why: paused ? "" : run.commands.pause
                            onClicked: run.command(paused ? "continue" : "pause")
                        }
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
                    T.TextField {
                        id: note
                        objectName: "noteText"
                        Layout.fillWidth: true
                        implicitHeight: look.scale * 38
                        leftPadding: 12
                        rightPadding: 12
                        verticalAlignment: TextInput.AlignVCenter
                        color: look.text
                        font.family: look.family
                        font.pixelSize: look.scale * 14
                        selectByMouse: true
                        placeholderText: qsTr("Note or reason")
                        Accessible.role: Accessible.EditableText
                        Accessible.name: placeholderText
                        function take() {
                            const words = text;
                            text = "";
                            return words;
                        }
                        Keys.onReturnPressed: noteButton.clicked()
                        background: Rectangle {
                            radius: 7
                            color: look.ground
                            border.width: note.activeFocus ? 2 : 1
                            border.color: note.activeFocus ? look.accent : look.edge
                            Say {
                                anchors.verticalCenter: parent.verticalCenter
                                x: 12
                                visible: note.text === ""
                                text: note.placeholderText
                                quiet: true
                            }
                        }
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
            }
            Panel {
                title: qsTr("HAPTIC LOOP")
                Layout.fillWidth: true
                Layout.preferredHeight: fitting
                lamp: run.lamp
                GridLayout {
                    anchors.left: parent.left
                    anchors.right: parent.right
                    columns: 2
                    rowSpacing: 10
                    columnSpacing: 12
                    Figure {
                        Layout.fillWidth: true
                        Layout.preferredWidth: 1
                        name: qsTr("Rate")
                        value: run.rate > 0 ? run.rate.toFixed(0) : "–"
                        unit: "Hz"
                    }
                    Figure {
                        Layout.fillWidth: true
                        Layout.preferredWidth: 1
                        name: qsTr("Missed cycles")
                        value: run.rate > 0 ? run.missed : "–"
                    }
                    Figure {
                        Layout.fillWidth: true
                        name: qsTr("Tick, typical")
                        value: run.rate > 0 ? run.typical.toFixed(0) : "–"
                        unit: "µs"
                    }
                    Figure {
                        Layout.fillWidth: true
                        name: qsTr("Tick, longest")
                        value: run.rate > 0 ? run.longest.toFixed(0) : "–"
                        unit: "µs"
                    }
                }
            }
            Say {
                objectName: "sound"
                Layout.fillWidth: true
                visible: run.sound !== ""
                wrapMode: Text.WordWrap
                text: run.sound
                quiet: true
            }
            Say {
                objectName: "answer"
                Layout.fillWidth: true
                Layout.fillHeight: true
                verticalAlignment: Text.AlignBottom
                wrapMode: Text.WordWrap
                maximumLineCount: 4
                text: run.answer
                color: run.refused ? look.bad : look.dim
            }
            ActionButton {
                objectName: "stop"
                Layout.fillWidth: true
                tall: true
                kind: "stop"
                text: qsTr("Emergency stop")
                keyName: qsTr("Esc")
                why: run.commands.stop
                onClicked: run.command("stop")
            }
        }
    }
}
