import QtQuick
import QtQuick.Templates as T

// One of many values, in a list that opens.
T.ComboBox {
    id: picker
    property string name
    implicitWidth: look.scale * 260
    implicitHeight: look.scale * 38
    leftPadding: 14
    rightPadding: 34
    font.family: look.family
    font.pixelSize: look.scale * 14
    activeFocusOnTab: true
    Accessible.role: Accessible.ComboBox
    Accessible.name: name
    Keys.onReturnPressed: popup.open()
    background: Rectangle {
        radius: 7
        color: look.raised
        border.width: picker.visualFocus ? 2 : 1
        border.color: picker.visualFocus ? look.accent : look.edge
    }
    contentItem: Say {
        text: picker.displayText
        verticalAlignment: Text.AlignVCenter
        font.weight: Font.Medium
        Accessible.ignored: true
    }
    indicator: Say {
        x: picker.width - width - 14
        anchors.verticalCenter: parent.verticalCenter
        text: "▾"
        quiet: true
        Accessible.ignored: true
    }
    delegate: T.ItemDelegate {
        id: entry
        required property var modelData
        required property int index
        width: picker.width - 8
        implicitHeight: look.scale * 34
        leftPadding: 12
        rightPadding: 12
        highlighted: picker.highlightedIndex === index
        Accessible.role: Accessible.ListItem
        Accessible.name: word.text
        background: Rectangle {
            radius: 5
            color: entry.highlighted ? look.raised : "transparent"
        }
        contentItem: Say {
            id: word
            text: picker.textRole !== "" ? entry.modelData[picker.textRole] : entry.modelData
            verticalAlignment: Text.AlignVCenter
            font.weight: picker.currentIndex === entry.index ? Font.DemiBold : Font.Normal
            Accessible.ignored: true
        }
    }
    popup: T.Popup {
        y: picker.height + 4
        width: picker.width
        height: Math.min(contentItem.implicitHeight + 8, 340)
        padding: 4
        contentItem: ListView {
            clip: true
            implicitHeight: contentHeight
            model: picker.delegateModel
            currentIndex: picker.highlightedIndex
        }
        background: Rectangle {
            radius: 8
            color: look.panel
            border.color: look.edge
        }
    }
}
