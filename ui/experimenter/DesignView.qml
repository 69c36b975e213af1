import QtQuick
import QtQuick.Layouts
import "../controls"

// Everybody's order: a line per participant and session, a chip per trial; what the numbers mean; how even it is.
Item {
    id: view
    readonly property bool there: details.design.orders !== undefined
    readonly property var conditions: there ? details.design.conditions : []
    readonly property var hues: ["#56b4e9", "#e69f00", "#009e73", "#cc79a7", "#d55e00", "#f0e442", "#0072b2", "#999999"]
    function tint(condition) {
        const hue = Qt.color(hues[(condition - 1) % hues.length]);
        return Qt.rgba(hue.r, hue.g, hue.b, look.dark ? 0.34 : 0.4);
    }

    Say {
        anchors.centerIn: parent
        visible: !view.there
        quiet: true
        text: details.told !== "" ? details.told : studies.cards.length > 0 && studies.cards[studies.chosen].sound ? qsTr("Reading …") : qsTr("The study has problems.")
    }
    RowLayout {
        anchors.fill: parent
        visible: view.there
        spacing: 28
        ColumnLayout {
            Layout.fillWidth: true
            Layout.fillHeight: true
            spacing: 10
            Heading {
                text: qsTr("ORDERS")
            }
            ListView {
                id: orders
                objectName: "orders"
                Layout.fillWidth: true
                Layout.fillHeight: true
                clip: true
                spacing: 4
                activeFocusOnTab: true
                flickableDirection: Flickable.HorizontalAndVerticalFlick
                contentWidth: widest
                property real widest: width
                model: view.there ? details.design.orders : []
                Accessible.role: Accessible.Table
                Accessible.name: qsTr("Orders")
                delegate: Row {
                    id: order
                    required property var modelData
                    height: look.scale * 26
                    spacing: 0
                    onWidthChanged: orders.widest = Math.max(orders.widest, width)
                    Say {
                        width: look.scale * 62
                        height: look.scale * 24
                        verticalAlignment: Text.AlignVCenter
                        text: order.modelData.code
                        font.family: look.digits
                        font.pixelSize: look.scale * 13
                        font.weight: Font.DemiBold
                    }
                    Say {
                        width: visible ? look.scale * 96 : 0
                        height: look.scale * 24
                        visible: order.modelData.group !== ""
                        verticalAlignment: Text.AlignVCenter
                        quiet: true
                        font.pixelSize: look.scale * 12
                        text: order.modelData.group
                    }
                    Say {
                        width: visible ? look.scale * 30 : 0
                        height: look.scale * 24
                        visible: order.modelData.session > 0
                        verticalAlignment: Text.AlignVCenter
                        quiet: true
                        font.pixelSize: look.scale * 12
                        text: order.modelData.session + "."
                    }
                    Repeater {
                        model: order.modelData.blocks
                        Row {
                            id: block
                            required property var modelData
                            required property int index
                            rightPadding: 10
                            spacing: 6
                            Repeater {
                                model: block.modelData.passes
                                Row {
                                    id: pass
                                    required property var modelData
                                    spacing: 2
                                    Repeater {
                                        model: pass.modelData.trials
                                        Rectangle {
                                            required property var modelData
                                            width: look.scale * 24
                                            height: look.scale * 24
                                            radius: 4
                                            color: view.tint(modelData.condition)
                                            border.width: modelData.caught ? 2 : 0
                                            border.color: look.text
                                            Text {
                                                textFormat: Text.PlainText
                                                anchors.centerIn: parent
                                                text: parent.modelData.condition
                                                color: look.text
                                                font.family: look.digits
                                                font.pixelSize: look.scale * 12
                                            }
                                        }
                                    }
                                    Say {
                                        visible: pass.modelData.times > 1
                                        height: look.scale * 24
                                        verticalAlignment: Text.AlignVCenter
                                        leftPadding: 2
                                        quiet: true
                                        font.pixelSize: look.scale * 12
                                        text: "×" + pass.modelData.times
                                    }
                                }
                            }
                        }
                    }
                }
            }
            Say {
                Layout.fillWidth: true
                quiet: true
                font.pixelSize: look.scale * 12
                wrapMode: Text.WordWrap
                text: view.there ? qsTr("Blocks stand apart; ×n: the same pass n times; a frame marks catch trials.") + " " + details.design.duration : ""
            }
            Column {
                Layout.fillWidth: true
                spacing: 3
                Repeater {
                    model: view.there ? details.design.balance : []
                    Say {
                        required property string modelData
                        width: parent.width
                        font.pixelSize: look.scale * 12
                        wrapMode: Text.WordWrap
                        text: modelData
                    }
                }
            }
        }
        ColumnLayout {
            Layout.preferredWidth: look.scale * 300
            Layout.maximumWidth: look.scale * 300
            Layout.fillHeight: true
            spacing: 10
            Heading {
                text: qsTr("CONDITIONS")
            }
            ListView {
                objectName: "conditions"
                Layout.fillWidth: true
                Layout.fillHeight: true
                clip: true
                spacing: 4
                activeFocusOnTab: true
                model: view.conditions
                Accessible.role: Accessible.List
                Accessible.name: qsTr("Conditions")
                delegate: RowLayout {
                    id: condition
                    required property string modelData
                    required property int index
                    width: ListView.view.width
                    spacing: 10
                    Rectangle {
                        implicitWidth: look.scale * 24
                        implicitHeight: look.scale * 24
                        radius: 4
                        color: view.tint(condition.index + 1)
                        Text {
                            textFormat: Text.PlainText
                            anchors.centerIn: parent
                            text: condition.index + 1
                            color: look.text
                            font.family: look.digits
                            font.pixelSize: look.scale * 12
                        }
                    }
                    Say {
                        Layout.fillWidth: true
                        font.pixelSize: look.scale * 13
                        wrapMode: Text.Wrap
                        text: condition.modelData
                    }
                }
            }
            Heading {
                text: qsTr("BLOCKS")
            }
            Column {
                Layout.fillWidth: true
                spacing: 6
                Repeater {
                    model: view.there ? details.design.blocks : []
                    Column {
                        id: blockLine
                        required property var modelData
                        width: parent.width
                        Say {
                            width: parent.width
                            text: blockLine.modelData.name
                            font.pixelSize: look.scale * 13
                        }
                        Say {
                            width: parent.width
                            quiet: true
                            font.pixelSize: look.scale * 12
                            wrapMode: Text.WordWrap
                            text: blockLine.modelData.words
                        }
                    }
                }
            }
        }
    }
}
