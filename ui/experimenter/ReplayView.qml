import QtQuick
import QtQuick.Layouts
import "../participant"
import "../controls"

// A recorded attempt once more: the scene, its traces with a cursor, and the time.
ColumnLayout {
    id: view
    readonly property var speeds: [0.1, 0.25, 0.5, 1, 2]
    spacing: 16

    function reveal() {
        replay.showTraces(forceView.trace, depthView.trace, overlapView.trace);
        play.forceActiveFocus(Qt.TabFocusReason);
    }
    Connections {
        target: replay
        function onOpened() {
            if (replay.there)
                view.reveal();
        }
    }

    RowLayout {
        Layout.fillWidth: true
        Layout.fillHeight: true
        spacing: 16
        Rectangle {
            Layout.fillWidth: true
            Layout.fillHeight: true
            radius: 10
            clip: true
            color: look.panel
            border.color: look.edge
            Scene3D {
                objectName: "replayScene"
                anchors.fill: parent
                anchors.margins: 6
                visible: replay.there
                scene: replay
                shadows: false
            }
            Say {
                anchors.centerIn: parent
                width: parent.width - 60
                visible: !replay.there
                horizontalAlignment: Text.AlignHCenter
                wrapMode: Text.WordWrap
                quiet: true
                text: replay.told !== "" ? replay.told : qsTr("Reading …")
            }
            Say {
                objectName: "replayTitle"
                x: 18
                y: 14
                width: parent.width - 36
                text: replay.title
                font.pixelSize: look.scale * 13
                font.weight: Font.DemiBold
            }
            Say {
                x: 18
                anchors.bottom: parent.bottom
                anchors.bottomMargin: 14
                visible: replay.there
                quiet: true
                font.pixelSize: look.scale * 12
                text: replay.drawsProxy ? qsTr("Solid: the proxy, as it was drawn. Pale: the hand. Arrow: the force on the hand.") : qsTr("Solid: the hand, as it was drawn. Pale: the proxy. Arrow: the force on the hand.")
            }
        }
        Panel {
            title: qsTr("THE WHOLE ATTEMPT")
            Layout.preferredWidth: look.scale * 470
            Layout.maximumWidth: look.scale * 470
            Layout.fillHeight: true
            ColumnLayout {
                anchors.fill: parent
                spacing: 18
                CursorTrace {
                    id: forceView
                    name: qsTr("Force on the hand")
                    unit: "N"
                    ink: look.accent
                    value: replay.force
                }
                CursorTrace {
                    id: depthView
                    name: qsTr("Depth of the hand in the material")
                    unit: "mm"
                    ink: look.care
                    least: 0.001
                    value: replay.depth
                }
                CursorTrace {
                    id: overlapView
                    name: qsTr("Overlap of the proxy")
                    unit: "mm"
                    ink: look.good
                    least: 0.001
                    value: replay.overlap
                }
            }
        }
    }
    Panel {
        Layout.fillWidth: true
        implicitHeight: look.scale * 70
        RowLayout {
            anchors.fill: parent
            spacing: 16
            ActionButton {
                id: play
                objectName: "play"
                kind: "main"
                text: replay.plays ? qsTr("Pause") : qsTr("Play")
                keyName: qsTr("Space")
                why: replay.there ? "" : qsTr("Reading …")
                onClicked: replay.plays = !replay.plays
            }
            TimeSlider {
                objectName: "time"
                Layout.fillWidth: true
                enabled: replay.there
                from: 0
                to: Math.max(replay.length, 0.001)
                stepSize: 0.01
                value: replay.time
                onMoved: replay.time = value
                Keys.onSpacePressed: replay.plays = !replay.plays // it has the focus once it was moved
                Accessible.name: qsTr("Time in the attempt")
            }
            Say {
                objectName: "replayTime"
                Layout.preferredWidth: look.scale * 150
                horizontalAlignment: Text.AlignRight
                font.family: look.digits
                font.pixelSize: look.scale * 16
                text: replay.time.toFixed(2) + " / " + replay.length.toFixed(2) + " s"
            }
            Choice {
                objectName: "speed"
                name: qsTr("Speed")
                options: ["×0.1", "×¼", "×½", "×1", "×2"]
                chosen: view.speeds.indexOf(replay.speed)
                onPicked: index => replay.speed = view.speeds[index]
            }
            ActionButton {
                objectName: "closeReplay"
                text: qsTr("Close")
                onClicked: replay.close()
            }
        }
    }
}
