import QtQuick
import QtQuick.Layouts
import "../controls"

// Something to decide before anything else; what is behind it waits.
FocusScope {
    id: view
    property string text
    property string detail
    property string yes // the word for it
    property string no
    property string whyNotYes
    property bool grave: false // yes cannot be taken back
    signal agreed
    signal refused
    onVisibleChanged: if (visible)
        refuse.forceActiveFocus(Qt.TabFocusReason)
    MouseArea { // nothing beneath is clicked
        anchors.fill: parent
        hoverEnabled: true
    }
    Rectangle {
        anchors.fill: parent
        color: look.ground
        opacity: 0.7
    }
    Panel {
        anchors.centerIn: parent
        width: Math.min(parent.width - 40, look.scale * 520)
        height: fitting
        pad: 24
        ColumnLayout {
            anchors.left: parent.left
            anchors.right: parent.right
            spacing: 14
            Say {
                objectName: "question"
                Layout.fillWidth: true
                text: view.text
                font.pixelSize: look.scale * 20
                font.weight: Font.DemiBold
                wrapMode: Text.WordWrap
            }
            Say {
                Layout.fillWidth: true
                visible: text !== ""
                quiet: true
                text: view.whyNotYes !== "" ? view.whyNotYes : view.detail
                wrapMode: Text.WordWrap
            }
            RowLayout {
                Layout.fillWidth: true
                Layout.topMargin: 6
                spacing: 10
                ActionButton {
                    id: refuse
                    objectName: "questionNo"
                    Layout.fillWidth: true
                    tall: true
                    text: view.no
                    KeyNavigation.tab: agree.enabled ? agree : refuse
                    KeyNavigation.backtab: agree.enabled ? agree : refuse
                    onClicked: view.refused()
                }
                ActionButton {
                    id: agree
                    objectName: "questionYes"
                    Layout.fillWidth: true
                    tall: true
                    kind: view.grave ? "stop" : "main"
                    text: view.yes
                    why: view.whyNotYes
                    KeyNavigation.tab: refuse
                    KeyNavigation.backtab: refuse
                    onClicked: view.agreed()
                }
            }
        }
    }
}
