import QtQuick

// A setting's mark: the colour says the method, the form what contact is computed from.
Item {
    id: mark
    property real size: 10
    property string method
    property string geometry
    property bool strong: true
    readonly property color hue: method === "penalty" ? (look.dark ? "#56b4e9" : "#0072b2") : method === "god_object" ? "#009e73" : "#e69f00"
    width: size
    height: size
    opacity: strong ? 1 : 0.55
    Rectangle { // of surfaces a square, of closed forms one on its corner, of fields a disc
        anchors.centerIn: parent
        width: mark.geometry === "field" ? mark.size : 0.84 * mark.size
        height: width
        radius: mark.geometry === "field" ? width / 2 : 1
        rotation: mark.geometry === "closed_form" ? 45 : 0
        antialiasing: true
        color: mark.hue
    }
}
