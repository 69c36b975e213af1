import QtQuick

// A page of a questionnaire, or a clause of consent.
Rectangle {
    id: page
    color: look.ground
    readonly property real margin: Math.max(24, (width - 1060) / 2)
    readonly property var blank: ({
            look: "",
            text: "",
            labels: [],
            picked: -1,
            typed: "",
            range: "",
            fault: "",
            lowAnchor: "",
            highAnchor: "",
            number: 0,
            low: 0,
            high: 1,
            value: 0,
            ticks: 0,
            answered: false,
            open: false,
            beside: false
        })
    readonly property int wanted: form.focus
    onWantedChanged: take()
    onVisibleChanged: if (visible)
        Qt.callLater(take)
    Connections {
        target: form
        function onTurned() {
            list.contentY = 0;
            Qt.callLater(page.take);
        }
    }

    /// The keyboard goes where the form wants it.
    function take() {
        if (!visible)
            return;
        const row = rows.itemAt(form.focus);
        if (row === null) {
            next.forceActiveFocus(Qt.TabFocusReason);
            return;
        }
        row.take();
        const below = row.y + row.height - list.height;
        list.contentY = Math.max(0, Math.min(row.y, Math.max(list.contentY, below)));
    }

    Rectangle { // how much is answered
        width: parent.width
        height: 4
        color: look.raised
        Rectangle {
            height: parent.height
            width: parent.width * form.share
            color: look.accent
        }
    }
    Column {
        id: head
        x: page.margin
        y: 34
        width: page.width - 2 * x
        spacing: 6
        Words {
            objectName: "formTitle"
            width: parent.width
            text: form.title
            font.pixelSize: look.scale * 28
            font.weight: Font.DemiBold
            Accessible.role: Accessible.Heading
        }
        Words {
            width: parent.width
            visible: text !== ""
            text: form.instruction
            quiet: true
            font.pixelSize: look.scale * 17
        }
    }
    Flickable {
        id: list
        x: page.margin - 6
        anchors.top: head.bottom
        anchors.topMargin: 22
        anchors.bottom: foot.top
        anchors.bottomMargin: 12
        width: page.width - 2 * x
        contentHeight: column.height + 8
        clip: true
        boundsBehavior: Flickable.StopAtBounds
        Column {
            id: column
            x: 6
            y: 4
            width: parent.width - 12
            spacing: 10
            Repeater {
                id: rows
                model: form.count
                FormRow {
                    required property int index
                    width: column.width
                    place: index
                    row: form.rows[index] ?? page.blank
                }
            }
        }
    }
    Rectangle { // more is below
        anchors.bottom: list.bottom
        x: list.x
        width: list.width
        height: 28
        visible: list.contentY + list.height < list.contentHeight - 12
        gradient: Gradient {
            GradientStop {
                position: 0
                color: "transparent"
            }
            GradientStop {
                position: 1
                color: look.ground
            }
        }
    }
    Item {
        id: foot
        x: page.margin
        width: page.width - 2 * x
        height: 56
        anchors.bottom: parent.bottom
        anchors.bottomMargin: 26
        BigButton {
            id: back
            objectName: "formBack"
            visible: form.page > 0
            text: form.backWord
            onClicked: form.back()
        }
        Words {
            objectName: "notice"
            anchors.verticalCenter: parent.verticalCenter
            anchors.left: back.visible ? back.right : parent.left
            anchors.right: count.left
            anchors.leftMargin: back.visible ? 24 : 0
            anchors.rightMargin: 24
            horizontalAlignment: Text.AlignRight
            text: form.notice
            color: look.care
            font.pixelSize: look.scale * 16
            font.weight: Font.DemiBold
            Accessible.role: Accessible.AlertMessage
        }
        Words {
            id: count
            anchors.verticalCenter: parent.verticalCenter
            anchors.right: next.left
            anchors.rightMargin: 24
            visible: form.pages > 1
            wrapMode: Text.NoWrap
            text: form.pageWord
            quiet: true
            font.pixelSize: look.scale * 16
        }
        BigButton {
            id: next
            objectName: "formNext"
            anchors.right: parent.right
            main: true
            text: form.nextWord
            onClicked: form.next()
            onActiveFocusChanged: if (activeFocus)
                form.focusOn(form.count)
        }
    }
}
