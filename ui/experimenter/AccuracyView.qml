import QtQuick
import QtQuick.Layouts
import "../controls"

// What accuracy costs a tick of the study: measured here, looked at, and a setting of it written into the study.
Item {
    id: view
    readonly property bool measured: accuracy.front.points !== undefined
    readonly property bool picked: !measured && details.accuracy.points !== undefined
    readonly property var conditions: details.design.conditions !== undefined ? details.design.conditions : []

    // Anchored, not laid out: texts that wrap change their heights with their widths, which nested layouts give up on.
    RowLayout {
        id: head
        anchors.left: parent.left
        anchors.right: parent.right
        spacing: 12
        Picker {
            objectName: "accuracyCondition"
            visible: view.conditions.length > 1
            Layout.fillWidth: true
            Layout.maximumWidth: look.scale * 300
            name: qsTr("Condition that is measured")
            model: view.conditions
            currentIndex: accuracy.condition
            onActivated: index => accuracy.condition = index
        }
        Choice {
            objectName: "accuracyError"
            visible: view.measured
            name: qsTr("Error that is shown")
            options: [qsTr("Overlap"), qsTr("Force")]
            chosen: accuracy.error
            onPicked: index => accuracy.error = index
        }
        Item {
            Layout.fillWidth: true
        }
        ActionButton {
            objectName: "cancelAccuracy"
            visible: accuracy.work.measuring
            text: accuracy.work.cancelling ? qsTr("Cancelling …") : qsTr("Cancel")
            enabled: !accuracy.work.cancelling
            onClicked: accuracy.cancel()
        }
        ActionButton {
            objectName: "measureAccuracy"
            visible: !accuracy.work.measuring
            kind: view.measured ? "plain" : "main"
            text: view.measured ? qsTr("Measure again") : qsTr("Measure")
            why: accuracy.work.why
            onClicked: accuracy.measure()
        }
    }
    ColumnLayout {
        id: progress
        objectName: "accuracyProgress"
        anchors.left: parent.left
        anchors.right: parent.right
        anchors.top: head.bottom
        anchors.topMargin: 10
        visible: accuracy.work.measuring
        spacing: 4
        Rectangle {
            Layout.fillWidth: true
            implicitHeight: 8
            radius: 4
            color: look.raised
            Accessible.role: Accessible.ProgressBar
            Accessible.name: said.text
            Rectangle {
                height: parent.height
                radius: 4
                width: Math.max(parent.height, parent.width * accuracy.work.share)
                color: look.accent
            }
        }
        Say {
            id: said
            objectName: "accuracyWhat"
            Layout.fillWidth: true
            quiet: true
            font.pixelSize: look.scale * 12
            text: accuracy.work.mine ? [qsTr("%1 % · %2").arg(Math.floor(100 * accuracy.work.share)).arg(accuracy.work.what), accuracy.work.left].filter(word => word !== "").join(" · ") : qsTr("%1 % · another study is measured").arg(Math.floor(100 * accuracy.work.share))
        }
    }
    Item {
        anchors.left: parent.left
        anchors.right: parent.right
        anchors.top: progress.visible ? progress.bottom : head.bottom
        anchors.bottom: foot.visible ? foot.top : parent.bottom
        anchors.topMargin: 10
        anchors.bottomMargin: foot.visible ? 10 : 0
        FrontView {
            anchors.fill: parent
            visible: view.measured
        }
        PickView {
            anchors.fill: parent
            visible: view.picked
        }
        Say {
            objectName: "accuracyHint"
            visible: !view.measured && !view.picked
            anchors.centerIn: parent
            width: Math.min(parent.width, 620)
            quiet: true
            wrapMode: Text.WordWrap
            horizontalAlignment: Text.AlignHCenter
            lineHeight: 1.25
            text: details.accuracy.hint !== undefined ? details.accuracy.hint : ""
        }
    }
    Item {
        id: foot
        anchors.left: parent.left
        anchors.right: parent.right
        anchors.bottom: parent.bottom
        height: Math.max(words.height, use.visible ? use.height : 0)
        visible: view.measured || accuracy.choice.told !== ""
        Column {
            id: words
            anchors.left: parent.left
            anchors.right: use.visible ? use.left : parent.right
            anchors.rightMargin: use.visible ? 12 : 0
            anchors.verticalCenter: parent.verticalCenter
            spacing: 2
            Say {
                objectName: "accuracyChoice"
                width: parent.width
                wrapMode: Text.WordWrap
                font.pixelSize: look.scale * 13
                quiet: accuracy.choice.words === ""
                text: accuracy.choice.words !== "" ? accuracy.choice.words : view.measured ? qsTr("Choose a setting in the picture or the table, or with the arrow keys, to write it into the study.") : ""
                visible: text !== ""
            }
            Say {
                objectName: "accuracyTold"
                width: parent.width
                wrapMode: Text.WordWrap
                font.pixelSize: look.scale * 13
                font.weight: Font.DemiBold
                color: accuracy.choice.good ? look.good : look.bad
                text: accuracy.choice.told
                visible: text !== ""
            }
        }
        ActionButton {
            id: use
            objectName: "useSetting"
            anchors.right: parent.right
            anchors.verticalCenter: parent.verticalCenter
            visible: view.measured
            kind: "main"
            text: qsTr("Use")
            why: accuracy.choice.why
            onClicked: accuracy.use()
        }
    }
}
