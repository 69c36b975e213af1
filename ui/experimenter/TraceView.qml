import QtQuick
import Passung
import "../controls"

// A signal over time, with its newest value: the last ten seconds unless `marks` says otherwise.
Item {
    id: view
    property string name
    property string unit
    property color ink: look.accent
    property double value: 0
    property alias trace: item
    property alias least: item.least // that the scale ends with
    property var marks: [{at: 0, text: "−10 s"}, {at: 0.5, text: "−5 s"}, {at: 1, text: qsTr("now")}] // shares of the width
    function readable(number) {
        const small = unit === "mm" && Math.abs(number) < 0.1;
        return small ? (1000 * number).toFixed(1) + " µm" : number.toFixed(2) + " " + unit;
    }
    Say {
        id: label
        width: parent.width - number.width - 8
        wrapMode: Text.WordWrap
        text: view.name
        quiet: true
        font.pixelSize: look.scale * 12
    }
    Say {
        id: number
        anchors.right: parent.right
        text: view.readable(view.value)
        color: view.ink
        font.family: look.digits
        font.pixelSize: look.scale * 15
    }
    Item {
        id: field
        anchors.fill: parent
        anchors.topMargin: Math.max(label.height, number.height) + 6
        anchors.bottomMargin: look.scale * 15
        Repeater { // time
            model: view.marks
            Item {
                id: mark
                required property var modelData
                x: modelData.at * (field.width - 1)
                height: field.height
                Rectangle {
                    y: field.height - 4
                    width: 1
                    height: 4
                    color: look.dim
                }
                Say {
                    objectName: "timeMark"
                    x: Math.max(-mark.x, Math.min(-width / 2, field.width - mark.x - width))
                    y: field.height + 2
                    text: mark.modelData.text
                    quiet: true
                    font.pixelSize: look.scale * 10
                    font.family: look.digits
                }
            }
        }
        Repeater { // lines at whole, half and none
            model: 3
            Rectangle {
                y: index * (field.height - 1) / 2
                width: field.width
                height: 1
                color: look.edge
                opacity: index === 2 ? 1 : 0.6
            }
        }
        TraceItem {
            id: item
            anchors.fill: parent
            color: view.ink
            clip: true
        }
        Say {
            anchors.right: parent.right
            anchors.rightMargin: 4
            y: 2
            text: view.unit === "mm" && item.full < 0.1 ? +(1000 * item.full).toPrecision(3) + " µm" : item.full + " " + view.unit
            quiet: true
            font.pixelSize: look.scale * 10
            font.family: look.digits
        }
    }
}
