import QtQuick
import QtQuick.Layouts
import "../participant"
import "../controls"

// A running session: what happens, how well, and what may be done about it.
ColumnLayout {
    id: page
    spacing: 16
    readonly property real sideWidth: Math.min(look.scale * 330, 0.3 * width)
    readonly property bool low: height < look.scale * 600
    readonly property color toneColor: run.tone === "go" ? look.accent : run.tone === "good" ? look.good : run.tone === "wait" ? look.care : run.tone === "bad" ? look.bad : look.dim

    function focusNote() {
        commands.focusNote();
    }

    StateLine {
        Layout.fillWidth: true
        tint: page.toneColor
    }

    RowLayout {
        Layout.fillWidth: true
        Layout.fillHeight: true
        spacing: 16

        ColumnLayout {
            Layout.preferredWidth: page.sideWidth
            Layout.maximumWidth: page.sideWidth
            Layout.fillHeight: true
            spacing: 16
            Panel {
                title: qsTr("TRIALS")
                extra: run.known ? Math.round(100 * run.share) + " %" : ""
                Layout.fillWidth: true
                Layout.fillHeight: true
                TrialList {
                    anchors.fill: parent
                    anchors.leftMargin: -6
                    anchors.rightMargin: -6
                }
            }
            Panel {
                id: steps
                objectName: "steps"
                visible: run.steps.length > 0
                title: qsTr("STEPS")
                extra: qsTr("%1 of %2").arg(run.steps.filter(step => step.tone === "good").length).arg(run.steps.length)
                Layout.fillWidth: true
                Layout.preferredHeight: Math.min(steps.begins + progress.contentHeight + steps.pad, 0.45 * page.height)
                StepProgress {
                    id: progress
                    anchors.fill: parent
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
                Layout.minimumHeight: 60
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
                    anchors.centerIn: parent
                    visible: !mirrorView.drawn
                    text: qsTr("No scene is shown now.")
                    quiet: true
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
                Layout.preferredHeight: Math.min(look.scale * 240, 0.36 * page.height)
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
                        least: 0.001
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
            Layout.preferredWidth: page.sideWidth
            Layout.maximumWidth: page.sideWidth
            Layout.fillHeight: true
            spacing: 16
            Flickable { // of a window that is too low for all of it
                Layout.fillWidth: true
                Layout.fillHeight: true
                contentHeight: panels.implicitHeight
                boundsBehavior: Flickable.StopAtBounds
                clip: true
                ColumnLayout {
                    id: panels
                    width: parent.width
                    spacing: 16
                    Panel {
                        title: qsTr("SESSION")
                        Layout.fillWidth: true
                        Layout.preferredHeight: fitting
                        RunCommands {
                            id: commands
                            anchors.left: parent.left
                            anchors.right: parent.right
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
                            Figure {
                                objectName: "pictures"
                                Layout.fillWidth: true
                                name: qsTr("Pictures")
                                value: run.pictured ? run.pictures.toFixed(0) : "–"
                                unit: "/s"
                            }
                            Figure {
                                objectName: "pictureAge"
                                Layout.fillWidth: true
                                name: qsTr("Picture's age")
                                value: run.pictured ? run.pictureAge.toFixed(0) : "–"
                                unit: "ms"
                            }
                            Say {
                                objectName: "quality"
                                Layout.columnSpan: 2
                                Layout.fillWidth: true
                                visible: text !== ""
                                wrapMode: Text.WordWrap
                                text: run.quality
                                quiet: true
                                font.pixelSize: look.scale * 12
                            }
                        }
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
                visible: text !== ""
                wrapMode: Text.WordWrap
                maximumLineCount: page.low ? 2 : 4
                text: run.answer
                color: run.refused ? look.bad : look.dim
            }
            Say {
                objectName: "warnings"
                Layout.fillWidth: true
                visible: text !== ""
                wrapMode: Text.WordWrap
                maximumLineCount: page.low ? 2 : 4
                elide: Text.ElideRight
                text: run.warnings
                color: look.care
            }
            Say {
                objectName: "stopWaits"
                Layout.fillWidth: true
                visible: !stopPath.apart
                wrapMode: Text.WordWrap
                text: qsTr("No X server: an emergency stop waits while this window draws.")
                color: look.care
            }
            RowLayout { // what must be at hand stands still, however low the window is
                Layout.fillWidth: true
                spacing: 8
                ActionButton {
                    objectName: "start"
                    Layout.fillWidth: true
                    Layout.preferredWidth: 1
                    text: qsTr("Start")
                    keyName: "F5"
                    why: run.commands.start
                    onClicked: run.command("start")
                }
                ActionButton {
                    objectName: "pause"
                    Layout.fillWidth: true
                    Layout.preferredWidth: 1
                    readonly property bool paused: run.commands.continue === ""
                    kind: paused ? "main" : "plain"
                    text: paused ? qsTr("Continue") : qsTr("Pause")
                    keyName: qsTr("Ctrl+P")
                    why: paused ? "" : run.commands.pause
                    onClicked: run.command(paused ? "continue" : "pause")
                }
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
