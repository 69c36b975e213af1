import QtQuick

// An item of a form with its answer. Tab comes here once, arrows and digits answer.
FocusScope {
    id: entry
    required property var row
    required property int place
    objectName: "row" + place
    readonly property bool typed: row.look === "number" || row.look === "text"
    readonly property bool large: row.look === "pair" || row.look === "decision"
    readonly property bool apart: large || row.look === "text" || (row.look === "options" && !row.beside) || width < 760
    readonly property real half: row.text === "" ? 0 : apart ? width - 48 : Math.round((width - 72) * 0.4)
    activeFocusOnTab: !typed
    implicitHeight: large ? question.implicitHeight + answer.height + 44 : apart ? question.height + answer.height + (question.visible ? 40 : 28) : Math.max(question.implicitHeight, answer.height) + 24

    function take() {
        if (typed)
            answer.item.take();
        else
            forceActiveFocus(Qt.TabFocusReason);
    }
    onActiveFocusChanged: if (activeFocus)
        form.focusOn(place)
    Keys.onPressed: event => event.accepted = !typed && event.modifiers === (event.modifiers & Qt.KeypadModifier) && form.key(place, event.key)
    Accessible.role: Accessible.Grouping
    Accessible.name: row.number + ". " + row.text

    Rectangle {
        anchors.fill: parent
        visible: !entry.large
        radius: 12
        color: look.panel
        border.width: entry.activeFocus ? 2 : 1
        border.color: entry.activeFocus ? look.accent : entry.row.open ? look.care : look.edge
    }
    Rectangle { // the focus of large answers
        anchors.fill: answer
        anchors.margins: -14
        visible: entry.large && entry.activeFocus
        radius: 22
        color: "transparent"
        border.width: 2
        border.color: look.accent
    }
    Rectangle { // still to be answered
        visible: entry.row.open && !entry.large
        x: 10
        y: 10
        width: 8
        height: 8
        radius: 4
        color: look.care
    }
    Words {
        id: question
        visible: text !== ""
        x: entry.large ? 0 : 24
        y: entry.apart ? (entry.large ? 0 : 14) : (entry.height - implicitHeight) / 2
        width: entry.large ? entry.width : entry.half
        height: visible ? implicitHeight : 0
        text: entry.row.text
        font.pixelSize: look.scale * (entry.large ? 23 : 17)
        lineHeight: entry.large ? 1.2 : 1.0
    }
    Loader {
        id: answer
        x: entry.large ? 0 : entry.apart || entry.half === 0 ? 24 : 48 + entry.half
        y: entry.large ? question.implicitHeight + 36 : entry.apart ? question.y + question.height + (question.visible ? 12 : 0) : (entry.height - height) / 2
        width: entry.large ? entry.width : entry.width - x - 24
        sourceComponent: entry.row.look === "points" ? points : entry.row.look === "ticks" || entry.row.look === "line" ? ticks : entry.row.look === "options" || entry.large ? options : entry.typed ? typing : null
    }
    Component {
        id: points
        PointsAnswer {
            row: entry.row
            onPicked: label => form.pick(entry.place, label)
        }
    }
    Component {
        id: ticks
        TicksAnswer {
            row: entry.row
            onPlaced: value => form.place(entry.place, value)
        }
    }
    Component {
        id: options
        OptionsAnswer {
            row: entry.row
            cards: entry.large
            onPicked: label => form.pick(entry.place, label)
        }
    }
    Component {
        id: typing
        TypedAnswer {
            row: entry.row
            onEdited: text => form.type(entry.place, text)
            onEntered: form.enter()
            onTaken: form.focusOn(entry.place)
        }
    }
}
