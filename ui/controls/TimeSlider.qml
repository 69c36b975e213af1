import QtQuick
import QtQuick.Templates as T

// A point in time.
T.Slider {
    id: slider
    implicitHeight: look.scale * 30
    implicitWidth: look.scale * 200
    focusPolicy: Qt.StrongFocus
    Accessible.role: Accessible.Slider
    background: Rectangle {
        y: (slider.height - height) / 2
        width: slider.width
        height: 6
        radius: 3
        color: look.raised
        border.color: look.edge
        Rectangle {
            width: slider.visualPosition * parent.width
            height: parent.height
            radius: 3
            color: look.accent
        }
    }
    handle: Rectangle {
        x: slider.visualPosition * (slider.width - width)
        y: (slider.height - height) / 2
        width: 18
        height: 18
        radius: 9
        color: look.accent
        border.width: slider.visualFocus ? 3 : 1
        border.color: slider.visualFocus ? look.text : look.panel
    }
}
