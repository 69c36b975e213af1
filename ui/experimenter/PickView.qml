import QtQuick
import QtQuick.Layouts
import "../controls"

// What accuracy = "auto" measured: a dot per setting, the ones picked marked.
Item {
    id: view
    readonly property var facts: details.accuracy
    readonly property bool there: facts.points !== undefined
    readonly property var modes: there ? [...new Set(facts.points.map(p => p.mode))] : []
    readonly property var hues: ["#56b4e9", "#e69f00", "#009e73", "#cc79a7", "#d55e00"]
    function decade(exponent) {
        return exponent >= 0 ? Math.pow(10, exponent).toString() : Math.pow(10, exponent).toFixed(-exponent);
    }

    ColumnLayout {
        anchors.fill: parent
        visible: view.there
        spacing: 10
        Row {
            spacing: 20
            Repeater {
                model: view.modes
                Row {
                    required property string modelData
                    required property int index
                    spacing: 7
                    Rectangle {
                        anchors.verticalCenter: parent.verticalCenter
                        width: 10
                        height: 10
                        radius: 5
                        color: view.hues[parent.index % view.hues.length]
                    }
                    Say {
                        text: parent.modelData
                        font.pixelSize: look.scale * 13
                    }
                }
            }
        }
        Item {
            id: plot
            objectName: "pickPlot"
            Layout.fillWidth: true
            Layout.fillHeight: true
            readonly property real inset: 64
            readonly property real low: 40
            function xOf(v) {
                return inset + (v - view.facts.xLow) / (view.facts.xHigh - view.facts.xLow) * (width - inset - 16);
            }
            function yOf(v) {
                return (height - low) * (1 - (v - view.facts.yLow) / (view.facts.yHigh - view.facts.yLow));
            }
            Accessible.role: Accessible.Graphic
            Accessible.name: qsTr("Error over time of every measured setting")
            Repeater { // decades of time
                model: view.there ? view.facts.xHigh - view.facts.xLow + 1 : 0
                Rectangle {
                    required property int index
                    x: plot.xOf(view.facts.xLow + index)
                    width: 1
                    height: plot.height - plot.low
                    color: look.edge
                    Say {
                        anchors.horizontalCenter: parent.horizontalCenter
                        y: parent.height + 4
                        quiet: true
                        font.pixelSize: look.scale * 11
                        font.family: look.digits
                        text: view.decade(view.facts.xLow + parent.index)
                    }
                }
            }
            Repeater { // decades of error
                model: view.there ? view.facts.yHigh - view.facts.yLow + 1 : 0
                Rectangle {
                    required property int index
                    x: plot.inset
                    y: plot.yOf(view.facts.yLow + index)
                    width: plot.width - plot.inset - 16
                    height: 1
                    color: look.edge
                    Say {
                        anchors.verticalCenter: parent.verticalCenter
                        x: -width - 8
                        quiet: true
                        font.pixelSize: look.scale * 11
                        font.family: look.digits
                        text: view.decade(view.facts.yLow + parent.index)
                    }
                }
            }
            Repeater { // budgets
                model: view.there ? view.facts.budgets : []
                Rectangle {
                    required property double modelData
                    x: plot.xOf(modelData) - 1
                    width: 2
                    height: plot.height - plot.low
                    color: look.care
                    opacity: 0.8
                }
            }
            Repeater {
                model: view.there ? view.facts.points : []
                Rectangle {
                    id: dot
                    required property var modelData
                    readonly property real size: modelData.picked ? 13 : modelData.front ? 10 : 7
                    x: plot.xOf(modelData.x) - size / 2
                    y: plot.yOf(modelData.y) - size / 2
                    width: size
                    height: size
                    radius: size / 2
                    color: view.hues[view.modes.indexOf(modelData.mode) % view.hues.length]
                    opacity: modelData.front || modelData.picked ? 1 : 0.45
                    Rectangle {
                        anchors.centerIn: parent
                        visible: dot.modelData.picked
                        width: 23
                        height: 23
                        radius: 12
                        color: "transparent"
                        border.width: 2
                        border.color: look.text
                    }
                }
            }
            Say {
                anchors.bottom: parent.bottom
                x: plot.inset + (plot.width - plot.inset - width) / 2
                quiet: true
                font.pixelSize: look.scale * 12
                text: qsTr("time of a query, 99 % below [µs]")
            }
            Say {
                rotation: -90
                x: -width / 2 + 8
                y: (plot.height - plot.low) / 2 - height / 2
                quiet: true
                font.pixelSize: look.scale * 12
                text: qsTr("error of the depth, 99 % below [µm]")
            }
        }
        Column {
            Layout.fillWidth: true
            spacing: 3
            Repeater {
                model: view.there ? view.facts.picked : []
                Say {
                    required property string modelData
                    width: parent.width
                    font.pixelSize: look.scale * 13
                    text: modelData
                }
            }
            Say {
                width: parent.width
                quiet: true
                font.pixelSize: look.scale * 12
                text: qsTr("Large dots: none is both faster and more exact. Ring: picked for this study. Stroke: the budget.")
            }
        }
    }
}
