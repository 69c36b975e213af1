import QtQuick
import QtQuick3D

// The frame of the part in one of the other hands, or the world for hand -1.
Node {
    required property var scene
    required property int hand

    readonly property var pose: hand >= 0 && hand < scene.others.length ? scene.others[hand] : null

    position: pose ? pose.position : Qt.vector3d(0, 0, 0)
    rotation: pose ? pose.rotation : Qt.quaternion(1, 0, 0, 0)
}
