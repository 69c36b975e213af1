import QtQuick
import QtQuick.Layouts
import "../controls"

// A text file to read, with a line that is marked.
ColumnLayout {
    id: view
    spacing: 10
    onVisibleChanged: if (visible)
        Qt.callLater(list.toLine)
    Say {
        Layout.fillWidth: true
        objectName: "sourcePlace"
        quiet: true
        font.pixelSize: look.scale * 12
        font.family: look.digits
        elide: Text.ElideLeft
        text: details.source.file + (details.source.line > 0 ? ":" + details.source.line : "")
    }
    Say {
        Layout.fillWidth: true
        visible: details.source.line > 0
        quiet: true
        font.pixelSize: look.scale * 12
        text: qsTr("The place is in the clipboard. “Read again” checks the file once you have changed it.")
    }
    Rectangle {
        Layout.fillWidth: true
        Layout.fillHeight: true
        radius: 8
        color: look.ground
        border.width: list.activeFocus ? 2 : 1
        border.color: list.activeFocus ? look.accent : look.edge
        ListView {
            id: list
            objectName: "source"
            anchors.fill: parent
            anchors.margins: 8
            clip: true
            activeFocusOnTab: true
            keyNavigationEnabled: true
            model: details.source.lines
            Accessible.role: Accessible.List
            Accessible.name: qsTr("Text of the protocol")
            function toLine() {
                if (details.source.line > 0) {
                    currentIndex = details.source.line - 1;
                    positionViewAtIndex(currentIndex, ListView.Center);
                }
            }
            Connections {
                target: details
                function onSourceChanged() {
                    Qt.callLater(list.toLine);
                }
            }
            delegate: Rectangle {
                id: line
                required property string modelData
                required property int index
                readonly property bool marked: index + 1 === details.source.line
                width: list.width
                height: words.height + 3
                color: marked ? Qt.rgba(look.bad.r, look.bad.g, look.bad.b, 0.22) : "transparent"
                Accessible.role: Accessible.ListItem
                Accessible.name: modelData
                Rectangle {
                    visible: line.marked
                    width: 3
                    height: parent.height
                    color: look.bad
                }
                Text {
                    textFormat: Text.PlainText
                    x: 4
                    width: 40
                    anchors.verticalCenter: parent.verticalCenter
                    horizontalAlignment: Text.AlignRight
                    text: line.index + 1
                    color: look.dim
                    font.family: look.digits
                    font.pixelSize: look.scale * 12
                }
                Text {
                    textFormat: Text.PlainText
                    id: words
                    x: 58
                    width: parent.width - x
                    anchors.verticalCenter: parent.verticalCenter
                    wrapMode: Text.Wrap
                    text: line.modelData
                    color: look.text
                    font.family: look.digits
                    font.pixelSize: look.scale * 13
                }
            }
        }
    }
    Say {
        visible: details.source.problem !== ""
        text: details.source.problem
        color: look.bad
    }
}
