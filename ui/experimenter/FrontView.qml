import QtQuick
import QtQuick.Layouts
import "../controls"

// The measured settings as a picture and as a table; what is chosen in the one is chosen in the other.
RowLayout {
    id: view
    readonly property var points: accuracy.front.points !== undefined ? accuracy.front.points : []
    readonly property string errorName: accuracy.error === 0 ? qsTr("true overlap [µm]") : qsTr("error of the force [%]")
    spacing: 18

    ColumnLayout {
        Layout.fillWidth: true
        Layout.fillHeight: true
        spacing: 6
        FrontPlot {
            objectName: "frontPlot"
            Layout.fillWidth: true
            Layout.fillHeight: true
            points: view.points
            errorName: view.errorName
        }
        Say {
            objectName: "frontOrigin"
            Layout.fillWidth: true
            visible: text !== ""
            quiet: accuracy.front.elsewhere !== true
            font.weight: quiet ? Font.Normal : Font.DemiBold
            wrapMode: Text.WordWrap
            font.pixelSize: look.scale * 11
            text: accuracy.front.origin !== undefined ? accuracy.front.origin : ""
        }
        Say {
            Layout.fillWidth: true
            quiet: true
            wrapMode: Text.WordWrap
            font.pixelSize: look.scale * 11
            text: (accuracy.front.path !== undefined ? accuracy.front.path + " " : "") + qsTr("Line: no setting is both faster and nearer the truth. Ring: the study's own. Bars: from the median; of the overlap from what was found to what is proven.")
        }
    }
    ColumnLayout {
        Layout.preferredWidth: look.scale * 350
        Layout.minimumWidth: look.scale * 350
        Layout.maximumWidth: look.scale * 350
        Layout.fillHeight: true
        spacing: 4
        RowLayout {
            Layout.fillWidth: true
            Layout.rightMargin: 8
            spacing: 8
            Heading {
                Layout.fillWidth: true
                Layout.leftMargin: 28
                text: qsTr("SETTING")
            }
            Heading {
                Layout.preferredWidth: look.scale * 46
                horizontalAlignment: Text.AlignRight
                text: "µs"
            }
            Heading {
                Layout.preferredWidth: look.scale * 46
                horizontalAlignment: Text.AlignRight
                text: accuracy.error === 0 ? "µm" : "%"
            }
        }
        ListView {
            id: table
            objectName: "accuracyTable"
            Layout.fillWidth: true
            Layout.fillHeight: true
            clip: true
            spacing: 2
            model: view.points
            currentIndex: accuracy.chosen
            activeFocusOnTab: true
            keyNavigationEnabled: false
            boundsBehavior: Flickable.StopAtBounds
            Accessible.role: Accessible.Table
            Accessible.name: qsTr("Measured settings, the fastest first")
            Keys.onUpPressed: accuracy.chosen = Math.max(0, accuracy.chosen - 1)
            Keys.onDownPressed: accuracy.chosen = Math.min(view.points.length - 1, accuracy.chosen + 1)
            delegate: Rectangle {
                id: line
                required property var modelData
                required property int index
                objectName: "setting-" + index
                width: table.width
                height: words.height + 8
                radius: 6
                color: index === accuracy.chosen ? look.raised : "transparent"
                border.width: index === accuracy.chosen ? (table.activeFocus ? 2 : 1) : 0
                border.color: table.activeFocus ? look.accent : look.edge
                Accessible.role: Accessible.ListItem
                Accessible.name: qsTr("%1: %2 µs, %3").arg(modelData.words).arg(modelData.time).arg(modelData.error)
                FrontMark {
                    x: 8
                    anchors.verticalCenter: parent.verticalCenter
                    size: line.modelData.front ? 12 : 9
                    method: line.modelData.method
                    geometry: line.modelData.geometry
                    strong: line.modelData.front
                }
                RowLayout {
                    x: 28
                    width: parent.width - 36
                    anchors.verticalCenter: parent.verticalCenter
                    spacing: 8
                    Column {
                        id: words
                        Layout.fillWidth: true
                        Say {
                            width: parent.width
                            font.pixelSize: look.scale * 12
                            font.weight: line.modelData.front ? Font.DemiBold : Font.Normal
                            wrapMode: Text.Wrap
                            text: line.modelData.method + " · " + line.modelData.geometry
                        }
                        Say {
                            width: parent.width
                            visible: text !== ""
                            quiet: true
                            font.pixelSize: look.scale * 11
                            wrapMode: Text.Wrap
                            text: [line.modelData.details, line.modelData.inStudy ? qsTr("in the study") : ""].filter(word => word !== "").join(" · ")
                        }
                    }
                    Say {
                        Layout.preferredWidth: look.scale * 46
                        horizontalAlignment: Text.AlignRight
                        font.family: look.digits
                        font.pixelSize: look.scale * 12
                        text: line.modelData.time
                    }
                    Say {
                        Layout.preferredWidth: look.scale * 46
                        horizontalAlignment: Text.AlignRight
                        font.family: look.digits
                        font.pixelSize: look.scale * 12
                        text: line.modelData.error
                    }
                }
                MouseArea {
                    anchors.fill: parent
                    onClicked: {
                        accuracy.chosen = line.index;
                        table.forceActiveFocus();
                    }
                }
            }
        }
    }
}
