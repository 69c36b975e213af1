import QtQuick
import QtQuick.Templates as T

// One of a few values, side by side.
Rectangle {
    id: choice
    property var options: [] // texts
    property int chosen: 0
    property string name
    signal picked(int index)
    implicitWidth: row.implicitWidth + 6
    implicitHeight: look.scale * 38
    radius: 8
    color: look.ground
    border.color: look.edge
    Accessible.role: Accessible.Grouping
    Accessible.name: name
    Row {
        id: row
        x: 3
        y: 3
        spacing: 2
        Repeater {
            model: choice.options
            T.Button {
                id: option
                required property string modelData
                required property int index
                implicitWidth: label.implicitWidth + 26
                implicitHeight: choice.height - 6
                focusPolicy: Qt.StrongFocus
                Accessible.role: Accessible.RadioButton
                Accessible.name: modelData
                Accessible.checkable: true
                Accessible.checked: index === choice.chosen
                onClicked: choice.picked(index)
                Keys.onReturnPressed: choice.picked(index)
                Keys.onRightPressed: choice.picked(Math.min(choice.options.length - 1, choice.chosen + 1))
                Keys.onLeftPressed: choice.picked(Math.max(0, choice.chosen - 1))
                background: Rectangle {
                    radius: 6
                    color: option.index === choice.chosen ? look.raised : "transparent"
                    border.width: option.visualFocus ? 2 : option.index === choice.chosen ? 1 : 0
                    border.color: option.visualFocus ? look.accent : look.edge
                }
                contentItem: Item {
                    Say {
                        id: label
                        anchors.centerIn: parent
                        text: option.modelData
                        quiet: option.index !== choice.chosen
                        font.weight: option.index === choice.chosen ? Font.DemiBold : Font.Normal
                        Accessible.ignored: true
                    }
                }
            }
        }
    }
}
