import QtQuick
import QtQuick.Layouts
import "../controls"

// Which study a page is about, what came of the last action, and what else stands at its right.
RowLayout {
    id: bar
    property string told
    property bool failed: false
    default property alias more: extras.data
    spacing: 16
    Picker {
        objectName: "study"
        implicitWidth: Math.max(look.scale * 372, Math.min(look.scale * 560, implicitContentWidth + leftPadding + rightPadding))
        name: qsTr("Study")
        model: studies.cards
        textRole: "title"
        currentIndex: studies.chosen
        onActivated: index => studies.chosen = index
    }
    Lamp {
        visible: bar.told !== ""
        tone: bar.failed ? "bad" : "good"
    }
    Say {
        objectName: "told"
        Layout.fillWidth: true
        text: bar.told
        wrapMode: Text.Wrap
        maximumLineCount: 2
        font.pixelSize: look.scale * 13
        Accessible.role: Accessible.AlertMessage
    }
    Row {
        id: extras
        spacing: 12
    }
}
