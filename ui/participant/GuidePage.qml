import QtQuick

// A page of instructions, or a rest: what fills the window while nothing is handled.
Rectangle {
    id: page
    color: look.ground
    readonly property bool pictured: picture.source != ""
    readonly property real column: Math.min(width - 80, pictured && width >= 900 ? 1160 : 760)
    readonly property bool across: pictured && width >= 900
    onVisibleChanged: if (visible)
        Qt.callLater(() => button.forceActiveFocus(Qt.TabFocusReason))

    Item {
        id: sheet
        visible: guide.reading
        anchors.horizontalCenter: parent.horizontalCenter
        y: 48
        width: page.column
        height: foot.y - y - 24
        Image {
            id: picture
            objectName: "picture"
            visible: page.pictured
            source: guide.pagePicture
            asynchronous: true
            fillMode: Image.PreserveAspectFit
            width: page.across ? parent.width * 0.5 : parent.width
            height: page.across ? parent.height : Math.min(parent.height * 0.55, width)
            sourceSize.width: 1200
            Accessible.role: Accessible.Graphic
            Accessible.ignored: true
        }
        Flickable {
            x: page.across ? picture.width + 48 : 0
            y: page.across || !page.pictured ? 0 : picture.height + 24
            width: parent.width - x
            height: parent.height - y
            contentHeight: text.height
            clip: true
            boundsBehavior: Flickable.StopAtBounds
            Words {
                id: text
                objectName: "pageText"
                width: parent.width
                height: Math.max(implicitHeight, parent.parent.height)
                verticalAlignment: Text.AlignVCenter
                text: guide.pageText
                font.pixelSize: look.scale * 24
                lineHeight: 1.35
            }
        }
    }
    Column {
        visible: guide.resting
        anchors.centerIn: parent
        spacing: 20
        Words {
            anchors.horizontalCenter: parent.horizontalCenter
            text: guide.line
            font.pixelSize: look.scale * 34
            font.weight: Font.DemiBold
        }
        Words {
            objectName: "restTime"
            anchors.horizontalCenter: parent.horizontalCenter
            visible: guide.restSeconds > 0
            readonly property int seconds: guide.restSeconds % 60
            text: Math.floor(guide.restSeconds / 60) + ":" + (seconds < 10 ? "0" : "") + seconds
            color: look.accent
            font.family: look.digits
            font.pixelSize: look.scale * 84
        }
        Words {
            anchors.horizontalCenter: parent.horizontalCenter
            visible: text !== ""
            text: guide.hint
            quiet: true
            font.pixelSize: look.scale * 19
        }
    }
    Item {
        id: foot
        x: sheet.x
        width: page.column
        height: 56
        anchors.bottom: parent.bottom
        anchors.bottomMargin: 40
        BigButton {
            id: button
            objectName: "goOn"
            anchors.horizontalCenter: parent.horizontalCenter
            main: true
            visible: guide.reading || guide.mayGoOn
            onVisibleChanged: if (visible)
                forceActiveFocus(Qt.TabFocusReason)
            text: guide.goOnWord
            onClicked: guide.goOn()
        }
    }
}
