import QtQuick
import QtQuick.Window

// What the participant sees: the scene, what to do, how far it is. Nothing of the experimenter's.
Window {
    id: window
    objectName: "participant"
    title: qsTr("Passung – participant")
    width: 1280
    height: 720
    minimumWidth: 640
    minimumHeight: 400
    color: look.ground
    visibility: !screenView.shown ? Window.Hidden : screenView.fullScreen ? Window.FullScreen : Window.Windowed
    onClosing: screenView.closed()
    onVisibleChanged: if (visible)
        requestActivate()
    onActiveChanged: if (!active)
        screenView.letGo()
    readonly property bool asked: form.shown || guide.reading || guide.resting
    onActiveFocusItemChanged: if (!asked && activeFocusItem !== hand) // the 3D view takes it
        hand.forceActiveFocus()
    onAskedChanged: if (!asked)
        hand.forceActiveFocus()

    Scene3D {
        id: scene
        objectName: "scene"
        width: Math.ceil(parent.width * pictureQuality.scale)
        height: Math.ceil(parent.height * pictureQuality.scale)
        transform: Scale { // a smaller picture fills the window
            xScale: window.width / scene.width
            yScale: window.height / scene.height
        }
        visible: screenView.drawn
        scene: screenView
        shadows: pictureQuality.shadows
        samples: pictureQuality.samples
    }

    // Mouse and keyboard as a device of six degrees.
    MouseArea {
        id: hand
        objectName: "hand"
        anchors.fill: parent
        enabled: guide.handling && !window.asked
        acceptedButtons: Qt.LeftButton | Qt.RightButton | Qt.MiddleButton
        hoverEnabled: true
        cursorShape: pressed ? Qt.ClosedHandCursor : Qt.OpenHandCursor
        property real lastX
        property real lastY
        property int held // buttons
        onPressed: event => {
            lastX = event.x;
            lastY = event.y;
            held = event.buttons;
        }
        onPositionChanged: event => {
            if (pressed)
                screenView.drag(event.x - lastX, event.y - lastY, height, held, event.modifiers);
            lastX = event.x;
            lastY = event.y;
        }
        onWheel: event => screenView.wheel(event.angleDelta.y / 120, event.modifiers)
        focus: true
        Keys.onPressed: event => {
            if (!event.isAutoRepeat)
                event.accepted = screenView.key(event.key, true);
        }
        Keys.onReleased: event => {
            if (!event.isAutoRepeat)
                event.accepted = screenView.key(event.key, false);
        }
    }
    // How far the session is.
    Rectangle {
        width: parent.width
        height: 3
        color: "transparent"
        Rectangle {
            height: parent.height
            width: parent.width * screenView.share
            color: look.accent
        }
    }

    // What to do now.
    Rectangle {
        anchors.centerIn: screenView.drawn ? undefined : parent
        anchors.horizontalCenter: parent.horizontalCenter
        anchors.top: screenView.drawn ? parent.top : undefined
        anchors.topMargin: 24
        visible: guide.line !== "" && !window.asked
        width: Math.min(lines.implicitWidth + 56, window.width - 40)
        height: lines.implicitHeight + 26
        radius: 10
        color: screenView.drawn ? look.veil : "transparent"
        Column {
            id: lines
            anchors.centerIn: parent
            spacing: 4
            Text {
                textFormat: Text.PlainText
                objectName: "line"
                anchors.horizontalCenter: parent.horizontalCenter
                text: guide.line
                color: look.text
                font.family: look.family
                font.pixelSize: look.scale * (screenView.drawn ? 22 : 34)
                font.weight: Font.DemiBold
                Accessible.role: Accessible.StaticText
                Accessible.name: text
            }
            Text {
                textFormat: Text.PlainText
                anchors.horizontalCenter: parent.horizontalCenter
                horizontalAlignment: Text.AlignHCenter
                visible: text !== ""
                text: guide.hint
                color: look.dim
                font.family: look.family
                font.pixelSize: look.scale * (screenView.drawn ? 15 : 20)
            }
        }
    }

    StepList { // of an assembly
        objectName: "steps"
        anchors.left: parent.left
        anchors.verticalCenter: parent.verticalCenter
        anchors.leftMargin: 20
        visible: guide.steps.length > 0 && screenView.drawn && !window.asked
        steps: guide.steps
        heading: guide.stepsLine
        most: Math.max(3, Math.floor((window.height - 320) / (look.scale * 24)))
    }

    Rectangle { // what came of the last trial
        objectName: "result"
        anchors.horizontalCenter: parent.horizontalCenter
        y: 132
        visible: guide.result !== "" && !window.asked
        width: resultText.implicitWidth + 48
        height: 44
        radius: 22
        color: guide.succeeded ? look.good : look.care
        Words {
            id: resultText
            anchors.centerIn: parent
            text: guide.result
            color: look.onAccent
            font.weight: Font.DemiBold
        }
    }
    Row { // the answers to a pair's question
        anchors.horizontalCenter: parent.horizontalCenter
        anchors.bottom: parent.bottom
        anchors.bottomMargin: 48
        spacing: 32
        Repeater {
            model: guide.answers
            BigButton {
                required property string modelData
                required property int index
                objectName: "answer" + (index + 1)
                text: (index + 1) + "   " + modelData
                width: 240
                height: 76
                main: guide.answered === index + 1
                focusPolicy: Qt.NoFocus
                onPressed: guide.answer(index + 1, true)
                onReleased: guide.answer(index + 1, false)
            }
        }
    }
    GuidePage {
        anchors.fill: parent
        visible: (guide.reading || guide.resting) && !form.shown
    }
    FormPage {
        anchors.fill: parent
        visible: form.shown
    }
}
