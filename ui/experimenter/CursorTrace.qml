import QtQuick
import QtQuick.Layouts

// A trace over a whole attempt with a cursor at the time that is shown, and a mark where the trial began.
Item {
    id: view
    property alias name: trace.name
    property alias unit: trace.unit
    property alias ink: trace.ink
    property alias value: trace.value
    property alias trace: trace.trace
    Layout.fillWidth: true
    Layout.fillHeight: true
    function xOf(time) {
        return replay.length > 0 ? time / replay.length * (width - 1) : 0;
    }
    TraceView {
        id: trace
        anchors.fill: parent
    }
    Rectangle {
        x: view.xOf(replay.go)
        y: 24
        visible: replay.go > 0
        width: 1
        height: parent.height - 24
        color: look.dim
    }
    Rectangle {
        x: view.xOf(replay.time)
        y: 20
        width: 2
        height: parent.height - 20
        color: look.text
    }
    MouseArea {
        objectName: "timeOnTrace" // by keys: the slider below
        anchors.fill: parent
        anchors.topMargin: 20
        enabled: replay.there
        onPressed: event => replay.time = event.x / width * replay.length
        onPositionChanged: event => replay.time = event.x / width * replay.length
    }
}
