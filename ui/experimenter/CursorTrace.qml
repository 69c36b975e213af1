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
    property alias least: trace.least
    readonly property var marks: { // about five round times
        const steps = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 60, 120, 300, 600];
        const step = steps.find(each => replay.length / each <= 6) ?? 3600;
        const found = [];
        for (let i = 0; i * step <= replay.length && replay.length > 0; ++i)
            found.push({at: i * step / replay.length, text: +(i * step).toFixed(2) + " s"});
        return found;
    }
    Layout.fillWidth: true
    Layout.fillHeight: true
    function xOf(time) {
        return replay.length > 0 ? time / replay.length * (width - 1) : 0;
    }
    TraceView {
        id: trace
        anchors.fill: parent
        marks: view.marks
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
