import QtQuick
import QtQuick.Layouts
import Passung
import "../controls"

// A measure per condition: every attempt that counts as a dot, quartiles as a box.
Item {
    id: view
    readonly property var marks: records.look.marks !== undefined ? records.look.marks : [0, 1]
    readonly property var rows: records.look.rows !== undefined ? records.look.rows : []
    readonly property int names: look.scale * 250 // room for conditions [px]
    readonly property int figures: look.scale * 170

    RowLayout {
        id: head
        width: parent.width
        spacing: 12
        Picker {
            objectName: "measure"
            Layout.fillWidth: true
            Layout.maximumWidth: look.scale * 460
            name: qsTr("Measure")
            model: records.measures
            textRole: "label"
            currentIndex: records.measure
            onActivated: index => records.measure = index
        }
        Choice {
            objectName: "lookKind"
            visible: records.kinds.length > 1
            name: qsTr("Kind of participants")
            options: records.kinds
            chosen: records.kind
            onPicked: index => records.kind = index
        }
        Say {
            visible: records.kinds.length === 1
            quiet: true
            text: records.kinds.length === 1 ? records.kinds[0] : ""
        }
        Item {
            Layout.fillWidth: true
        }
        Say {
            quiet: true
            font.pixelSize: look.scale * 12
            text: qsTr("median (quartiles), n")
        }
    }
    Item { // lines at the axis' marks
        id: grid
        anchors.fill: parent
        anchors.topMargin: head.height + 14
        anchors.leftMargin: view.names
        anchors.rightMargin: view.figures
        Repeater {
            model: view.marks
            Item {
                required property double modelData
                required property int index
                x: 6 + (grid.width - 12) * index / (view.marks.length - 1)
                height: grid.height
                Rectangle {
                    width: 1
                    height: parent.height - 20
                    color: look.edge
                }
                Say {
                    anchors.bottom: parent.bottom
                    x: -width / 2
                    quiet: true
                    font.pixelSize: look.scale * 11
                    font.family: look.digits
                    text: Number(parent.modelData.toPrecision(6)).toString()
                }
            }
        }
    }
    ListView {
        id: list
        objectName: "look"
        anchors.fill: grid
        anchors.leftMargin: -view.names
        anchors.rightMargin: -view.figures
        anchors.bottomMargin: 22
        clip: true
        activeFocusOnTab: true
        model: view.rows
        readonly property int rowHeight: Math.max(34, Math.min(64, height / Math.max(1, view.rows.length)))
        delegate: Item {
            id: row
            required property var modelData
            required property int index
            width: list.width
            height: list.rowHeight
            Accessible.role: Accessible.ListItem
            Accessible.name: modelData.condition + ": " + numbers.text
            Say {
                width: view.names - 16
                anchors.verticalCenter: parent.verticalCenter
                text: row.modelData.condition
                wrapMode: Text.Wrap
                font.pixelSize: look.scale * 13
            }
            StripItem {
                x: view.names
                width: row.width - view.names - view.figures
                height: row.height - 6
                y: 3
                values: row.modelData.values
                box: row.modelData.box
                low: view.marks[0]
                high: view.marks[view.marks.length - 1]
                ink: look.accent
                line: look.text
            }
            Column {
                anchors.right: parent.right
                width: view.figures - 14
                anchors.verticalCenter: parent.verticalCenter
                Say {
                    id: numbers
                    objectName: "lookNumbers"
                    width: parent.width
                    font.family: look.digits
                    font.pixelSize: look.scale * 13
                    fontSizeMode: Text.HorizontalFit // figures are never cut
                    minimumPixelSize: look.scale * 8
                    text: row.modelData.box.length === 5 ? row.modelData.box[2].toPrecision(3) + " (" + row.modelData.box[1].toPrecision(3) + "–" + row.modelData.box[3].toPrecision(3) + ")" : "–"
                }
                Say {
                    width: parent.width
                    visible: row.modelData.n > 0
                    quiet: true
                    font.pixelSize: look.scale * 11
                    text: qsTr("Trials: %1, participants: %2").arg(row.modelData.n).arg(row.modelData.participants)
                }
            }
        }
    }
}
