import QtQuick
import QtQuick.Layouts
import "../controls"

// How stiff each condition's wall is against what its device bears, and which stages a tick runs at what cost.
Flickable {
    id: view
    contentHeight: sheet.height
    clip: true
    Column {
        id: sheet
        width: view.width
        spacing: 26
        Column {
            width: parent.width
            spacing: 8
            Heading {
                text: qsTr("STIFFNESS AGAINST THE DEVICE'S BORDER")
            }
            Say {
                width: parent.width
                quiet: true
                font.pixelSize: look.scale * 12
                wrapMode: Text.WordWrap
                text: qsTr("A bar ends at the stiffness that the hand feels; the thin stroke is the device's “max”, the right edge its border of stability by the model of its mechanism.")
            }
            Repeater {
                model: details.walls
                WallRow {
                    required property var modelData
                    width: sheet.width
                    wall: modelData
                }
            }
            Say {
                visible: details.walls.length === 0
                quiet: true
                text: qsTr("No condition displays a force.")
            }
        }
        Column {
            width: parent.width
            spacing: 12
            RowLayout {
                width: parent.width
                spacing: 16
                Heading {
                    Layout.fillWidth: true
                    text: qsTr("STAGES OF THE TICK, IN SLIDING CONTACT ON THIS MACHINE")
                }
                ActionButton {
                    objectName: "measureStages"
                    text: details.stages.measuring ? qsTr("Measuring …") : details.stages.tables.length > 0 ? qsTr("Measure again") : qsTr("Measure here")
                    why: details.stages.why
                    onClicked: details.measureStages()
                }
            }
            Say {
                visible: details.stages.tables.length === 0
                width: parent.width
                quiet: true
                wrapMode: Text.WordWrap
                text: details.told !== "" ? details.told : qsTr("Only what a scene names is built and called. Measuring builds each scene, presses its held part two millimetres into the nearest obstacle and takes the time of every stage over 2000 ticks.")
            }
            Repeater { // by what is the same in their conditions
                model: details.stages.tables
                StageTable {
                    required property var modelData
                    width: sheet.width
                    table: modelData
                    whole: details.stages.whole
                }
            }
        }
    }
}
